"""The training of the calibration `central`."""
