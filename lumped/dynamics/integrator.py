"""The interface of a lattice's integrators."""

from abc import abstractmethod
from collections.abc import Callable
from typing import Any, ClassVar, NamedTuple, Self

import numpy as np

from lumped.dynamics.explicit.step_limit import StepLimit
from lumped.dynamics.system import State, System
from sheetbench.numerics.time.method import Advance, MotionMethod, StepFailed

__all__ = ["Advance", "Integrator", "LatticeSamples", "StepFailed"]

STEPS_PER_PERIOD = 200  # by default


class LatticeSamples(NamedTuple):
    """States at k times. time: (k,) [s]; u, v, a: (k, size, 3) displacements [m], velocities [m/s],
    accelerations [m/s²]; memory: of the material's branches; dissipated, work: (k,) [J] energies taken by
    dampers and put in."""

    time: np.ndarray
    u: np.ndarray
    v: np.ndarray
    a: np.ndarray
    memory: list[np.ndarray | None]
    dissipated: np.ndarray
    work: np.ndarray

    @classmethod
    def of(cls, state: State, dissipated: float = 0.0, work: float = 0.0) -> Self:
        """Return one state, with the energies until then."""
        u, v, a = (np.ascontiguousarray(vector)[None] for vector in (state.u, state.v, state.a))
        return cls(np.array([state.time]), u, v, a, [state.memory], np.array([dissipated]), np.array([work]))

    def state(self, i: int) -> State:
        """Return state i."""
        return State(float(self.time[i]), self.u[i], self.v[i], self.a[i], self.memory[i])


class Integrator(MotionMethod[State]):
    """An integrator, which advances a system from one state to the next.

    Parameters
    ----------
    system : System
        Equations of motion.
    step : float
        Length of steps, or first length of adaptive ones [s].
    fixed : bool, default True
        Whether an adaptive integrator keeps its step.

    Attributes
    ----------
    order : int
        Declared order of accuracy of the displacement.
    adaptive : bool
        Whether the integrator can choose its steps by their error.
    explicit : bool
        Whether its steps have a limit of stability.
    options : tuple of str
        Names of the user's options.
    kinks : ndarray
        Times [s] that steps end at. Constant steps pass over kinks with neighbours within a step on both
        sides, as in a densely measured history, but end at both ends of a jump.
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
        distance = np.maximum(gaps[:-1], gaps[1:])
        self.kinks = system.kinks if self.adapts else system.kinks[distance > step]

    @classmethod
    def default_step(cls, period: Callable[[], float], limit: StepLimit | None) -> float:
        """Return the default step [s], the first one of an adaptive integrator: from the limit of stability
        if any, else from the lowest period [s]; infinite if the integrator computes its first step."""
        return limit.advised if limit is not None else period() / STEPS_PER_PERIOD

    @classmethod
    def limit(cls, system: System, u: np.ndarray) -> StepLimit | None:
        """Return the limit of stability about a displacement (size, 3) [m], of an explicit integrator."""
        return None

    @abstractmethod
    def advance(self, state: State, at_most: float) -> Advance[State]:
        """Return one step of `at_most` [s], of an adaptive integrator perhaps shorter. Raises StepFailed, or
        SingularMatrixError."""

    def go(self, state: State, at_most: float) -> Advance[State]:
        """Return an adaptive step, or steps of one length as close as possible to the integrator's step."""
        if self.adapts:
            return self.advance(state, at_most)
        count = max(int(np.ceil(at_most / self.step - 1e-6)), 1)
        whole = abs(at_most / self.step - count) < 1e-6
        return self.march(state, self.step if whole else at_most / count, count)

    def march(self, state: State, step: float, most: int) -> Advance[State]:
        """Return steps of one length [s], at least one and `most` at most, in well under a second. Raises
        StepFailed if the first one fails."""
        return self.advance(state, step)

    def at(self, times: np.ndarray, last: Advance[State]) -> LatticeSamples:
        """Return samples at times within the last step; here its end."""
        return LatticeSamples.of(last.state, last.dissipated, last.work)

    def settings(self) -> dict[str, Any]:
        """Return the settings for an answer: the length of steps."""
        return {"step": "adaptive" if self.adapts else self.step}
