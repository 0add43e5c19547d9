"""Dynamics of the lattice: integrators by name, streaming runs, histories."""

from lumped.dynamics.explicit.step_limit import StepLimit, step_limit, turn_limit
from lumped.dynamics.integrator import Integrator, StepFailed
from lumped.dynamics.integrators import INTEGRATORS, require_integrator
from lumped.dynamics.runs.initial import in_motion
from lumped.dynamics.runs.observer import LatticeObserver
from lumped.dynamics.runs.plan import explicit_limit, shortest_period
from lumped.dynamics.runs.simulation import simulate
from lumped.dynamics.system import State, System

__all__ = [
    "INTEGRATORS",
    "Integrator",
    "LatticeObserver",
    "State",
    "StepFailed",
    "StepLimit",
    "System",
    "explicit_limit",
    "in_motion",
    "require_integrator",
    "shortest_period",
    "simulate",
    "step_limit",
    "turn_limit",
]
