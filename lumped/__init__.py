"""The spring lattice: topology, springs and cells, calibration, statics, vibration, dynamics."""

from lumped import moduli
from lumped.assembly import Assembly
from lumped.calibration import Calibration, given, homogenised
from lumped.description import Description, describe
from lumped.dynamics import (
    INTEGRATORS,
    Integrator,
    State,
    StepFailed,
    StepLimit,
    System,
    simulate,
    step_limit,
    turn_limit,
    watchdog,
)
from lumped.fitting import (
    CALIBRATIONS,
    FittedCalibration,
    Identifiability,
    ModalTarget,
    StaticTarget,
    calibrate,
    identifiability,
)
from lumped.footprint import footprint
from lumped.lattice import Lattice
from lumped.linearised import Linear, linearise
from lumped.masses import Inertia
from lumped.mid_surface import MidSurface
from lumped.sensitivity import Sensitivity, gradient, sensitivity
from lumped.state_space import Balanced, StateSpace
from lumped.statics.buckling import buckling_loads
from lumped.statics.continuation import Path, trace
from lumped.statics.equilibrium import at_rest, follow
from lumped.statics.many import solve_many
from lumped.statics.polygon import polygons
from lumped.statics.solver import pose, solve
from lumped.vibration import Modes, modes, usual_masses

__all__ = [
    "CALIBRATIONS",
    "INTEGRATORS",
    "Assembly",
    "Balanced",
    "Calibration",
    "Description",
    "FittedCalibration",
    "Identifiability",
    "Inertia",
    "Integrator",
    "Lattice",
    "Linear",
    "MidSurface",
    "ModalTarget",
    "Modes",
    "Path",
    "Sensitivity",
    "State",
    "StateSpace",
    "StaticTarget",
    "StepFailed",
    "StepLimit",
    "System",
    "at_rest",
    "buckling_loads",
    "calibrate",
    "describe",
    "follow",
    "footprint",
    "given",
    "gradient",
    "homogenised",
    "identifiability",
    "linearise",
    "modes",
    "moduli",
    "polygons",
    "pose",
    "sensitivity",
    "simulate",
    "solve",
    "solve_many",
    "step_limit",
    "trace",
    "turn_limit",
    "usual_masses",
    "watchdog",
]
