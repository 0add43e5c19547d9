"""The length of steps by their error, for every integrator that adapts them.

A step of length h with an error ε of the order h^p, where ε₀ is allowed, is followed by one of

    h min(max(r, ½), growth),    r = 0.9 (ε₀/ε)^(1/p),

unless r lies within a band about 1 in which lengths, and with them factors, stay. It is repeated with
h max(r, 1/5) where ε > ε₀, and with h/4 where it finds no solution. At the shortest length it counts in
spite of its error, and the run says so. Source: Hairer and Wanner (1996), IV.8.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, ClassVar, TypeVar

import numpy as np

from sheetbench.numerics.reduced_system import SingularMatrixError

SAFETY = 0.9

T = TypeVar("T")
Tried = tuple[T, float, float]  # a step, its error and what is allowed


class StepFailed(ArithmeticError):
    """A time step found no solution; the text says why."""


class Remembering:
    """Something with attributes that a resumed run needs. remembered: their names."""

    remembered: ClassVar[tuple[str, ...]] = ()

    def memory(self) -> dict[str, Any]:
        """Return what a resumed run needs besides the state."""
        return {name: getattr(self, name) for name in self.remembered}

    def recall(self, memory: dict[str, Any]) -> None:
        """Take up what `memory` gave."""
        for name in self.remembered:
            value = np.asarray(memory[name])
            setattr(self, name, value if value.ndim else value.item())


@dataclass
class Controller(Remembering):
    """order: p; growth: the longest step after one, over that; band: of r, in which lengths stay; step: the
    next to be tried [s]; floored: steps that counted in spite of their error; rejected: those repeated."""

    remembered = ("step", "floored", "rejected")
    order: int
    growth: float
    band: tuple[float, float]
    step: float
    floored: int = 0
    rejected: int = 0

    def dividing(self, at_most: float, fewer: float = np.inf) -> float:
        """Return a step no longer than the one to be tried that divides a time [s] evenly; that one itself
        where these are not `fewer` steps."""
        count = np.ceil(at_most / self.step - 1e-9)
        return float(at_most / count) if count < fewer else self.step

    def ratio(self, error: float, allowed: float) -> float:
        """Return r."""
        return float(SAFETY * (allowed / max(error, 1e-30)) ** (1.0 / self.order))

    def take(
        self, attempt: Callable[[float], Tried[T]], at_most: float, shortest: float, fewer: float = np.inf
    ) -> tuple[T, float]:
        """Return the first step of at most so long [s] that counts, and its length [s]; the next one's length
        follows. attempt: a step of a length, its error and what is allowed; shortest [s]: a step no longer
        always counts. Raises StepFailed where it finds no solution."""
        while True:
            h = self.dividing(at_most, fewer)
            try:
                found, error, allowed = attempt(h)
            except (StepFailed, SingularMatrixError) as failure:
                if h < shortest:
                    raise StepFailed(f"{failure} in a step of {h:.3g} s") from None
                self.step = 0.25 * h
                continue
            ratio = self.ratio(error, allowed)
            if error > allowed and h > shortest:
                self.step = h * max(ratio, 0.2)
                self.rejected += 1
                continue
            self.floored += error > allowed
            if not self.band[0] <= ratio <= self.band[1]:
                self.step = h * min(max(ratio, 0.5), self.growth)
            return found, h

    def notes(self) -> str:
        """Return a clause on steps that counted in spite of their error."""
        if not self.floored:
            return ""
        count = f"{self.floored} step{'s' * (self.floored > 1)} of the shortest length"
        return f"{count} with a larger error than asked for"
