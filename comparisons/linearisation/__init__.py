"""A lattice about its equilibrium as matrices, for control."""
