"""Which k belongs to E: methods that need the sheet and its material alone, each in a file of its own."""

from lumped.calibration.calibration import Calibration, homogenised
from lumped.calibration.methods import CLOSED, Method, default, given

__all__ = ["CLOSED", "Calibration", "Method", "default", "given", "homogenised"]
