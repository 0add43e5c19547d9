"""Model order reduction: a lattice's motion in a few coordinates."""
