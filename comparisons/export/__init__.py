"""A lattice in files for other programs, with values to check theirs by."""
