"""Explicit velocity Verlet (central differences), second order also with dampers.

    u₁ = u₀ + h v₀ + ½ h² a₀,    v₁ = v₀ + ½ h (a₀ + M⁻¹ f(u₁, v₀ + h a₀, t₁)),    a₁ = M⁻¹ f(u₁, v₁, t₁)

The elastic forces are computed once a step; the damping forces twice, with the predicted and with the final
velocity, since the forces of half a step before would make the scheme of first order. It is stable for
ω h ≤ 2 undamped, with damping see `lumped.dynamics.explicit.step_limit`. It does not take chains, whose
constraints need the solution of equations in each step.

The energy taken by dampers is the mean of their power at both ends of a step times h; with obstacles, whose
dashpots act for about ten steps, R̄·(u₁ − u₀ − h² (a₁ − a₀)/6), R̄ the mean of R₀ and the predicted R₁. For
other forces F the kinetic energy gains (F̄ − R̄)·h v̄, h v̄ = u₁ − u₀ + h² (a₁ − a₀)/4, and the potential
loses F̄·(u₁ − u₀) − h³ F''v³/12. Their difference, without the terms that return at the end of a contact, is
(h²/6m) R̄ ΔF − R̄·(u₁ − u₀). The mean power would leave the balance of a flat landing permanently off by up
to 0.9 % of its fall, not 0.01 %.
"""

import numpy as np

from lumped.dynamics.explicit.flat_system import FlatSystem
from lumped.dynamics.explicit.step_limit import StepLimit, step_limit
from lumped.dynamics.integrator import Integrator
from lumped.dynamics.system import State, System
from lumped.dynamics.work import work
from sheetbench.errors import BadInput
from sheetbench.numerics.time.method import Advance, StepFailed


def _require_no_chains(system: System) -> None:
    if system.constrained:
        raise BadInput("integrator = 'verlet': does not take chains; choose another integrator")


class Verlet(Integrator):
    """Velocity Verlet."""

    name, order, explicit = "verlet", 2, True

    def __init__(self, system: System, step: float):
        super().__init__(system, step)
        _require_no_chains(system)
        one_by_one = not system.packed or system.items or system.damping.drag.coefficient > 0.0
        self._at_places = None if one_by_one or system.shared_mass else FlatSystem(system)
        if self._at_places is not None:
            self._at_places.compile()

    @classmethod
    def limit(cls, system: System, u: np.ndarray) -> StepLimit:
        """Return the limit of stability by springs and dampers."""
        _require_no_chains(system)
        return step_limit(system, u)

    def march(self, state: State, step: float, most: int) -> Advance[State]:
        """Return steps in one compiled call; a single step with branches, a natural state, springs without an
        energy, items, air or bodies with moments of inertia. Raises StepFailed."""
        if self._at_places is None:
            return super().march(state, step, most)
        return self._at_places.march(state, step, most)

    def advance(self, state: State, at_most: float) -> Advance[State]:
        """Return one explicit step. Raises StepFailed when a number overflows."""
        system, h, time = self.system.for_step(state, at_most), at_most, state.time + at_most
        motion = system.prescribed
        u = state.u + h * state.v + 0.5 * h * h * state.a
        half = state.v + 0.5 * h * state.a
        if motion.moving:
            u = u + motion.place(time) - motion.place(state.time) - h * motion.rate(state.time)
            half = half + motion.rate(time) - motion.rate(state.time)
        force = system.external(u, time) - system.internal(u, u, time, damped=False)[2]
        predicted = system.damping_force(u, state.v + h * state.a, time)[1] if system.resists else 0.0
        acceleration = system.accelerate(force - predicted)
        if not np.isfinite(acceleration).all():
            raise StepFailed("a number overflowed")
        v, taken = half + 0.5 * h * acceleration, 0.0
        if system.resists:
            power, resisting = system.damping_force(u, v, time)
            before, resisted = system.damping_force(state.u, state.v, state.time)
            taken = 0.5 * h * (before + power)
            acceleration = system.accelerate(force - resisting)
            if system.items:
                way = u - state.u - h * h / 6.0 * (acceleration - state.a)
                of_ends = h * ((resisted * state.v).sum() + (resisting * v).sum())
                taken += 0.5 * float(((resisted + predicted) * way).sum() - of_ends)
        after, relaxed = system.relaxed(state, State(time, u, v, acceleration))
        return Advance(after, taken + relaxed, work(system, state, after))
