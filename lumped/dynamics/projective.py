"""Implicit Euler as a minimum, found with one kept matrix, after Liu et al. (2013) and (2017).

Implicit Euler minimises ½ |u − û|²_M/h² + E(u) with û = u₀ + h v₀. The local/global scheme of 2013 projects
every link onto its rest length along its present direction, then solves for u with a constant matrix,

    A Δu = −[M (u − û)/h² + f_int(u) + f_damp(u, (u − u₀)/h) − f_ext],   A = M/h² + Σ k (I, −I; −I, I),

and the scheme of 2017 remembers the last changes as L-BFGS does. Beside stiff links soft bending modes need a
hundred to three hundred such iterations a step on the settling scene, since that A resists turning as much as
stretching. Here A is M/h² + C/h + K⁺, the tangent without what compression takes from it, at a shape that the
sheet has been in: four to seven iterations, and the factors are made anew where they become more than ten.
The step is solved to the tolerance, but its error is implicit Euler's: first order in the step, and
dissipative. No chains: a kept matrix cannot follow how their constraints turn.
"""

from __future__ import annotations

import numpy as np

from lumped.dynamics.integrator import Advance, Integrator, StepFailed
from lumped.dynamics.system import State, System
from lumped.linear.solver import Factor, ReducedSystem
from sheetbench.scenes.errors import BadInput

ITERATIONS, TOLERANCE = 2000, 1e-3
REMEMBERED = 8
RENEWED = 10  # looks at the forces in a step after which the factors are made anew
ROUNDING = 1e-16  # correction relative to the sheet's side below which there is nothing to correct
OVERSHOT = 0.5  # of the slope a change begins with, that it may end with in the other direction


class Projective(Integrator):
    """Implicit Euler by a quasi-Newton iteration.

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
            self._factor, self._made_for = self._matrix(state, h), h
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
            if work < 0.0 and not small:
                raise StepFailed("the kept matrix is not positive definite: use smaller steps")
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
        if looks > RENEWED:
            self._factor = None
        v = (u - state.u) / h
        after = State(time, u, v, (u - inertial) / h**2)
        power, _ = system.damping_force(u, v)
        return Advance(after, h * power, system.work(state, after))

    def _matrix(self, state: State, h: float) -> Factor:
        """Factors of M/h² + C/h + K⁺ at a state."""
        system, u = self.system, state.u
        blocks = system.matrix(u, np.zeros_like(u), state.time, 1.0 / h**2, 1.0 / h, 0.0)
        for family in system.assembly.springs:
            springs = family.symmetric()
            springs.add_tangent(u, springs.nonnegative_part(u), blocks, 0.0)
        reduced = ReducedSystem(system.assembly.pattern, system.transform, symmetric=True)
        return reduced.factor(blocks)


def _two_loops(
    gradient: np.ndarray, history: list[tuple[np.ndarray, np.ndarray]], factor: Factor
) -> np.ndarray:
    """The L-BFGS product of the inverse Hessian and the gradient, from the factors of A."""
    q, weights = gradient, []
    for move, change in reversed(history):
        weight = float(move @ q) / float(move @ change)
        weights.append(weight)
        q = q - weight * change
    r = factor.solve(q)
    for (move, change), weight in zip(history, reversed(weights), strict=True):
        r = r + (weight - float(change @ r) / float(move @ change)) * move
    return r
