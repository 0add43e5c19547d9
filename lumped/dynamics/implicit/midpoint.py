"""Energy–momentum-conserving midpoint rule: implicit, second order, without numerical dissipation.

    M (v₁ − v₀)/h + f̄(u₀, u₁) + f_damp(ū, Δu/h) + J(ū)ᵀ λ = f_ext(ū, t̄),   Δu = ½ h (v₀ + v₁),   Φ(u₁) = 0

with the discrete gradient f̄ of the elastic energy (`add_average_forces` of the springs and of
`lumped.actuators.joints`): f̄·Δu = ΔE exactly, J(ū) Δu = ΔΦ = 0 since Φ is quadratic, constant dead loads do
exactly their potential's work, all others f_ext(ū, t̄)·Δu, and dampers take h P(ū, Δu/h) ≥ 0. Energy is held
to the tolerance of the iteration; linear and angular momentum of a free sheet too. Source: Simo and Tarnow
(1992), Gonzalez (1996, 1999).
"""

import numpy as np

from lumped.dynamics.implicit.newton import Newton
from lumped.dynamics.integrator import Integrator
from lumped.dynamics.system import State, System
from lumped.dynamics.work import imposed_work, obstacle_work
from sheetbench.numerics.time.method import Advance

STEP_TOLERANCE = 1e-13  # last correction relative to the sheet's side


class Midpoint(Integrator):
    """The conserving midpoint rule."""

    name, order = "midpoint", 2

    def __init__(self, system: System, step: float):
        super().__init__(system, step)
        self._newton = Newton(system, STEP_TOLERANCE)

    def forget(self) -> None:
        """Drop the factors."""
        self._newton.forget()

    def advance(self, state: State, at_most: float) -> Advance[State]:
        """Return the state after one step. Raises StepFailed."""
        system, h = self.system.for_step(state, at_most), at_most
        time, middle = state.time + h, state.time + 0.5 * h
        coupling = system.coupling
        algebraic = coupling.algebraic if coupling is not None else np.zeros((1, 1), dtype=bool)

        motion = system.prescribed
        moved = motion.place(time) - motion.place(state.time)
        jump = moved / h - motion.rate(state.time)

        def mean(u: np.ndarray) -> np.ndarray:
            return np.where(algebraic, u, 0.5 * (state.u + u))

        def velocity(u: np.ndarray) -> np.ndarray:
            return np.where(algebraic, 0.0, (u - state.u) / h)

        def residual(u: np.ndarray) -> np.ndarray:
            rate = velocity(u)
            gained = rate - state.v - jump  # the work of prescribed motion is separate
            inertia = system.momentum((2.0 / h) * gained)
            force = inertia + system.average_elastic(state, u, middle)
            return force + system.damping_force(mean(u), rate, middle)[1] - system.external(mean(u), middle)

        def halved(u: np.ndarray) -> np.ndarray:
            force = residual(u)
            return np.where(algebraic, 0.5 * force, force)  # as the constraints stand in the halved tangent

        def blocks(u: np.ndarray) -> np.ndarray:
            ends = state, u
            return system.matrix(mean(u), velocity(u), middle, 2.0 / h**2, 1.0 / h, 0.5, ends)

        def weigh(correction: np.ndarray) -> np.ndarray:
            return np.where(algebraic, 0.5 * correction, correction)

        free = state.v - motion.rate(state.time) + 0.5 * h * state.a
        guess = state.u + moved + h * system.accelerate(system.momentum(free))
        u = self._newton.solve(h, halved, blocks, guess, weigh=weigh)
        rate = velocity(u)
        v = 2.0 * rate - state.v
        if motion.moving:
            v = v + motion.rate(time) - motion.rate(state.time) - 2.0 * jump
        power, _ = system.damping_force(mean(u), rate, middle)
        after, relaxed = system.relaxed(state, State(time, u, v, (v - state.v) / h))
        work = imposed_work(system, state, after)
        if motion.moving:
            work += float(np.sum(residual(u) * moved))
        if system.nonconservative:
            working = system.external(mean(u), middle) - system.problem.loads.dead
            work += float(np.sum(working * (u - state.u)))
        if system.pushed:
            work += obstacle_work(system, state, u, middle)
        return Advance(after, h * power + relaxed, work)
