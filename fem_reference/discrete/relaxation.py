"""Maxwell branches of a reference in motion: what its stresses remember.

With the elastic stress s(e) of the long-time modulus, a branch of stiffness a and time τ adds q to it:

    q̇ + q/τ = a ṡ,    ṗ + p/τ = ė,    q₁ = β q₀ + a g (s₁ − s₀),    p₁ = β p₀ + g (e₁ − e₀)
    β = exp(−h/τ),    g = (1 − β) τ/h

p is the strain of the branch's spring, which stores ½ q p. The update is exact where s and e change linearly
in a step, and of second order elsewhere. Source: Simo and Hughes, Computational Inelasticity (1998), 10.3.
"""

from __future__ import annotations

import numpy as np

from sheetbench.scenes import Branches

Strained = tuple[np.ndarray, np.ndarray]  # strains and their elastic stresses, of any shape


class Memory:
    """What is remembered at the start of a step, `since`; `now` [s]: the time in question."""

    def __init__(self, branches: Branches):
        self._stiffness, self._times = (np.array(part)[:, None] for part in branches)
        self.now = self._then = 0.0
        self._past: np.ndarray | None = None  # rows: e₀, s₀, then q, then p of every branch

    def __bool__(self) -> bool:
        return len(self._times) > 0

    def since(self, time: float, past: np.ndarray) -> None:
        """Begin a step at a time [s] with what `after` gave."""
        if self:
            self.now = self._then = time
            self._past = past

    def after(self, strained: Strained) -> np.ndarray:
        """What is remembered `now` (2 + 2 b, m), to begin the next step with; all branches are at rest at
        first."""
        if not self:
            return np.zeros(0)
        both = np.stack([part.ravel() for part in strained])
        if self._past is None:
            return np.concatenate([both, np.zeros((2 * len(self._times), both.shape[1]))])
        return np.concatenate([both, self._stresses(both[1]), self._strains(both[0])])

    @property
    def gain(self) -> float:
        """d(added stress)/d(elastic stress)."""
        return float((self._stiffness * self._decay()[1]).sum()) if self._past is not None else 0.0

    def added(self, stress: np.ndarray) -> np.ndarray:
        """The branches' stresses beside elastic ones, in their shape."""
        if self._past is None:
            return np.zeros_like(stress)
        return np.asarray(self._stresses(stress.ravel()).sum(axis=0).reshape(stress.shape))

    def stored(self, strained: Strained) -> float:
        """Energy [J] in the branches' springs."""
        if self._past is None:
            return 0.0
        return 0.5 * float((self._stresses(strained[1].ravel()) * self._strains(strained[0].ravel())).sum())

    def dissipated(self, strained: Strained) -> float:
        """Energy [J] that the branches have dissipated in the step: their work less what is stored more."""
        if self._past is None:
            return 0.0
        count, change = len(self._times), strained[0].ravel() - self._past[0]
        before, springs = self._past[2 : 2 + count], self._past[2 + count :]
        mean = 0.5 * (before + self._stresses(strained[1].ravel()))
        return float((mean @ change).sum()) - self.stored(strained) + 0.5 * float((before * springs).sum())

    def _decay(self) -> tuple[np.ndarray, np.ndarray]:
        """β and g (b, 1)."""
        x = (self.now - self._then) / self._times
        return np.exp(-x), np.where(x > 0.0, -np.expm1(-x) / np.where(x > 0.0, x, 1.0), 1.0)

    def _stresses(self, stress: np.ndarray) -> np.ndarray:
        assert self._past is not None
        beta, g = self._decay()
        return beta * self._past[2 : 2 + len(beta)] + self._stiffness * g * (stress - self._past[1])

    def _strains(self, strain: np.ndarray) -> np.ndarray:
        assert self._past is not None
        beta, g = self._decay()
        return beta * self._past[2 + len(beta) :] + g * (strain - self._past[0])
