"""Calibration of spring constants k from E: methods that need the sheet and its material alone, a file
each."""

from lumped.calibration.calibration import Calibration
from lumped.calibration.methods import MAKERS, default, given

__all__ = ["MAKERS", "Calibration", "default", "given"]
