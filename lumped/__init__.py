"""The spring lattice: topology, springs and cells, calibration, statics, vibration, dynamics."""

from lumped.calibration import Calibration, given
from lumped.dynamics import INTEGRATORS, simulate
from lumped.fitting import (
    CALIBRATIONS,
    FittedCalibration,
    ModalTarget,
    StaticTarget,
    calibrate,
    identifiability,
)
from lumped.sensitivity import Sensitivity, gradient, sensitivity
from lumped.statics.buckling import buckling_loads
from lumped.statics.continuation import Path, trace
from lumped.statics.solver import solve
from lumped.vibration import Modes, modes

__all__ = [
    "CALIBRATIONS",
    "INTEGRATORS",
    "Calibration",
    "FittedCalibration",
    "ModalTarget",
    "Modes",
    "Path",
    "Sensitivity",
    "StaticTarget",
    "buckling_loads",
    "calibrate",
    "given",
    "gradient",
    "identifiability",
    "modes",
    "sensitivity",
    "simulate",
    "solve",
    "trace",
]
