"""Control of the length of steps by their error, for every integrator that adapts them.

If a step of length h has an error ε of the order h^p, where ε₀ is allowed, the next length is

    h min(max(r, ½), growth),    r = 0.9 (ε₀/ε)^(1/p),

unless r lies within a band about 1, in which the length, and with it factors, are kept. A step is repeated
with h max(r, 1/5) if ε > ε₀, and with h/4 if it finds no solution. A step of the shortest length is accepted
in spite of its error, and the run reports it. Source: Hairer and Wanner (1996), IV.8.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, ClassVar, TypeVar

import numpy as np

from sheetbench.numerics.reduced_system import SingularMatrixError

SAFETY = 0.9

T = TypeVar("T")
Tried = tuple[T, float, float]  # a step, its error and the allowed error


class StepFailed(ArithmeticError):
    """A time step without a solution; the text is the reason."""


class Resumable:
    """Base of objects with attributes that a resumed run needs. remembered: their names."""

    remembered: ClassVar[tuple[str, ...]] = ()

    def memory(self) -> dict[str, Any]:
        """Return the attributes that a resumed run needs besides the state."""
        return {name: getattr(self, name) for name in self.remembered}

    def restore(self, memory: dict[str, Any]) -> None:
        """Restore the attributes from `memory`."""
        for name in self.remembered:
            value = np.asarray(memory[name])
            setattr(self, name, value if value.ndim else value.item())


@dataclass
class Controller(Resumable):
    """Control of the steps of one integrator. order: p. growth: largest ratio of consecutive lengths. band:
    of r, in which the length is kept. step: length of the next trial [s]. floored: number of steps accepted
    in spite of their error. rejected: number of repeated steps."""

    remembered = ("step", "floored", "rejected")
    order: int
    growth: float
    band: tuple[float, float]
    step: float
    floored: int = 0
    rejected: int = 0

    def dividing(self, at_most: float, fewer: float = np.inf) -> float:
        """Return a step no longer than the next trial that divides a time [s] evenly. The trial's own length
        is returned if the time takes `fewer` steps or more."""
        count = np.ceil(at_most / self.step - 1e-9)
        return float(at_most / count) if count < fewer else self.step

    def ratio(self, error: float, allowed: float) -> float:
        """Return the ratio r of an error to the allowed one, whose power scales the step."""
        return float(SAFETY * (allowed / max(error, 1e-30)) ** (1.0 / self.order))

    def take(
        self, attempt: Callable[[float], Tried[T]], at_most: float, shortest: float, fewer: float = np.inf
    ) -> tuple[T, float]:
        """Return the first accepted step no longer than `at_most` [s], and its length [s]. attempt: makes a
        step of a length, with its error and the allowed error. shortest: length [s] up to which a step is
        always accepted. The length of the next trial is set. Raises StepFailed if there is no solution."""
        while True:
            h = self.dividing(at_most, fewer)
            try:
                step, error, allowed = attempt(h)
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
            return step, h

    def notes(self) -> str:
        """Return a clause on steps accepted with a larger error than allowed, "" without any."""
        if not self.floored:
            return ""
        count = f"{self.floored} step{'s' * (self.floored > 1)} of the shortest length"
        return f"{count} with a larger error than the limit"
