"""Springs fitted to data, by way of the lattice's own answers, and the door to every calibration."""
