"""What the samples of any run are watched for: energy from nowhere, strains beyond the model.

Whatever dampers take, kinetic + elastic + potential − work never grows in an exact run. A growth from its
lowest value so far, by more than GROWN of the energy that goes round, ends the run. With what dampers take,
as the rule of integration sums it, the balance is constant; a departure either way by more than TOLD is
reported. Losses are what the rule takes (`History.numerical`) and end no run. Strains beyond a model's limits
end none either: the run that came to them says so, and from when on.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import isfinite, isnan, nan
from typing import Self

import numpy as np
from numba import njit

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

    def take(self, rows: np.ndarray) -> tuple[int, float]:
        """Go on past samples (k, 6 or more), time, kinetic, elastic, potential and dissipated energy, work;
        return how many there are before the first that is unsound, and the energy from nowhere then, over the
        largest until then: nan where some number is none, and where all are sound."""
        sound, grown, *kept = take(rows, self.origin, self.lowest, self.largest, self.off)
        self.origin, self.lowest, self.largest, self.off = kept
        return sound, grown

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
        return np.array(list(vars(self).values()))

    @classmethod
    def recall(cls, memory: np.ndarray) -> Self:
        """Take up what `memory` gave."""
        return cls(*memory.tolist())


@njit(cache=True)
def take(
    rows: np.ndarray, origin: float, lowest: float, largest: float, off: float
) -> tuple[int, float, float, float, float, float]:
    """Return what `Watch.take` does, and what is kept then."""
    for k in range(len(rows)):
        row, most, finite = rows[k], largest, True
        for value in row:
            finite = finite and isfinite(value)
        for energy in row[1:6]:
            most = max(most, abs(energy))
        mechanical = row[1] + row[2] + row[3] - row[5]
        least = min(lowest, mechanical)
        grown = (mechanical - least) / most if finite and most > 0.0 else 0.0
        if not finite or grown > GROWN:
            return k, grown if finite else nan, origin, lowest, largest, off
        if isnan(origin):
            origin = mechanical + row[4]
        lowest, largest, off = least, most, max(off, abs(mechanical + row[4] - origin))
    return len(rows), nan, origin, lowest, largest, off
