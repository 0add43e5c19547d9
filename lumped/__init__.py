"""The spring lattice: topology, springs and cells, calibration, statics, vibration, dynamics."""

from lumped.buckling import buckling_loads
from lumped.calibration import CALIBRATIONS, Calibration, calibrate, given
from lumped.continuation import Path, trace
from lumped.dynamics import INTEGRATORS, simulate
from lumped.sensitivity import Sensitivity, gradient, sensitivity
from lumped.statics import solve
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
