"""Maxwell branches parallel to every spring in motion: a law with memory of its measure.

X = (S, δg) are a spring's elastic stress and the change of its measure (`lumped.springs.laws`). The branches
hold R = w X + c in a step (`scenes.objects.relaxation`), so that the spring has a stiffer law and a constant
stress, (1 + Σ a w) S + Σ a c_S. A stage of a Runge–Kutta method of diagonal γ integrates ẏ = R/τ, y = X − R,
at the method's order, with

    w = 1/(1 + h γ/τ),   c = −w (y₀ + h Σ_j a_ij R_j/τ).
"""

from collections.abc import Sequence
from copy import copy
from itertools import pairwise
from typing import Self

import numpy as np

from lumped.springs.families import DirectionalLinks, Family
from sheetbench.errors import BadInput
from sheetbench.scenes import Branches
from sheetbench.scenes.objects.relaxation import BranchStep


class Maxwell:
    """Maxwell branches of all springs in the step or stage `now`; before the first, springs of the
    instantaneous modulus. A state's memory holds the springs' measures one after the other. Immutable: `step`
    and `stage` return new objects."""

    def __init__(self, families: Sequence[Family], branches: Branches):
        if any(isinstance(family, DirectionalLinks) for family in families):
            raise BadInput(
                "material.relaxation: springs with different stiffnesses along x, y and z have no energy, "
                "and no Maxwell branches; give each link one number, or a damping_time"
            )
        self._families, self.branches = families, branches
        ends = np.cumsum([0, *(len(family) * family.measures for family in families)]).tolist()
        self._places = [slice(*both) for both in pairwise(ends)]
        self.times = np.array(branches.times)
        count = len(self.times)
        self.now = branches.stepped(np.ones(count), np.zeros((count, 2, ends[-1])))

    def _with_step(self, now: BranchStep) -> Self:
        other = copy(self)
        other.now = now
        return other

    @property
    def gain(self) -> float:
        """Factor 1 + Σ a w of the springs' law."""
        return self.now.gain

    def at_rest(self, u: np.ndarray) -> np.ndarray:
        """Return the memory of relaxed branches at displacement u (n, 3) [m]."""
        return self.branches.at_rest(self._measures(u))

    def step(self, memory: np.ndarray, ahead: float) -> Self:
        """Return the branches `ahead` [s] after a state with a given memory."""
        return self._with_step(self.branches.step(memory, ahead))

    def stage(self, start: np.ndarray, relaxed: np.ndarray, h_gamma: float) -> Self:
        """Return the branches of a stage. start: the step's memory; relaxed: h Σ_j a_ij R_j (b, 2, m);
        h_gamma: h γ [s]."""
        weight = 1.0 / (1.0 + h_gamma / self.times)
        gone = start[0] - start[1:] + relaxed / self.times[:, None, None]
        return self._with_step(self.branches.stepped(weight, -weight[:, None, None] * gone))

    def add_force(self, u: np.ndarray, force: np.ndarray, spring_factor: float | None = None) -> float:
        """Add the springs' force with their branches' to `force` (n, 3) [N]; return the springs' energy [J],
        branches excluded. spring_factor: factor of the springs' law, `gain` unless given."""
        factor = self.gain if spring_factor is None else spring_factor
        return self._add_forces(u, force, factor, self.now.past)[0]

    def after(self, u: np.ndarray) -> np.ndarray:
        """Return the memory at displacement u (n, 3) [m] in the current step or stage."""
        return self.now.after(self._measures(u))

    def add_branch_force(self, u: np.ndarray, memory: np.ndarray, force: np.ndarray) -> None:
        """Add the force of the branches alone with the stresses of a memory."""
        self._add_forces(u, force, 0.0, np.tensordot(np.array(self.branches.stiffness), memory[1:, 0], 1))

    def add_mean_force(
        self, before: np.ndarray, middle: np.ndarray, u: np.ndarray, force: np.ndarray
    ) -> None:
        """Add the branches' force of a step to u (n, 3) [m], by their mean stresses at its middle (n, 3) [m];
        before: the memory at the start."""
        self.add_branch_force(middle, 0.5 * (before + self.after(u)), force)

    def _measures(self, u: np.ndarray) -> np.ndarray:
        """Return X (2, m) of all springs."""
        return self._add_forces(u, np.zeros_like(u), 0.0, self.now.past)[1]

    def _add_forces(
        self, u: np.ndarray, force: np.ndarray, spring_factor: float, past: np.ndarray
    ) -> tuple[float, np.ndarray]:
        energy, x = 0.0, np.empty((2, len(past)))
        for family, place in zip(self._families, self._places, strict=True):
            shape = len(family), family.measures
            stress, change = (part[place].reshape(shape) for part in x)
            branches = spring_factor, past[place].reshape(shape), stress, change
            energy += family.loops.add_forces(u, family.arrays, force, branches)
        return energy, x

    def stresses(self, u: np.ndarray, spring_factor: float, past: float) -> list[np.ndarray]:
        """Return the stresses of every family for its tangent: own × the springs' stress at u plus past × the
        branches' constant stress in the step."""
        both = spring_factor * self._measures(u)[0] + past * self.now.past
        pairs = zip(self._families, self._places, strict=True)
        return [both[place].reshape(len(f), *(f.measures,) * (f.measures > 1)) for f, place in pairs]
