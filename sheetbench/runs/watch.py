"""What the samples of any run are watched for: energy from nowhere, strains beyond the model.

Whatever dampers take, kinetic + elastic + potential − work never grows in an exact run. A growth from its
lowest value so far, by more than GROWN of the energy that goes round, ends the run. With what dampers take,
as the rule of integration sums it, the balance is constant; a departure either way by more than TOLD is
reported. Losses are what the rule takes (`History.numerical`) and end no run. Strains beyond a model's limits
end none either: the run that came to them says so, and from when on.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import astuple, dataclass
from typing import Self

import numpy as np

from sheetbench.answers.solution import Status
from sheetbench.answers.table import number

GROWN = 0.1
TOLD = 0.01


@dataclass
class Watch:
    """origin: the balance at the start [J]; lowest: kinetic + elastic + potential − work at a sample so far
    [J]; largest: energy of any kind there [J]; off: the largest departure of the balance [J]; stretch: the
    largest so far, or what else a model measures strains by; since: when that first was beyond the model [s].
    """

    origin: float = np.nan
    lowest: float = np.inf
    largest: float = 0.0
    off: float = 0.0
    stretch: float = 0.0
    since: float = np.nan

    def strained(self, times: np.ndarray, stretches: np.ndarray, beyond: Callable[[float], str]) -> None:
        """Note how far the sheet is strained at samples (k,); beyond: a clause where that is too far."""
        largest = float(stretches.max(initial=-1.0))
        if largest >= self.stretch:
            self.stretch = largest
            if np.isnan(self.since) and beyond(largest):
                self.since = float(times[[bool(beyond(one)) for one in stretches.tolist()].index(True)])

    def grown(self, rows: np.ndarray) -> np.ndarray:
        """Energy from nowhere at samples (k,), over the largest until then; nan where that is no number.
        rows: (k, 6 or more), time, kinetic, elastic, potential and dissipated energy, work."""
        with np.errstate(invalid="ignore", over="ignore"):
            mechanical = rows[:, 1:4].sum(axis=1) - rows[:, 5]
            lowest = np.minimum(self.lowest, np.minimum.accumulate(mechanical))
            largest = np.maximum(self.largest, np.maximum.accumulate(np.abs(rows[:, 1:6]).max(axis=1)))
            gained = (mechanical - lowest) / np.where(largest > 0.0, largest, 1.0)
        return np.where(np.isfinite(rows).all(axis=1), gained, np.nan)

    def take(self, rows: np.ndarray) -> None:
        """Go on past sound samples."""
        if not len(rows):
            return
        balance = rows[:, 1:5].sum(axis=1) - rows[:, 5]
        if np.isnan(self.origin):
            self.origin = float(balance[0])
        self.lowest = min(self.lowest, float((rows[:, 1:4].sum(axis=1) - rows[:, 5]).min()))
        self.largest = max(self.largest, float(np.abs(rows[:, 1:6]).max()))
        self.off = max(self.off, float(np.abs(balance - self.origin).max()))

    def ending(self, outside: str, steps: str = "") -> tuple[Status, str]:
        """Return the status of a run that came to its end, and what there is to say; outside: a clause on the
        strains that went farthest beyond the model; steps: one on the steps."""
        notes = [f"from {number(self.since, '.4g')} s on {outside}"] if outside else []
        if self.largest > 0.0 and self.off > TOLD * self.largest:
            share = number(100.0 * self.off / self.largest, ".2g")
            notes.append(
                f"the energy balance is off by {share} % of the largest energy at some sample: energies are "
                "good to no more; smaller steps (--error, --step) keep it better"
            )
        notes += [steps] if steps else []
        return Status.STRAIN_OUTSIDE_MODEL if outside else Status.CONVERGED, "; ".join(notes)

    def memory(self) -> np.ndarray:
        """What a resumed run needs."""
        return np.array(astuple(self))

    @classmethod
    def recall(cls, memory: np.ndarray) -> Self:
        """Take up what `memory` gave."""
        return cls(*memory.tolist())
