"""Division of a run into samples."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from sheetbench.errors import BadInput

SAMPLES_PER_PERIOD = 100
SAMPLES_PER_CHECKPOINT = 50
LARGEST_ERROR = 0.1  # of a step, relative to the largest displacement
MOST_SAMPLES = 10**7  # of a run: gigabytes


@dataclass(frozen=True)
class Schedule:
    """Samples of a run: their number after the start, and their distance `every` [s]."""

    samples: int
    every: float

    def shown(self, frames: int) -> list[int]:
        """Return the numbers of the samples kept as frames, `frames` of them evenly over the run."""
        if frames < 2:
            return list(range(frames))
        return sorted({round(i * self.samples / (frames - 1)) for i in range(frames)})


def require_error(error: float) -> None:
    """Raise BadInput for an error of a step so large that it would hide the motion."""
    if not 0.0 < error < LARGEST_ERROR:
        raise BadInput(
            f"error = {error:g}: of a step, relative to the largest displacement, lies between 0 and "
            f"{LARGEST_ERROR:g}"
        )


def schedule_of(
    duration: float, every: float | None, period: Callable[[], float], step: float | None = None
) -> Schedule:
    """Return the samples of a run at distances of about `every` [s]. The default is SAMPLES_PER_PERIOD
    samples in the lowest period [s], or one a step [s] if steps are longer. Raises BadInput for too many
    samples."""
    spacing = every or max(period() / SAMPLES_PER_PERIOD, step or 0.0)
    if duration / spacing > MOST_SAMPLES:
        raise BadInput(
            f"duration = {duration:g} s: would keep {duration / spacing:.1e} samples, {spacing:.3g} s apart; "
            f"{MOST_SAMPLES:.0e} at most: ask for a shorter run, or samples farther apart (--every)"
        )
    samples = max(round(duration / spacing) if every else int(np.ceil(duration / spacing - 1e-9)), 1)
    return Schedule(samples, duration / samples)
