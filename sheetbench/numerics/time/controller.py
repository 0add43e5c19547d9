"""The length of steps by their error, for every integrator that adapts them.

A step of length h with an error ε of the order h^p, where ε₀ is allowed, is followed by one of

    h min(max(r, ½), growth),    r = 0.9 (ε₀/ε)^(1/p),

unless r lies within a band about 1 in which lengths, and with them factors, stay. It is repeated with
h max(r, 1/5) where ε > ε₀, and with h/4 where it finds no solution. At the shortest length it counts in
spite of its error, and the run says so. Source: Hairer and Wanner (1996), IV.8.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from sheetbench.numerics.time.method import StepFailed

SAFETY = 0.9


@dataclass
class Controller:
    """order: p; growth: the longest step after one, over that; band: of r, in which lengths stay; step: the
    next to be tried [s]; floored: steps that counted in spite of their error."""

    order: int
    growth: float
    band: tuple[float, float]
    step: float
    floored: int = 0

    def dividing(self, at_most: float, fewer: float = np.inf) -> float:
        """Return a step no longer than the one to be tried that divides a time [s] evenly; that one itself
        where these are not `fewer` steps."""
        count = np.ceil(at_most / self.step - 1e-9)
        return float(at_most / count) if count < fewer else self.step

    def ratio(self, error: float, allowed: float) -> float:
        """Return r."""
        return float(SAFETY * (allowed / max(error, 1e-30)) ** (1.0 / self.order))

    def accepts(self, error: float, allowed: float, h: float, shortest: float) -> bool:
        """Return whether a step of length h [s] counts; the next one's length follows. shortest [s]: a step
        no longer always counts."""
        ratio = self.ratio(error, allowed)
        if error > allowed and h > shortest:
            self.step = h * max(ratio, 0.2)
            return False
        self.floored += error > allowed
        if not self.band[0] <= ratio <= self.band[1]:
            self.step = h * min(max(ratio, 0.5), self.growth)
        return True

    def shorten(self, failure: Exception, h: float, shortest: float) -> None:
        """Try a quarter of a step that found no solution. Raises StepFailed where it was the shortest."""
        if h < shortest:
            raise StepFailed(f"{failure} in a step of {h:.3g} s") from None
        self.step = 0.25 * h

    def memory(self) -> dict[str, Any]:
        """Return what a resumed run needs."""
        return {"step": self.step, "floored": self.floored}

    def recall(self, memory: dict[str, Any]) -> None:
        """Take up what `memory` gave."""
        self.step, self.floored = float(memory["step"]), int(memory["floored"])

    def notes(self) -> str:
        """Return a clause on steps that counted in spite of their error."""
        if not self.floored:
            return ""
        return f"{self.floored} steps of the shortest length have a larger error than asked for"
