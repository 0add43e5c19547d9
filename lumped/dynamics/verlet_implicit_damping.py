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
import scipy.linalg

from lumped.dynamics.explicit_steps import Motion
from lumped.dynamics.flat_system import FlatSystem, Steps
from lumped.dynamics.implicit_damping_steps import Band, march
from lumped.dynamics.integrator import Advance, Integrator, StepFailed
from lumped.dynamics.step_limit import StepLimit, step_limit
from lumped.dynamics.system import State, System
from sheetbench.scenes.errors import BadInput

MOST = 2**30  # bytes of the factors


class VerletImplicitDamping(Integrator):
    """Velocity Verlet, dampers implicit."""

    name, order, explicit = "verlet-implicit-damping", 2, True

    def __init__(self, system: System, step: float):
        super().__init__(system, step)
        if system.coupling is not None and system.coupling.bodies:
            raise BadInput(f"integrator = '{self.name}': does not take chains; choose another integrator")
        self._flat = FlatSystem(system)
        self._order, self._width = _order(system)
        needed = 8 * len(self._order) * self._width
        if needed > MOST:
            raise BadInput(
                f"integrator = '{self.name}': its factors would take {needed / 2**30:.1f} GB; choose another"
            )
        self._band: Band | None = None
        self._made_for = 0.0
        places = np.empty(0, np.uint64)
        self._flat.compile(self._steps_with(Band(np.ones((1, 1)), np.ones(1), places, places, np.empty(0))))

    @classmethod
    def limit(cls, system: System, u: np.ndarray) -> StepLimit:
        """The springs' limit of stability."""
        frequency = step_limit(system, u).frequency
        return StepLimit(frequency, 0.0, 2.0 / frequency)

    def forget(self) -> None:
        """Drop the factors."""
        self._band = None

    def advance(self, state: State, at_most: float) -> Advance:
        """One step. Raises StepFailed."""
        return self.march(state, at_most, 1)[0]

    def march(self, state: State, step: float, most: int) -> tuple[Advance, int]:
        """Steps in one compiled call, with the same factors. Raises StepFailed."""
        fresh = self._band is None or self._made_for != step
        if self._band is None or fresh:
            self._band, self._made_for = self._factor(state, step), step
        try:
            advance, taken = self._flat.march(state, step, most, self._steps_with(self._band))
        except StepFailed:
            self._band = None
            if fresh:
                raise
            return self.march(state, step, most)
        if taken < min(most, self._flat.at_once):
            self._band = None
        return advance, taken

    def _steps_with(self, band: Band) -> Steps:
        guess, last, solved = (np.zeros(n) for n in (self._flat.size, self._flat.size, sum(band.rows.shape)))

        def steps(count: int, h: float, motion: Motion, *arrays: Any) -> tuple[bool, int, float, float]:
            taken: tuple[bool, int, float, float] = march(
                count, h, motion, band, *arrays, guess, last, solved
            )
            return taken

        return steps

    def _factor(self, state: State, step: float) -> Band:
        """Factors of M + ½ h C at a state."""
        system = self.system
        blocks = system.matrix(state.u, np.zeros_like(state.u), state.time, 1.0, 0.5 * step, 0.0)
        entries = system.problem.system.matrix(blocks)[self._order][:, self._order].tocoo()
        lower, width, unknowns = entries.row >= entries.col, self._width, len(self._order)
        band = np.zeros((width + 1, unknowns))
        band[(entries.row - entries.col)[lower], entries.col[lower]] = entries.data[lower]
        try:
            factors = scipy.linalg.cholesky_banded(band, lower=True, overwrite_ab=True)
        except (np.linalg.LinAlgError, ValueError):  # not positive, not finite
            raise StepFailed("the dampers' matrix has no factors: use smaller steps") from None
        rows = np.zeros((unknowns, width))
        for below in range(1, width + 1):
            rows[below:, width - below] = factors[below, : unknowns - below]
        transform, number = system.transform.tocoo(), np.empty(unknowns, dtype=int)
        number[self._order] = np.arange(unknowns)
        return Band(
            rows,
            1.0 / factors[0],
            self._flat.places(transform.row // 3, transform.row % 3),
            number[transform.col].astype(np.uint64),
            transform.data.copy(),
        )


def _order(system: System) -> tuple[np.ndarray, int]:
    """Unknowns along the lattice's longer side, where a matrix of neighbours has the narrowest band, and how
    wide it is beside the diagonal."""
    nx, ny, layers = system.assembly.lattice.grid
    entries = system.transform.tocoo()
    first = np.full(entries.shape[1], entries.shape[0])
    np.minimum.at(first, entries.col, entries.row)
    mass, axis = np.divmod(first, 3)
    column, layer = np.divmod(mass, layers)
    j, i = np.divmod(column, nx)
    along, across = (i, j) if nx > ny else (j, i)
    order = np.lexsort((axis, layer, across, along))
    number = np.empty(len(order), dtype=int)
    number[order] = np.arange(len(order))
    pattern = system.problem.system.matrix(np.ones_like(system.mass_blocks)).tocoo()
    return order, int(np.abs(number[pattern.row] - number[pattern.col]).max())
