"""How samples divide a run, and steps the time between samples."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cache

import numpy as np

from lumped.calibration import Calibration
from lumped.dynamics.explicit.step_limit import StepLimit
from lumped.dynamics.integrators import INTEGRATORS
from lumped.dynamics.system import System
from lumped.vibration import modes
from sheetbench.errors import BadInput

SAMPLES_PER_PERIOD = 100
MOST_DEFAULT_STEPS = 10_000_000  # that an explicit run takes unasked: an hour or more
MOST_STEPS = 10**10  # that any run takes: weeks
MOST_SAMPLES = 10**7  # that any run keeps: gigabytes


@dataclass(frozen=True)
class Plan:
    """samples: after the start, `every` [s] apart; steps: between two of them, where the integrator `adapts`
    the first one's; first: samples of the run as it began, before it was to last longer.
    """

    samples: int
    every: float
    steps: int
    adapts: bool
    first: int

    def longer(self, duration: float) -> Plan:
        """Return the plan that goes on to the first sample at or after `duration` [s]. Raises BadInput where
        that is before the end of this one."""
        samples = int(np.ceil(duration / self.every - 1e-9))
        if samples < self.samples:
            raise BadInput(
                f"duration = {duration:g} s: the run that is kept there is one of "
                f"{self.samples * self.every:g} s; ask for that or longer, or choose another folder"
            )
        return replace(self, samples=samples)

    def shown(self, frames: int) -> list[int]:
        """Samples to keep whole: `frames` evenly over the run as it began, and on at that distance."""
        if frames < 2:
            return list(range(frames))
        apart = self.first / (frames - 1)
        return sorted({round(i * apart) for i in range(int(self.samples / apart + 1e-9) + 1)})


def plan_run(
    system: System,
    calibration: Calibration,
    limit: StepLimit | None,
    duration: float,
    step: float | None,
    integrator: str,
    every: float | None,
) -> Plan:
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
    if duration / spacing > MOST_SAMPLES:
        raise BadInput(
            f"duration = {duration:g} s: would keep {duration / spacing:.1e} samples, {spacing:.3g} s apart; "
            f"{MOST_SAMPLES:.0e} at most: ask for a shorter run, or samples farther apart (--every)"
        )
    samples = round(duration / spacing) if every is not None else int(np.ceil(duration / spacing - 1e-9))
    samples = max(samples, 1)
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
    return Plan(samples, spacing, steps, kind.adaptive and step is None, samples)
