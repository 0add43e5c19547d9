"""Newton's iteration for implicit integrators, with factors kept from step to step.

`solve` solves any equation of a system. `solve_equation` solves the equation of a step or a stage,

    M c₂ (u − û) + f(u, v, t) = 0,   v = v̂ + c₁ (u − û),

except in the rows of multipliers, by compiled code where that exists.
"""

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from lumped.dynamics.implicit.compiled_newton import NewtonLimits, compiled_of, excess, iterate
from lumped.dynamics.implicit.compiled_stages import Stages, Step, solve_stages
from lumped.dynamics.system import State, System
from sheetbench.numerics import banded
from sheetbench.numerics.direct import SOLVED
from sheetbench.numerics.reduced_system import Factor
from sheetbench.numerics.time.method import StepFailed

CORRECTIONS = 20
STALE = 0.2  # ratio of successive corrections above which the factors are made anew
ROUNDED = 1e-11  # correction over the sheet's side below which what no longer shrinks is rounding
REUSE_FACTORS_WITHIN = 0.2  # relative change of c₂ within which factors serve
UNSOLVED = "the time step's equations did not converge: use smaller steps"


class StepEquation(NamedTuple):
    """The equation of a step or stage: time t [s], û and v̂ (size, 3), (c₂ [1/s²], c₁ [1/s]), of a system
    with its branches there."""

    system: System
    time: float
    base_u: np.ndarray
    base_v: np.ndarray
    by: tuple[float, float]

    def state(self, u: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return v and c₂ (u − û), zero for multipliers."""
        change = u - self.base_u
        if self.system.coupling is not None:
            change = np.where(self.system.placed, change, 0.0)
        return self.base_v + self.by[1] * change, self.by[0] * change

    def residual(self, u: np.ndarray) -> np.ndarray:
        """Return inertia and internal less external forces (size, 3) [N]."""
        v, a = self.state(u)
        return self.system.momentum(a) - self.system.unbalanced(u, v, self.time)

    def blocks(self, u: np.ndarray) -> np.ndarray:
        """Return the blocks of its derivative."""
        return self.system.matrix(u, self.state(u)[0], self.time, *self.by, 1.0)


class Newton:
    """The iteration; factors are made anew where corrections do not shrink fast enough."""

    def __init__(self, system: System, tolerance: float, stale: float = STALE):
        self._system, self.tolerance, self._stale = system, tolerance * system.problem.size, stale
        self._factor: Factor | None = None
        self._key: Any = None
        self._compiled, self._factors = compiled_of(system), np.empty((0, 0))
        self._factored: float | None = None  # c₂ of the compiled iteration's factors, where it has some
        self.made = 0  # corrections of the last step's stages

    def forget(self) -> None:
        """Drop the factors."""
        self._factor = self._factored = None

    def solve(
        self,
        key: Any,
        residual: Callable[[np.ndarray], np.ndarray],
        blocks: Callable[[np.ndarray], np.ndarray],
        guess: np.ndarray,
        tolerance: float | None = None,
        weigh: Callable[[np.ndarray], np.ndarray] = lambda correction: correction,
        stale: float | None = None,
    ) -> np.ndarray:
        """Return u with Tᵀ residual(u) = 0. key: factors of another key are not reused; weigh: map from the
        solution of the linear system to the correction (size, 3); stale: by default the iteration's. Raises
        StepFailed."""
        problem, stale = self._system.problem, self._stale if stale is None else stale
        small = self.tolerance if tolerance is None else tolerance
        u, last, fresh = guess, np.inf, False
        if key != self._key:
            self._factor, self._key = None, key
        for _ in range(CORRECTIONS):
            if self._factor is None:
                self._factor, fresh = problem.system.factor(blocks(u)), True
            correction = weigh(problem.expand(self._factor.solve(-problem.reduce(residual(u)), SOLVED)))
            u = u + correction
            length = float(np.abs(correction[self._system.placed]).max())
            if not np.isfinite(length):
                break
            if length < small or (fresh and 0.5 * last < length < ROUNDED * problem.size):
                return u
            if length > problem.size:
                break
            if length > stale * last and not fresh:
                self._factor = None
            last, fresh = length, False
        self._factor = None
        raise StepFailed(UNSOLVED)

    def solve_equation(
        self,
        equation: StepEquation,
        guess: np.ndarray,
        tolerance: float | None = None,
        stale: float | None = None,
    ) -> np.ndarray:
        """Return u of the equation. tolerance [m]: of the last correction; stale: ratio of successive
        corrections above which the factors are renewed; both by default the iteration's. Raises StepFailed,
        or SingularMatrixError."""
        limits = self._limits(tolerance, stale)
        solution = self._solve_compiled(equation, guess, limits)
        if solution is not None:
            return solution
        parts = equation.by, equation.residual, equation.blocks, guess
        return self.solve(*parts, limits.tolerance, stale=limits.stale)

    def excess(self, system: System, state: State, by: tuple[float, float]) -> float:
        """Return the excess energy [J] of a state in an equation with c₂ and c₁, mostly along stiff
        directions: half the work of its residual along its own correction; infinite without suitable factors.
        system: with its branches at that time."""
        u, v, a = state.u, state.v, state.a
        if (compiled := self._compiled) is not None and self.can_reuse_factors(by[0]):
            return excess(u, v, a, by, system.loads([state.time])[0], compiled.arrays, self._factors)
        left = system.problem.reduce(system.momentum(a) - system.unbalanced(u, v, state.time))
        factor = self._factor if self._key == by else None
        return 0.5 * float(left @ factor.solve(left, SOLVED)) if factor else np.inf

    def correction(self, residual: np.ndarray) -> np.ndarray | None:
        """Return the change (n, 3) [m] by the stored factors for a residual (m,), None without factors."""
        problem, band = self._system.problem, self._system.problem.system.band
        if self._factored is not None and band is not None:
            solution = banded.solve_unrefined(self._factors, band.width, band.order, residual)
        elif self._factor is not None:
            solution = self._factor.solve(residual, SOLVED)
        else:
            return None
        return problem.expand(solution)

    def solve_stages(self, step: Step, stages: Stages, tolerance: float | None) -> bool:
        """Solve a step's stages in compiled code, from the start in their tables; return False if that is not
        possible, for instance because the tangent is not positive definite. tolerance [m]: as in
        `solve_equation`. Raises StepFailed."""
        compiled, first, left = self._compiled, 1, 0
        limits, self.made = self._limits(tolerance), 0
        if compiled is None or not self.can_reuse_factors(step.mass_coefficient):
            return False
        while True:
            solved, first, left, made = solve_stages(
                first, left, step, stages, limits, compiled.arrays, self._factors
            )
            self.made += made
            if self._converged(solved, left):
                return True
            by = step.mass_coefficient, step.damping_coefficient
            base = compiled.base_u, compiled.base_v
            equation = StepEquation(self._system, float(stages.time[first]), *base, by)
            if not self._factorise(equation, stages.u[first]):
                return False

    def _limits(self, tolerance: float | None, stale: float | None = None) -> NewtonLimits:
        small = self.tolerance if tolerance is None else tolerance
        ratio = self._stale if stale is None else stale
        return NewtonLimits(small, self._system.problem.size, ratio, CORRECTIONS)

    def can_reuse_factors(self, mass_coefficient: float) -> bool:
        """Return whether the compiled iteration's factors can be reused for an equation with this c₂."""
        taken = self._factored
        return taken is not None and abs(mass_coefficient / taken - 1.0) < REUSE_FACTORS_WITHIN

    def renew(self, equation: StepEquation, u: np.ndarray) -> None:
        """Factorise the matrix of an equation at u, for this equation and similar ones. Raises
        SingularMatrixError."""
        if not self._factorise(equation, u):
            self._factor = self._system.problem.system.factor(equation.blocks(u))
            self._key = equation.by

    def _factorise(self, equation: StepEquation, u: np.ndarray) -> bool:
        """Factorise the compiled iteration's matrix at u; return False without a compiled iteration, or if
        the matrix is not positive definite."""
        self._factored = None
        if self._compiled is not None:
            band = self._compiled.band
            self._factors = banded.stored(equation.blocks(u), band)
            if banded.factor(self._factors, len(band.order), band.width):
                self._factored = equation.by[0]
        return self._factored is not None

    def _solve_compiled(
        self, equation: StepEquation, guess: np.ndarray, limits: NewtonLimits
    ) -> np.ndarray | None:
        """Return u of the equation, None if it is not compiled or its tangent is not positive definite.
        Raises StepFailed."""
        if (compiled := self._compiled) is None:
            return None
        u, remaining, base = guess.copy(), CORRECTIONS, (equation.base_u, equation.base_v)
        given = equation.by, self._system.loads([equation.time])[0], limits, compiled.arrays
        while self.can_reuse_factors(equation.by[0]) or self._factorise(equation, u):
            solved, remaining = iterate(remaining, u, *base, *given, self._factors)
            if self._converged(solved, remaining):
                return u
        return None

    def _converged(self, solved: bool, remaining: int) -> bool:
        """Return whether the compiled iteration has converged, and drop its factors otherwise. Raises
        StepFailed if no corrections are left."""
        if not solved:
            self._factored = None
            if remaining == 0:
                raise StepFailed(UNSOLVED)
        return solved
