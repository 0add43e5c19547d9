"""The spring lattice: topology, springs and cells, calibration, statics, vibration, dynamics.

Motion is imported when it is first requested: a tenth of a second that statics need not wait for.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

from lumped import moduli
from lumped.actuators.division import refining_cells
from lumped.calibration import Calibration, given
from lumped.calibration.cell_by_cell import with_shares
from lumped.fitting.fits import ModalTarget, StaticTarget
from lumped.fitting.identifiability import Identifiability, identifiability
from lumped.fitting.methods import CALIBRATIONS, calibrate
from lumped.footprint import footprint
from lumped.many import Designs, solve_many
from lumped.masses import Inertia
from lumped.mid_surface import MidSurface
from lumped.pretension import calibrated_at_rest
from lumped.sections import require_alike, sections_of
from lumped.sensitivity import Differentiable
from lumped.statics.buckling import buckling
from lumped.statics.solver import build_problem, solve
from lumped.vibration import Modes, modes, usual_masses

if TYPE_CHECKING:
    from lumped.description import Description, describe
    from lumped.dynamics.explicit.step_limit import step_limit
    from lumped.dynamics.integrator import Integrator, StepFailed
    from lumped.dynamics.integrators import INTEGRATORS, require_integrator
    from lumped.dynamics.runs.initial import in_motion
    from lumped.dynamics.runs.observer import LatticeObserver
    from lumped.dynamics.runs.plan import explicit_limit, shortest_period
    from lumped.dynamics.runs.simulation import simulate
    from lumped.dynamics.system import State, System
    from lumped.linearised import Linear, linearise
    from lumped.state_space import Balanced, StateSpace

__all__ = [
    "CALIBRATIONS",
    "INTEGRATORS",
    "Balanced",
    "Calibration",
    "Description",
    "Designs",
    "Differentiable",
    "Identifiability",
    "Inertia",
    "Integrator",
    "LatticeObserver",
    "Linear",
    "MidSurface",
    "ModalTarget",
    "Modes",
    "State",
    "StateSpace",
    "StaticTarget",
    "StepFailed",
    "System",
    "buckling",
    "build_problem",
    "calibrate",
    "calibrated_at_rest",
    "describe",
    "explicit_limit",
    "footprint",
    "given",
    "identifiability",
    "in_motion",
    "linearise",
    "modes",
    "moduli",
    "refining_cells",
    "require_alike",
    "require_integrator",
    "sections_of",
    "shortest_period",
    "simulate",
    "solve",
    "solve_many",
    "step_limit",
    "usual_masses",
    "with_shares",
]

_LATER = {"Linear": "lumped.linearised", "linearise": "lumped.linearised"}
_LATER |= {"Description": "lumped.description", "describe": "lumped.description"}
_LATER |= {"Balanced": "lumped.state_space", "StateSpace": "lumped.state_space"}


def __getattr__(name: str) -> Any:
    if name not in __all__:
        raise AttributeError(f"module 'lumped' has no attribute {name!r}")
    return getattr(import_module(_LATER.get(name, "lumped.dynamics")), name)


def __dir__() -> list[str]:
    return __all__
