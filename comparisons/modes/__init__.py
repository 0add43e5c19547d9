"""Natural frequencies of lattice and references side by side."""
