"""Interface of an integrator to a run: consecutive states, and states within the last step.

A state is an immutable object with its `time` [s], whose other fields are arrays or None.
"""

from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import Any, Generic, TypeVar

import numpy as np

from sheetbench.numerics.time.controller import Controller, Resumable, StepFailed

__all__ = ["Advance", "AnyState", "MotionMethod", "StepFailed"]

AnyState = TypeVar("AnyState", bound=Any)  # with its `time` [s]


@dataclass(frozen=True)
class Advance(Generic[AnyState]):
    """A step, or several of one length: the new state, dissipated energy and work [J], number of steps."""

    state: AnyState
    dissipated: float
    work: float
    steps: int = 1


class MotionMethod(Resumable, ABC, Generic[AnyState]):
    """An integrator of a model's motion.

    state: the class of its states. adapts: whether it chooses its steps by their error, with `control`. span:
    number of samples after which a step must end: one without states within steps, None without a limit.
    kinks: times [s] at which a step must end, sorted.
    """

    state: Any
    adapts: bool
    span: int | None = 1
    kinks: np.ndarray
    control: Controller | None = None

    @abstractmethod
    def go(self, state: AnyState, at_most: float) -> Advance[AnyState]:
        """Return a step, or several of one length, no longer than `at_most` [s]. Raises StepFailed or
        SingularMatrixError."""

    @abstractmethod
    def at(self, times: np.ndarray, last: Advance[AnyState]) -> Any:
        """Return samples at times (k,) [s] within the last step, for an observer. They have `time`, and the
        energies `dissipated` and `work` (k,) [J] since the start of the step."""

    def settings(self) -> dict[str, Any]:
        """Return the settings of the steps for a history, beyond the requested ones."""
        return {}

    def notes(self) -> str:
        """Return a clause on steps accepted with a larger error than allowed, "" without any."""
        return "" if self.control is None else self.control.notes()

    def memory(self) -> dict[str, Any]:
        """Return the attributes that a resumed run needs besides the state."""
        return super().memory() | ({} if self.control is None else self.control.memory())

    def restore(self, memory: dict[str, Any]) -> None:
        """Restore the attributes from `memory`."""
        super().restore(memory)
        if self.control is not None:
            self.control.restore(memory)

    def forget(self) -> None:
        """Drop data kept only for speed, so that a resumed run equals an uninterrupted one exactly."""
