"""What every integrator offers, and the Newton iteration that the implicit ones share."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from lumped.dynamics.step_limit import StepLimit
from lumped.dynamics.system import State, System
from lumped.linear.solver import Factor

STEPS_PER_PERIOD = 200  # by default
CORRECTIONS = 20
STALE = 0.2  # ratio of successive corrections above which the factors are made anew


class StepFailed(ArithmeticError):
    """A time step found no solution; the text says why."""


@dataclass(frozen=True)
class Advance:
    """A step taken: the new state, the energy that dampers took [J] and the work done on the sheet [J]."""

    state: State
    dissipated: float
    work: float


class Integrator(ABC):
    """Takes a system from one state to the next.

    step: [s]; order: declared, of the displacement; adaptive: whether it chooses its steps by their error,
    unless it is made with `fixed`; explicit: whether its steps have a limit of stability; options: names of
    what else the user may choose.
    """

    name: ClassVar[str]
    order: ClassVar[int]
    adaptive: ClassVar[bool] = False
    explicit: ClassVar[bool] = False
    options: ClassVar[tuple[str, ...]] = ()

    def __init__(self, system: System, step: float):
        self.system, self.step = system, step

    @classmethod
    def default_step(cls, period: float, limit: StepLimit | None) -> float:
        """The step [s] where none is asked for, an adaptive one's first: from the limit of stability where
        there is one, else from the lowest period [s]."""
        return limit.advised if limit is not None else period / STEPS_PER_PERIOD

    @abstractmethod
    def advance(self, state: State, at_most: float) -> Advance:
        """One step, no longer than `at_most` [s]. Raises StepFailed."""

    def forget(self) -> None:  # noqa: B027  # most integrators keep nothing
        """Drop what was kept only for speed, so that a resumed run goes on exactly as one never stopped."""

    def memory(self) -> dict[str, Any]:
        """What a resumed run needs besides the state."""
        return {}

    def recall(self, memory: dict[str, Any]) -> None:  # noqa: B027
        """Take up what `memory` gave."""


class Newton:
    """Newton's iteration with factors kept from step to step while corrections shrink fast enough."""

    def __init__(self, system: System, tolerance: float):
        self._system, self._tolerance = system, tolerance * system.problem.size
        self._factor: Factor | None = None
        self._key: Any = None
        multipliers = system.coupling.algebraic if system.coupling is not None else np.zeros((1, 3), bool)
        size = (system.assembly.pattern.size, 3)
        self._placed = ~np.broadcast_to(multipliers, size)  # multipliers carry the rounding of inertia forces

    def forget(self) -> None:
        """Drop the factors."""
        self._factor = None

    def solve(
        self,
        key: Any,
        residual: Callable[[np.ndarray], np.ndarray],
        blocks: Callable[[np.ndarray], np.ndarray],
        guess: np.ndarray,
        weigh: Callable[[np.ndarray], np.ndarray],
    ) -> np.ndarray:
        """u with Tᵀ residual(u) = 0. key: factors of another key do not serve; weigh: the correction
        (size, 3) from the solution of the linear system. Raises StepFailed."""
        problem = self._system.problem
        u, last, fresh = guess, np.inf, False
        if key != self._key:
            self._factor, self._key = None, key
        for _ in range(CORRECTIONS):
            if self._factor is None:
                self._factor, fresh = problem.factor(blocks(u)), True
            correction = weigh(problem.expand(self._factor.solve(-problem.reduce(residual(u)))))
            u = u + correction
            length = float(np.abs(correction[self._placed]).max())
            if not np.isfinite(length):
                break
            if length < self._tolerance:
                return u
            if length > problem.size:
                break
            if length > STALE * last and not fresh:
                self._factor = None
            last, fresh = length, False
        self._factor = None
        raise StepFailed("the time step's equations did not converge: use smaller steps")
