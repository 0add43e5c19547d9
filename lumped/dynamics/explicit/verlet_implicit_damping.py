"""Velocity Verlet with implicit damping: Newmark's method with β = 0 and γ = ½, second order.

    u₁ = u₀ + h v₀ + ½ h² a₀,    (M + ½ h C(u₁)) v₁ = M (v₀ + ½ h a₀) + ½ h (f_ext − f_int)(u₁, t₁),
    a₁ = (v₁ − v₀)·2/h − a₀

with the dampers' matrix C. A motion of frequency ω and damping c is multiplied in a step by a matrix of

    det = (1 − z)/(1 + z),   trace = (2 − (ω h)²)/(1 + z),   z = ½ c h,

whose eigenvalues stay within the unit circle for ω h ≤ 2 whatever the damping: the springs' own limit, where
damping in proportion to stiffness would dictate far shorter steps (Hughes 2000, section 9.1). M + ½ h C is
factored at a shape that the sheet has been in; v₁ follows by corrections from the dampers as they are. Stiff
motions that are damped strongly alternate from step to step, as in the trapezoidal rule. No chains.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from lumped.dynamics.explicit.flat_system import FlatSystem, Steps
from lumped.dynamics.explicit.implicit_damping_steps import Factors, march
from lumped.dynamics.explicit.step_limit import StepLimit, step_limit
from lumped.dynamics.explicit.steps import ExplicitArrays
from lumped.dynamics.integrator import Advance, Integrator, StepFailed
from lumped.dynamics.system import State, System
from sheetbench.errors import BadInput
from sheetbench.numerics import banded

MOST = 2**30  # bytes of the factors


class VerletImplicitDamping(Integrator):
    """Velocity Verlet, dampers implicit."""

    name, order, explicit = "verlet-implicit-damping", 2, True

    def __init__(self, system: System, step: float):
        super().__init__(system, step)
        if system.coupling is not None and system.coupling.bodies:
            raise BadInput(f"integrator = '{self.name}': does not take chains; choose another integrator")
        self._flat = FlatSystem(system)
        self._band = system.problem.system.any_band
        needed = 8 * int(np.prod(banded.shape(self._band)))
        if needed > MOST:
            raise BadInput(
                f"integrator = '{self.name}': its factors would take {needed / 2**30:.1f} GB; choose another"
            )
        self._factors: Factors | None = None
        self._made_for = 0.0
        places = np.empty(0, np.uint64)
        one = np.ones((banded.padded_length(1), banded.row_length(0)))
        nothing = Factors(one, 1, 0, places, places, np.empty(0))
        self._flat.compile(self._steps_with(nothing))

    @classmethod
    def limit(cls, system: System, u: np.ndarray) -> StepLimit:
        """The springs' limit of stability."""
        frequency = step_limit(system, u).frequency
        return StepLimit(frequency, 0.0, 2.0 / frequency)

    def forget(self) -> None:
        """Drop the factors."""
        self._factors = None

    def advance(self, state: State, at_most: float) -> Advance:
        """One step. Raises StepFailed."""
        return self.march(state, at_most, 1)[0]

    def march(self, state: State, step: float, most: int) -> tuple[Advance, int]:
        """Steps in one compiled call, with the same factors. Raises StepFailed."""
        fresh = self._factors is None or self._made_for != step
        if self._factors is None or fresh:
            self._factors, self._made_for = self._factor(state, step), step
        try:
            advance, taken = self._flat.march(state, step, most, self._steps_with(self._factors))
        except StepFailed:
            self._factors = None
            if fresh:
                raise
            return self.march(state, step, most)
        if taken < min(most, self._flat.at_once):
            self._factors = None
        return advance, taken

    def _steps_with(self, factors: Factors) -> Steps:
        guess, last = np.zeros(self._flat.size), np.zeros(self._flat.size)
        solved = banded.padded_vector(factors.unknowns, factors.width)

        def steps(
            count: int, h: float, arrays: ExplicitArrays, *tables: Any
        ) -> tuple[bool, int, float, float]:
            taken: tuple[bool, int, float, float] = march(
                count, h, arrays, factors, *tables, guess, last, solved
            )
            return taken

        return steps

    def _factor(self, state: State, step: float) -> Factors:
        """Factors of M + ½ h C at a state."""
        system, unknowns = self.system, len(self._band.order)
        blocks = system.matrix(state.u, np.zeros_like(state.u), state.time, 1.0, 0.5 * step, 0.0)
        factors = banded.stored(blocks, self._band)
        if not banded.factor(factors, unknowns, self._band.width):  # not positive, not finite
            raise StepFailed("the dampers' matrix has no factors: use smaller steps")
        transform, number = system.transform.tocoo(), np.empty(unknowns, dtype=int)
        number[self._band.order] = np.arange(unknowns)
        return Factors(
            factors,
            unknowns,
            self._band.width,
            self._flat.places(transform.row // 3, transform.row % 3),
            number[transform.col].astype(np.uint64),
            transform.data.copy(),
        )
