"""Which k belongs to E: calibration methods by name, each in a file of its own."""

from lumped.calibration.calibration import Calibration
from lumped.calibration.consistent import consistent
from lumped.calibration.methods import CALIBRATIONS, calibrate, given
from lumped.calibration.uniform import uniform

__all__ = ["CALIBRATIONS", "Calibration", "calibrate", "consistent", "given", "uniform"]
