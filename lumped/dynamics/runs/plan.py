"""How samples divide a run, and steps the time between samples."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import numpy as np

from lumped.calibration import Calibration
from lumped.dynamics.explicit.step_limit import StepLimit
from lumped.dynamics.integrators import INTEGRATORS
from lumped.dynamics.system import System
from lumped.vibration import modes
from sheetbench.errors import BadInput
from sheetbench.runs.schedule import SAMPLES_PER_PERIOD, Schedule, sample_count

MOST_DEFAULT_STEPS = 10_000_000  # that an explicit run takes unasked: an hour or more
MOST_STEPS = 10**10  # that any run takes: weeks


@dataclass(frozen=True)
class StepPlan(Schedule):
    """A schedule with so many steps between two samples, of which the first one's is only the first tried
    where the integrator `adapts` them."""

    steps: int
    adapts: bool


def plan_run(
    system: System,
    calibration: Calibration,
    limit: StepLimit | None,
    duration: float,
    step: float | None,
    integrator: str,
    every: float | None,
) -> StepPlan:
    """How a run that begins is sampled and stepped; see `lumped.simulate` for the defaults. limit: of
    stability, of an explicit integrator.

    Raises BadInput for a step above the limit of an explicit one, too many of them, or too many samples.
    """
    kind = INTEGRATORS[integrator]

    @cache
    def period() -> float:
        return 1.0 / float(modes(system.scene, calibration, 1, calibration.masses).frequencies[0])

    spacing = every if every is not None else period() / SAMPLES_PER_PERIOD
    if step is not None and every is None:
        spacing = max(spacing, step)
    samples = sample_count(duration, spacing, whole=every is not None)
    spacing = duration / samples
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
    steps = max(int(np.ceil(spacing / wanted - 1e-9)), 1)
    return StepPlan(samples, spacing, steps, kind.adaptive and step is None)
