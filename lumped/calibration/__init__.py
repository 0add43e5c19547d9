"""Which k belongs to E: calibration methods by name, each in a file of its own."""

from lumped.calibration.calibration import Calibration
from lumped.calibration.consistent import consistent
from lumped.calibration.identifiability import Identifiability, identifiability
from lumped.calibration.methods import CALIBRATIONS, FITTED, calibrate, given
from lumped.calibration.targets import ModalTarget, StaticTarget
from lumped.calibration.uniform import uniform

__all__ = [
    "CALIBRATIONS",
    "FITTED",
    "Calibration",
    "Identifiability",
    "ModalTarget",
    "StaticTarget",
    "calibrate",
    "consistent",
    "given",
    "identifiability",
    "uniform",
]
