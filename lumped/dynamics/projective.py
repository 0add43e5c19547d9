"""The local/global scheme of Liu et al. (2013): implicit Euler with a constant, prefactored matrix.

Implicit Euler minimises ½ |u − û|²_M/h² + E(u) with û = u₀ + h v₀. The local step projects every link onto
its rest length along its present direction; the global step solves

    (M/h² + L) Δu = −[M (u − û)/h² + f_int(u) + f_damp(u, (u − u₀)/h) − f_ext],   L = Σ k (I, −I; −I, I)

For links this is the same as projecting and solving for u; written with the residual, other springs take
part too: cells with |k| in L for each of their diagonals. Dampers of c count as c/h. Soft bending modes
beside stiff links need hundreds of such iterations: the last changes are remembered as in L-BFGS (Liu et al.
2017), which brings that down to about ten. Their number is fixed, which bounds the cost, not the error: first
order in the step, and dissipative. No chains: their constraints turn with them, which a constant matrix
cannot follow.
"""

from __future__ import annotations

import numpy as np

from lumped.dynamics.integrator import Advance, Integrator, StepFailed
from lumped.dynamics.system import State, System
from lumped.linear.solver import Factor, ReducedSystem
from sheetbench.scenes.errors import BadInput

ITERATIONS, TOLERANCE = 2000, 1e-3
REMEMBERED = 8
ROUNDING = 1e-16  # correction relative to the sheet's side below which there is nothing to correct
OVERSHOT = 0.5  # of the slope a change begins with, that it may end with in the other direction


class Projective(Integrator):
    """The local/global scheme.

    iterations: looks at the forces that a step may take; tolerance: of the corrections, relative to the
    largest by the work they do.
    """

    name, order, options = "projective", 1, ("iterations", "tolerance")

    def __init__(
        self, system: System, step: float, iterations: int = ITERATIONS, tolerance: float = TOLERANCE
    ):
        super().__init__(system, step)
        if system.constrained:
            raise BadInput("integrator = 'projective': does not take chains; choose another integrator")
        self._iterations, self._tolerance = iterations, tolerance
        self._factor: Factor | None = None
        self._made_for = 0.0

    def forget(self) -> None:
        """Drop the factors."""
        self._factor = None

    def advance(self, state: State, at_most: float) -> Advance:
        """One step. Raises StepFailed when a number overflows or iterations end short of the tolerance."""
        system, h, time = self.system, at_most, state.time + at_most
        if self._factor is None or self._made_for != h:
            self._factor, self._made_for = self._matrix(h), h
        held = system.place(time) - system.place(state.time) - h * system.place_rate(state.time)
        inertial = state.u + h * state.v + held

        def gradient_at(u: np.ndarray) -> np.ndarray:
            pull: np.ndarray = (system.mass @ (u - inertial).ravel()).reshape(-1, 3) / h**2
            return system.problem.reduce(pull - system.unbalanced(u, (u - state.u) / h, time))

        u, gradient = inertial, gradient_at(inertial)
        history: list[tuple[np.ndarray, np.ndarray]] = []  # latest changes of unknowns and of the gradient
        looks, first = 1, 0.0
        while True:
            move = -_two_loops(gradient, history, self._factor)
            work = -float(move @ gradient)
            first = max(first, work)
            small = np.abs(system.problem.expand(move)).max() <= ROUNDING * system.problem.size
            if work <= self._tolerance**2 * first or small:
                break
            if looks >= self._iterations:
                raise StepFailed(f"{looks} iterations did not solve a time step: use smaller steps")
            share = 1.0
            while True:
                there = u + system.problem.expand(share * move)
                met, looks = gradient_at(there), looks + 1
                slope = float(move @ met)
                if not np.isfinite(slope):
                    raise StepFailed("a number overflowed")
                if slope <= OVERSHOT * work or looks >= self._iterations:
                    break
                share *= work / (work + slope)
            taken, change = share * move, met - gradient
            if change @ taken > 0.0:
                history = [*history[1 - REMEMBERED :], (taken, change)]
            u, gradient = there, met
        v = (u - state.u) / h
        after = State(time, u, v, (u - inertial) / h**2)
        power, _ = system.damping_force(u, v)
        return Advance(after, h * power, system.work(state, after))

    def _matrix(self, h: float) -> Factor:
        """Factors of M/h² + L."""
        system, assembly = self.system, self.system.assembly
        blocks = system.mass_blocks / h**2
        for family in assembly.springs:
            family.add_bound(blocks)
        system.damping.add_bound(h, blocks)
        reduced = ReducedSystem(assembly.pattern, system.transform, symmetric=True)
        return reduced.factor(blocks)


def _two_loops(
    gradient: np.ndarray, history: list[tuple[np.ndarray, np.ndarray]], factor: Factor
) -> np.ndarray:
    """The L-BFGS product of the inverse Hessian and the gradient, from the factors of M/h² + L."""
    q, weights = gradient, []
    for move, change in reversed(history):
        weight = float(move @ q) / float(move @ change)
        weights.append(weight)
        q = q - weight * change
    r = factor.solve(q)
    for (move, change), weight in zip(history, reversed(weights), strict=True):
        r = r + (weight - float(change @ r) / float(move @ change)) * move
    return r
