"""Maxwell branches of a reference in motion: what its stresses remember (`scenes.objects.relaxation`)."""

from __future__ import annotations

import numpy as np

from sheetbench.scenes import Branches
from sheetbench.scenes.objects.relaxation import BranchStep

Strained = tuple[np.ndarray, np.ndarray]  # strains and their elastic stresses, of any shape


class Memory:
    """What is remembered at the start of a step, `since`; `now` [s]: the time in question, which whoever asks
    for forces sets. So a reference moves one motion at a time: none is for two threads."""

    def __init__(self, branches: Branches):
        self._branches, self.now, self._then = branches, 0.0, 0.0
        self._past: np.ndarray | None = None
        self._last: tuple[float, BranchStep] | None = None  # the step to a time

    def __bool__(self) -> bool:
        return len(self._branches.times) > 0

    def since(self, time: float, past: np.ndarray) -> None:
        """Begin a step at a time [s] with what `after` gave."""
        if self:
            self.now, self._then, self._past, self._last = time, time, past, None

    def after(self, strained: Strained) -> np.ndarray:
        """Return what is remembered `now` (1 + b, 2, m), to begin the next step with; all branches are at
        rest at first."""
        if not self:
            return np.zeros(0)
        x = np.stack([part.ravel() for part in strained[::-1]])
        return self._branches.at_rest(x) if self._past is None else self._step(self._past).after(x)

    @property
    def gain(self) -> float:
        """d(added stress)/d(elastic stress)."""
        return self._step(self._past).gain - 1.0 if self._past is not None else 0.0

    def added(self, stress: np.ndarray) -> np.ndarray:
        """Return the branches' stresses beside elastic ones, in their shape."""
        if self._past is None:
            return np.zeros_like(stress)
        return self.gain * stress + self._step(self._past).past.reshape(stress.shape)

    def stored(self, strained: Strained) -> float:
        """Return the energy [J] in the branches' springs."""
        return self._branches.stored(self.after(strained))

    def dissipated(self, strained: Strained) -> float:
        """Return the energy [J] that the branches have dissipated in the step."""
        if self._past is None:
            return 0.0
        return self._branches.dissipated(self._past, self.after(strained))

    def _step(self, past: np.ndarray) -> BranchStep:
        if self._last is None or self._last[0] != self.now:
            self._last = self.now, self._branches.step(past, self.now - self._then)
        return self._last[1]
