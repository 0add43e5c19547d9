"""How samples divide a run, and steps the time between samples; the times of a motion before it runs."""

from __future__ import annotations

from contextlib import suppress
from functools import cache

import numpy as np

from lumped.calibration import Calibration
from lumped.dynamics.explicit.step_limit import StepLimit
from lumped.dynamics.integrators import INTEGRATORS
from lumped.dynamics.system import System
from lumped.statics.solver import build_problem
from lumped.vibration import modes
from sheetbench.errors import BadInput, NoEquilibrium
from sheetbench.runs.schedule import Schedule, schedule_of
from sheetbench.scenes import Scene, SceneError

MOST_DEFAULT_STEPS = 10_000_000  # that an explicit run takes unasked: an hour or more
MOST_STEPS = 10**10  # that any run takes: weeks


def plan_run(
    system: System,
    calibration: Calibration,
    limit: StepLimit | None,
    duration: float,
    step: float | None,
    integrator: str,
    every: float | None,
) -> tuple[Schedule, float]:
    """Return how a run is sampled, and the length of its steps [s], or of the first to be tried where the
    integrator adapts them; see `lumped.simulate` for the defaults. limit: of stability, of an explicit one.

    Raises BadInput for a step above the limit of an explicit one, too many of them, or too many samples.
    """
    kind = INTEGRATORS[integrator]

    @cache
    def period() -> float:
        return 1.0 / float(modes(system.scene, calibration, 1, calibration.masses).frequencies[0])

    schedule = schedule_of(duration, every, period, step)
    wanted = step if step is not None else kind.default_step(period, limit)
    if limit is not None:
        if wanted > limit.step:
            raise BadInput(
                f"step = {step:g} s: above the stability limit of {integrator}, {limit.describe()}"
            )
        if step is None and duration / wanted > MOST_DEFAULT_STEPS:
            raise BadInput(
                f"integrator = '{integrator}': would take {duration / wanted:.1e} steps, its stability limit "
                f"being {limit.describe()}; choose an implicit integrator, or give a step to insist"
            )
    if duration / wanted > MOST_STEPS:
        raise BadInput(
            f"step = {wanted:g} s: {duration / wanted:.1e} steps to {duration:g} s; {MOST_STEPS:.0e} at most"
        )
    steps = max(int(np.ceil(schedule.every / wanted - 1e-9)), 1)
    return schedule, schedule.every / steps


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
