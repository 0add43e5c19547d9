"""Springs out: a lattice in files that another program can read, with values to check its own by."""
