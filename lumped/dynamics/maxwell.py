"""Maxwell branches beside every spring in motion: a law that remembers its measure.

X = (S, δg) are a spring's elastic stress and the change of its measure (`lumped.springs.laws`). A branch of
stiffness a, over the long-time one, and time τ keeps R, resists with the stress a R_S and stores
½ a R_S·R_g:

    Ṙ + R/τ = Ẋ,    which in a step is    R = w X + c,

w a number and c known from before, so that the spring has its own law, stiffer, beside a constant stress:
(1 + Σ a w) S + Σ a c_S. With rules of second order (Simo and Hughes 1998, 10.3; exact where X is linear)

    w = (1 − β) τ/h,   c = β R₀ − w X₀,   β = exp(−h/τ);

in a stage of a Runge–Kutta method of diagonal γ, which takes ẏ = R/τ with y = X − R at its own order,

    w = 1/(1 + h γ/τ),   c = −w (y₀ + h Σ_j a_ij R_j/τ).
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

import numpy as np

from lumped.springs.families import Family
from sheetbench.errors import BadInput
from sheetbench.scenes import Branches


class Maxwell:
    """The branches of all springs. A state's memory is (1 + b, 2, m): X, then R of every branch, of the
    springs' measures one after the other. gain: 1 + Σ a w of the step or stage begun last; of the
    instantaneous modulus before any."""

    def __init__(self, families: Sequence[Family], branches: Branches):
        if not all(family.conservative for family in families):
            raise BadInput(
                "material.relaxation: springs with different stiffnesses along x, y and z have no energy, "
                "and no Maxwell branches; give each link one number, or a damping_time"
            )
        self._families = families
        ends = np.cumsum([0, *(len(family) * family.measures for family in families)]).tolist()
        self._places = [slice(*both) for both in pairwise(ends)]
        self._stiffness = np.array(branches.stiffness)
        self.times = np.array(branches.times)
        self._begin(np.ones(len(self.times)), np.zeros((len(self.times), 2, ends[-1])))

    def _begin(self, weight: np.ndarray, constant: np.ndarray) -> None:
        self._weight, self._constant = weight[:, None, None], constant
        self.gain = 1.0 + float(self._stiffness @ weight)
        self._past = np.tensordot(self._stiffness, constant[:, 0], 1)

    def at_rest(self, u: np.ndarray) -> np.ndarray:
        """The memory at displacement u (n, 3) [m] where the branches have relaxed."""
        _, x = self._pass(u, np.zeros_like(u), 0.0, self._past)
        return np.concatenate([x[None], np.zeros_like(self._constant)])

    def since(self, memory: np.ndarray, ahead: float) -> None:
        """Begin a step with a state's memory: what follows is `ahead` [s] later."""
        x = ahead / self.times
        weight = -np.expm1(-x) / x if ahead > 0.0 else np.ones_like(x)
        constant = np.exp(-x)[:, None, None] * memory[1:] - weight[:, None, None] * memory[0]
        self._begin(weight, constant)

    def stage(self, start: np.ndarray, relaxed: np.ndarray, own: float) -> None:
        """Begin a stage: start: the step's memory; relaxed: h Σ_j a_ij R_j (b, 2, m); own: h γ [s]."""
        weight = 1.0 / (1.0 + own / self.times)
        gone = start[0] - start[1:] + relaxed / self.times[:, None, None]
        self._begin(weight, -weight[:, None, None] * gone)

    def add_force(self, u: np.ndarray, force: np.ndarray, own: float | None = None) -> float:
        """Add the springs' force with their branches' to `force` (n, 3) [N]; return their own energy [J].
        own: how much of their own law counts, `gain` unless given."""
        return self._pass(u, force, self.gain if own is None else own, self._past)[0]

    def after(self, u: np.ndarray) -> np.ndarray:
        """The memory at displacement u (n, 3) [m] in the step or stage that was begun."""
        _, x = self._pass(u, np.zeros_like(u), 0.0, self._past)
        return np.concatenate([x[None], self._weight * x + self._constant])

    def add_branch_force(self, u: np.ndarray, memory: np.ndarray, force: np.ndarray) -> None:
        """Add the force of the branches alone with the stresses of a memory."""
        self._pass(u, force, 0.0, np.tensordot(self._stiffness, memory[1:, 0], 1))

    def add_mean_force(
        self, before: np.ndarray, middle: np.ndarray, u: np.ndarray, force: np.ndarray
    ) -> None:
        """Add the force in the middle (n, 3) [m] of a step to u, whose work is that of the mean stresses."""
        self.add_branch_force(middle, 0.5 * (before + self.after(u)), force)

    def _pass(
        self, u: np.ndarray, force: np.ndarray, own: float, past: np.ndarray
    ) -> tuple[float, np.ndarray]:
        energy, x = 0.0, np.empty((2, len(past)))
        for family, place in zip(self._families, self._places, strict=True):
            shape = len(family), family.measures
            stress, change = (part[place].reshape(shape) for part in x)
            constant = past[place].reshape(shape)
            energy += family.loops.add_remembering_forces(
                u, family.arrays, own, constant, stress, change, force
            )
        return energy, x

    def stresses(self, u: np.ndarray, own: float, past: float) -> list[np.ndarray]:
        """Return the stresses of every family that its tangent takes: so much of their own at u, and of
        what is constant in the step."""
        _, x = self._pass(u, np.zeros_like(u), 0.0, self._past)
        both = own * x[0] + past * self._past
        each = zip(self._families, self._places, strict=True)
        return [both[place].reshape(len(f), *(f.measures,) * (f.measures > 1)) for f, place in each]

    def stored(self, memory: np.ndarray) -> float:
        """Energy in the branches' springs [J]."""
        return 0.5 * float(self._stiffness @ (memory[1:, 0] * memory[1:, 1]).sum(axis=1))

    def dissipated(self, before: np.ndarray, after: np.ndarray) -> float:
        """Energy [J] that the branches take from one memory to the next: the work of their mean stresses less
        what they store more."""
        mean = 0.5 * np.tensordot(self._stiffness, before[1:, 0] + after[1:, 0], 1)
        work = float(mean @ (after[0, 1] - before[0, 1]))
        return work - self.stored(after) + self.stored(before)
