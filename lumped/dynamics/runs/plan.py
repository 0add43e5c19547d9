"""Division of a run into samples and steps; periods and limits of a motion before it runs."""

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

MOST_DEFAULT_STEPS = 10_000_000  # of an explicit run without a given step: an hour or more
MOST_STEPS = 10**10  # of any run: weeks


def plan_run(
    system: System,
    calibration: Calibration,
    limit: StepLimit | None,
    duration: float,
    step: float | None,
    integrator: str,
    every: float | None,
) -> tuple[Schedule, float]:
    """Return the schedule of a run's samples, and the length of its steps [s], or of the first one of an
    adaptive integrator; see `lumped.simulate` for the defaults. limit: of stability, of an explicit
    integrator.

    Raises BadInput for a step above the limit of stability, too many steps, or too many samples.
    """
    kind = INTEGRATORS[integrator]

    @cache
    def period() -> float:
        return 1.0 / float(modes(system.scene, calibration, 1, calibration.masses).frequencies[0])

    schedule = schedule_of(duration, every, period, step)
    length = step if step is not None else kind.default_step(period, limit)
    if limit is not None:
        if length > limit.step:
            raise BadInput(
                f"step = {step:g} s: above the stability limit of {integrator}, {limit.describe()}"
            )
        if step is None and duration / length > MOST_DEFAULT_STEPS:
            raise BadInput(
                f"integrator = '{integrator}': would take {duration / length:.1e} steps, its stability limit "
                f"being {limit.describe()}; choose an implicit integrator, or give a step"
            )
    if duration / length > MOST_STEPS:
        raise BadInput(
            f"step = {length:g} s: {duration / length:.1e} steps to {duration:g} s; {MOST_STEPS:.0e} at most"
        )
    steps = max(int(np.ceil(schedule.every / length - 1e-9)), 1)
    return schedule, schedule.every / steps


def shortest_period(scene: Scene, springs: Calibration) -> float:
    """Return the lowest mode's period about the flat sheet or about its equilibrium, the shorter of both.

    Parameters
    ----------
    scene : Scene
        Sheet, supports and loads.
    springs : Calibration
        Springs of the lattice.

    Returns
    -------
    float
        Period [s]; of the flat sheet if there is no stable equilibrium.
    """
    lowest = [modes(scene, springs, 1, springs.masses)]
    with suppress(NoEquilibrium, SceneError):  # without an equilibrium the flat sheet's period
        lowest.append(modes(scene, springs, 1, springs.masses, "deformed"))
    return 1.0 / max(float(result.frequencies[0]) for result in lowest)


def explicit_limit(integrator: str, scene: Scene, springs: Calibration) -> float:
    """Return the stability limit of an explicit integrator about the flat sheet.

    Parameters
    ----------
    integrator : str
        Name of an explicit integrator of `INTEGRATORS`.
    scene : Scene
        Sheet, supports and damping.
    springs : Calibration
        Springs of the lattice.

    Returns
    -------
    float
        Largest stable step [s].

    Notes
    -----
    The limit 2/ω_max, less with dampers, is derived in `lumped.dynamics.explicit.step_limit`.
    """
    problem = build_problem(scene, springs)
    flat = np.zeros_like(problem.loads.dead)
    limit = INTEGRATORS[integrator].limit(System(scene, problem), flat)
    assert limit is not None
    return limit.step
