"""Springs fitted to data, by way of the lattice's own answers, and the door to every calibration."""

from lumped.fitting.fits import FittedCalibration, ModalTarget, StaticTarget
from lumped.fitting.identifiability import Identifiability, identifiability
from lumped.fitting.methods import CALIBRATIONS, calibrate

__all__ = [
    "CALIBRATIONS",
    "FittedCalibration",
    "Identifiability",
    "ModalTarget",
    "StaticTarget",
    "calibrate",
    "identifiability",
]
