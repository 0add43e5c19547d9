"""Descent in energy to a stable equilibrium, where the load path ends or the equilibrium found is unstable.

Minimises Π(q) = elastic energy − λ f·u by Newton steps with a backtracking line search (Armijo). The
true tangent serves where it is positive definite; elsewhere the tangent with compressed links' and cells'
stresses set to zero (Teran et al. 2005). Links then add nothing negative, but an area spring's ∇²a is
indefinite in its plane, and some are of negative stiffness (ν < 1/3): the sum is positive while strains are
small, and a direction that is none of descent ends the search. Every accepted step lowers the energy, so the
end is a local minimum or the step limit. Only for dead loads and central springs: others have no energy.
"""

from __future__ import annotations

import numpy as np
from scipy.sparse.linalg import ArpackNoConvergence, LinearOperator, eigsh

from lumped.statics.equilibrium import State, StepFailed, refine
from lumped.statics.limits import REFINE_BELOW
from lumped.statics.problem import Problem
from sheetbench.numerics.reduced import Factor, SingularMatrixError

STEPS = 300
PROJECTED_RUN = 4  # steps with the projected tangent before the true one is tried again


def descend(problem: Problem, u: np.ndarray, load_factor: float) -> State:
    """The stable equilibrium that descent reaches from u (n, 3) [m], supports moved to their places.

    Raises StepFailed when there is none within the step limit.
    """
    problem.assembly.require_energy()
    u = problem.project_to_supports(u, load_factor)
    wait = 0
    for _ in range(STEPS):
        residual = problem.residual(u, load_factor)
        factor, wait = _definite_factor(problem, u, load_factor, wait)
        if residual.relative < REFINE_BELOW and wait == 0:
            try:
                return refine(problem, u, load_factor, residual=residual)
            except (StepFailed, SingularMatrixError):
                pass
        gradient = -residual.reduced
        direction = factor.solve(-gradient)
        slope = float(gradient @ direction)
        if not slope < 0.0:  # also catches nan
            raise StepFailed("no direction of descent: the projected tangent is not positive definite")
        move = problem.expand(direction)
        share = min(1.0, 0.25 * problem.size / float(np.abs(move).max()))
        start = problem.potential(u, load_factor)
        while share > 1e-10:
            if problem.potential(u + share * move, load_factor) <= start + 1e-4 * share * slope:
                break
            share /= 2.0
        else:
            raise StepFailed("the energy descends no further")
        u = u + share * move
        problem.note(load_factor, residual.relative, share * float(np.abs(move).max()))
    raise StepFailed(f"no equilibrium in {STEPS} descent steps")


def disturbed(problem: Problem, state: State) -> np.ndarray:
    """Displacement beside an unstable equilibrium, moved along a direction of negative curvature.

    The move is a tenth of the layer distance; of its two signs the one of lower energy (the first if even).
    """
    n = problem.system.unknowns
    inverse = LinearOperator((n, n), matvec=state.factor.solve, dtype=float)
    start = np.random.default_rng(0).standard_normal(n)
    try:
        _, vectors = eigsh(
            problem.system.matrix(state.blocks), k=1, sigma=0.0, OPinv=inverse, which="SA", v0=start, tol=1e-4
        )
    except ArpackNoConvergence as error:
        raise StepFailed("no direction of negative curvature found") from error
    move = problem.expand(vectors[:, 0])
    move *= 0.1 * problem.assembly.lattice.spacing[2] / np.abs(move).max()
    return min((state.u + move, state.u - move), key=lambda u: problem.potential(u, state.load_factor))


def _definite_factor(problem: Problem, u: np.ndarray, load_factor: float, wait: int) -> tuple[Factor, int]:
    """Factors of a positive definite tangent and for how many steps to stay with the projected one."""
    if wait == 0:
        try:
            factor = problem.linearise(u, load_factor).factor
            if factor.negative == 0:
                return factor, 0
        except SingularMatrixError:
            pass
        wait = PROJECTED_RUN
    return problem.factor(problem.nonnegative_tangent(u, load_factor)), wait - 1
