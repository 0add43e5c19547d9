"""What accuracy costs: error against time over models, grids, calibrations, time steps."""
