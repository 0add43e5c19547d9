"""What every integrator offers."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, ClassVar, NamedTuple

import numpy as np

from lumped.dynamics.explicit.step_limit import StepLimit
from lumped.dynamics.system import State, System

STEPS_PER_PERIOD = 200  # by default


class StepFailed(ArithmeticError):
    """A time step found no solution; the text says why."""


@dataclass(frozen=True)
class Advance:
    """A step taken, or a part of one: the new state, the energies that dampers took and that were put in
    since it began [J]."""

    state: State
    dissipated: float
    work: float


class Samples(NamedTuple):
    """States at k moments: times (k,) [s]; displacements, velocities, accelerations (k, size, 3); memories of
    the material's branches; energies (k,) [J] that dampers took and that were put in."""

    time: np.ndarray
    u: np.ndarray
    v: np.ndarray
    a: np.ndarray
    memory: list[np.ndarray | None]
    dissipated: np.ndarray
    work: np.ndarray

    @classmethod
    def of(cls, state: State, dissipated: float = 0.0, work: float = 0.0) -> Samples:
        """One state, with the energies until then."""
        u, v, a = (np.ascontiguousarray(vector)[None] for vector in (state.u, state.v, state.a))
        return cls(np.array([state.time]), u, v, a, [state.memory], np.array([dissipated]), np.array([work]))

    def state(self, i: int) -> State:
        """State i."""
        return State(float(self.time[i]), self.u[i], self.v[i], self.a[i], self.memory[i])


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
    def default_step(cls, period: Callable[[], float], limit: StepLimit | None) -> float:
        """The step [s] where none is requested, an adaptive one's first: from the limit of stability where
        there is one, else from the lowest period [s]; infinite where it finds its first step itself."""
        return limit.advised if limit is not None else period() / STEPS_PER_PERIOD

    @classmethod
    def limit(cls, system: System, u: np.ndarray) -> StepLimit | None:
        """The limit of stability about a displacement (size, 3) [m], of explicit ones."""
        return None

    @abstractmethod
    def advance(self, state: State, at_most: float) -> Advance:
        """One step, no longer than `at_most` [s]. Raises StepFailed."""

    def march(self, state: State, step: float, most: int) -> tuple[Advance, int]:
        """Steps of the same length [s], at least one and `most` at most: where they lead, and how many, in
        well under a second. Raises StepFailed for the first of them."""
        return self.advance(state, step), 1

    def forget(self) -> None:  # noqa: B027  # most integrators keep nothing
        """Drop what was kept only for speed, so that a resumed run goes on exactly as one never stopped."""

    def memory(self) -> dict[str, Any]:
        """What a resumed run needs besides the state."""
        return {}

    def recall(self, memory: dict[str, Any]) -> None:  # noqa: B027
        """Take up what `memory` gave."""


class DenseIntegrator(Integrator):
    """One that tells the states within its steps, which need not end at samples."""

    @abstractmethod
    def at(self, times: np.ndarray) -> Samples:
        """The states at times (k,) [s] within the last step; energies since it began."""
