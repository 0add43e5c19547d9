"""An integrator as a runner sees it: states one after the other, and those within the last step.

A state is an immutable object with its `time` [s], whose other fields are arrays or None.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import Any, Generic, TypeVar

import numpy as np

from sheetbench.numerics.time.controller import Controller, Remembering, StepFailed

__all__ = ["Advance", "AnyState", "MotionMethod", "StepFailed"]

AnyState = TypeVar("AnyState", bound=Any)  # with its `time` [s]


@dataclass(frozen=True)
class Advance(Generic[AnyState]):
    """A step taken, or several of one length: the new state, the energies [J] that were dissipated and put in
    meanwhile, and how many steps."""

    state: AnyState
    dissipated: float
    work: float
    steps: int = 1


class MotionMethod(Remembering, ABC, Generic[AnyState]):
    """An integrator of a model's motion.

    state: the class of its states; adapts: whether it chooses its steps by their error, with `control`; span:
    samples after which a step has to end, one if it knows no states within steps, None if none has to; kinks:
    times [s] at which a step has to end, sorted.
    """

    state: Any
    adapts: bool
    span: int | None = 1
    kinks: np.ndarray
    control: Controller | None = None

    @abstractmethod
    def go(self, state: AnyState, at_most: float) -> Advance[AnyState]:
        """Return a step, or several of one length, no longer than `at_most` [s]. Raises StepFailed, or
        SingularMatrixError."""

    @abstractmethod
    def at(self, times: np.ndarray, last: Advance[AnyState]) -> Any:
        """Return the states at times (k,) [s] within the last step, as an observer takes them: `time`, and
        the energies (k,) [J] `dissipated` and put in, `work`, since that began."""

    def settings(self) -> dict[str, Any]:
        """Return what a history says of its steps beside what was requested."""
        return {}

    def notes(self) -> str:
        """Return a clause on steps that counted in spite of their error, "" for none."""
        return "" if self.control is None else self.control.notes()

    def memory(self) -> dict[str, Any]:
        """Return what a resumed run needs besides the state."""
        return super().memory() | ({} if self.control is None else self.control.memory())

    def recall(self, memory: dict[str, Any]) -> None:
        """Take up what `memory` gave."""
        super().recall(memory)
        if self.control is not None:
            self.control.recall(memory)

    def forget(self) -> None:
        """Drop what was kept only for speed, so that a resumed run goes on exactly as one never stopped."""
