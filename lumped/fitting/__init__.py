"""Springs fitted to data by the lattice's answers, and the function `calibrate` for every method."""
