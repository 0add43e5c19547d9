"""Which k belongs to E: the methods, each in a file of its own, and the one door to them."""

from lumped.calibration.calibration import Calibration
from lumped.calibration.methods import CALIBRATIONS, CalibrationMethod, calibrate, default, given
from lumped.calibration.report import homogenised

__all__ = [
    "CALIBRATIONS",
    "Calibration",
    "CalibrationMethod",
    "calibrate",
    "default",
    "given",
    "homogenised",
]
