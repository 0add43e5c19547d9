"""Which k belongs to E: methods that need the sheet and its material alone, each in a file of its own."""

from lumped.calibration.calibration import Calibration
from lumped.calibration.methods import MAKERS, default, given

__all__ = ["MAKERS", "Calibration", "default", "given"]
