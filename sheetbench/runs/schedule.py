"""How samples divide a run, one that is taken up again to last longer too."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Self

import numpy as np

from sheetbench.errors import BadInput

SAMPLES_PER_PERIOD = 100
SAMPLES_PER_CHECKPOINT = 50
LARGEST_ERROR = 0.1  # of a step, relative to the largest displacement
MOST_SAMPLES = 10**7  # that any run keeps: gigabytes


@dataclass(frozen=True)
class Schedule:
    """samples: after the start, `every` [s] apart; first: samples of the run as it began, before it was to
    last longer."""

    samples: int
    every: float
    first: int

    def longer(self, duration: float) -> Self:
        """Return the one that goes on to the first sample at or after `duration` [s]. Raises BadInput where
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
        frame_spacing = self.first / (frames - 1)
        return sorted({round(i * frame_spacing) for i in range(int(self.samples / frame_spacing + 1e-9) + 1)})


def require_error(error: float) -> None:
    """Raise BadInput for an error of a step with which no motion is left to see."""
    if not 0.0 < error < LARGEST_ERROR:
        raise BadInput(
            f"error = {error:g}: of a step, relative to the largest displacement, lies between 0 and "
            f"{LARGEST_ERROR:g}"
        )


def sample_count(duration: float, spacing: float, whole: bool) -> int:
    """Samples of a run at about this distance [s], or at least as close; whole: as near to it as can be.
    Raises BadInput for too many."""
    if duration / spacing > MOST_SAMPLES:
        raise BadInput(
            f"duration = {duration:g} s: would keep {duration / spacing:.1e} samples, {spacing:.3g} s apart; "
            f"{MOST_SAMPLES:.0e} at most: ask for a shorter run, or samples farther apart (--every)"
        )
    return max(round(duration / spacing) if whole else int(np.ceil(duration / spacing - 1e-9)), 1)
