"""What every integrator of a lattice offers."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Callable
from typing import Any, ClassVar, NamedTuple

import numpy as np

from lumped.dynamics.explicit.step_limit import StepLimit
from lumped.dynamics.system import State, System
from sheetbench.numerics.time.method import Advance, MotionMethod, StepFailed

__all__ = ["Advance", "Integrator", "LatticeSamples", "StepFailed"]

STEPS_PER_PERIOD = 200  # by default


class LatticeSamples(NamedTuple):
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
    def of(cls, state: State, dissipated: float = 0.0, work: float = 0.0) -> LatticeSamples:
        """Return one state, with the energies until then."""
        u, v, a = (np.ascontiguousarray(vector)[None] for vector in (state.u, state.v, state.a))
        return cls(np.array([state.time]), u, v, a, [state.memory], np.array([dissipated]), np.array([work]))

    def state(self, i: int) -> State:
        """Return state i."""
        return State(float(self.time[i]), self.u[i], self.v[i], self.a[i], self.memory[i])


class Integrator(MotionMethod[State]):
    """Takes a system from one state to the next.

    step: [s]; order: declared, of the displacement; adaptive: whether it chooses its steps by their error,
    unless it is made `fixed`; explicit: whether its steps have a limit of stability; options: names of
    what else the user may choose. Steps of one length end at times that lie farther from each other than
    that: a table with more samples than there are steps has no corner to step onto.
    """

    name: ClassVar[str]
    order: ClassVar[int]
    adaptive: ClassVar[bool] = False
    explicit: ClassVar[bool] = False
    options: ClassVar[tuple[str, ...]] = ()
    state = State

    def __init__(self, system: System, step: float, fixed: bool = True):
        self.system, self.step, self.adapts = system, step, not fixed
        gaps = np.diff(system.kinks, prepend=-np.inf, append=np.inf)
        apart = np.minimum(gaps[:-1], gaps[1:])[: len(system.kinks)]
        self.kinks = system.kinks if self.adapts else system.kinks[apart > step]

    @classmethod
    def default_step(cls, period: Callable[[], float], limit: StepLimit | None) -> float:
        """Return the step [s] where none is requested, an adaptive one's first: from the limit of stability
        where there is one, else from the lowest period [s]; infinite where it finds its first step itself."""
        return limit.advised if limit is not None else period() / STEPS_PER_PERIOD

    @classmethod
    def limit(cls, system: System, u: np.ndarray) -> StepLimit | None:
        """Return the limit of stability about a displacement (size, 3) [m], of explicit ones."""
        return None

    @abstractmethod
    def advance(self, state: State, at_most: float) -> Advance[State]:
        """Return one step, of `at_most` [s], or one that adapts no longer. Raises StepFailed, or
        SingularMatrixError."""

    def go(self, state: State, at_most: float) -> Advance[State]:
        """Return a step that adapts, or steps of one length as near as can be to the integrator's own."""
        if self.adapts:
            return self.advance(state, at_most)
        left = max(int(np.ceil(at_most / self.step - 1e-6)), 1)
        whole = abs(at_most / self.step - left) < 1e-6
        return self.march(state, self.step if whole else at_most / left, left)

    def march(self, state: State, step: float, most: int) -> Advance[State]:
        """Return steps of the same length [s], at least one and `most` at most, in well under a second.
        Raises StepFailed for the first of them."""
        return self.advance(state, step)

    def at(self, times: np.ndarray, last: Advance[State]) -> LatticeSamples:
        """Return the last step's end."""
        return LatticeSamples.of(last.state, last.dissipated, last.work)

    def settings(self) -> dict[str, Any]:
        """Return the length of its steps."""
        return {"step": "adaptive" if self.adapts else self.step}
