"""The spring lattice: topology, springs and cells, calibration, statics."""

from lumped.buckling import buckling_loads
from lumped.calibration import CALIBRATIONS, Calibration, calibrate, given
from lumped.continuation import Path, trace
from lumped.statics import solve

__all__ = ["CALIBRATIONS", "Calibration", "Path", "buckling_loads", "calibrate", "given", "solve", "trace"]
