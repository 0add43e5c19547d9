"""The times of a motion before it runs: its lowest period, and the largest stable step of explicit runs."""

from __future__ import annotations

from contextlib import suppress

import numpy as np

from lumped.calibration import Calibration
from lumped.dynamics.integrators import INTEGRATORS
from lumped.dynamics.system import System
from lumped.statics.solver import build_problem
from lumped.vibration import modes
from sheetbench.errors import NoEquilibrium
from sheetbench.scenes import Scene, SceneError


def shortest_period(scene: Scene, springs: Calibration) -> float:
    """Return the lowest mode's period [s] about the flat sheet or about its equilibrium, the shorter."""
    found = [modes(scene, springs, 1, springs.masses)]
    with suppress(NoEquilibrium, SceneError):  # where there is none, the flat sheet's it is
        found.append(modes(scene, springs, 1, springs.masses, "deformed"))
    return 1.0 / max(float(one.frequencies[0]) for one in found)


def explicit_limit(integrator: str, scene: Scene, springs: Calibration) -> float:
    """Return the stability limit [s] of an explicit integrator about the flat sheet."""
    problem = build_problem(scene, springs)
    flat = np.zeros_like(problem.loads.dead)
    limit = INTEGRATORS[integrator].limit(System(scene, problem), flat)
    assert limit is not None
    return limit.step
