"""The spring lattice: topology, springs and cells, calibration, statics, vibration."""

from lumped.buckling import buckling_loads
from lumped.calibration import CALIBRATIONS, Calibration, calibrate, given
from lumped.continuation import Path, trace
from lumped.statics import solve
from lumped.vibration import Modes, modes

__all__ = [
    "CALIBRATIONS",
    "Calibration",
    "Modes",
    "Path",
    "buckling_loads",
    "calibrate",
    "given",
    "modes",
    "solve",
    "trace",
]
