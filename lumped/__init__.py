"""The spring lattice: topology, springs and cells, calibration, statics."""

from lumped.calibration import CALIBRATIONS, Calibration, calibrate, given
from lumped.statics import pose, solve

__all__ = ["CALIBRATIONS", "Calibration", "calibrate", "given", "pose", "solve"]
