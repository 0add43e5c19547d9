"""The spring lattice: topology, springs and cells, calibration, statics, vibration, dynamics."""

from lumped.calibration import CALIBRATIONS, Calibration, calibrate, given
from lumped.dynamics import INTEGRATORS, simulate
from lumped.sensitivity import Sensitivity, gradient, sensitivity
from lumped.statics.buckling import buckling_loads
from lumped.statics.continuation import Path, trace
from lumped.statics.solver import solve
from lumped.vibration import Modes, modes

__all__ = [
    "CALIBRATIONS",
    "INTEGRATORS",
    "Calibration",
    "Modes",
    "Path",
    "Sensitivity",
    "buckling_loads",
    "calibrate",
    "given",
    "gradient",
    "modes",
    "sensitivity",
    "simulate",
    "solve",
    "trace",
]
