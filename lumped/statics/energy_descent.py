"""Descent in energy to a stable equilibrium, if the load path ends or its equilibrium is unstable.

Minimises Π(q) = elastic energy − λ f·u by Newton steps with a backtracking line search (Armijo). The
true tangent serves if it is positive definite; otherwise the tangent with compressed links' and cells'
stresses set to zero (Teran et al. 2005). Links then add nothing negative, but an area spring's ∇²a is
indefinite in its plane, and some have negative stiffness (ν < 1/3): the sum is positive while strains are
small, and a direction that does not descend ends the search. Every accepted step lowers the energy, so the
end is a local minimum or the step limit. Newton's method finishes; its steps are rounding where their work is
nothing beside the energy that the descent has released. Only for dead loads and central springs: others have
no energy.
"""

import numpy as np
from scipy.sparse.linalg import ArpackNoConvergence, LinearOperator, eigsh

from lumped.actuators import Drive
from lumped.statics.problem import LatticePath, LatticeState, Problem
from sheetbench.answers.solution import Status
from sheetbench.numerics.continuation.newton import Start, newton
from sheetbench.numerics.continuation.path import LoadStepFailed
from sheetbench.numerics.direct import SOLVED, Factor, SingularMatrixError

STEPS = 600
DISTURBANCES = (0.1, 1.0, 4.0)  # layer distances; the first that leads away from a saddle is used
PROJECTED_RUN = 4  # steps with the projected tangent before the true one is tried again


def descend(path: LatticePath, load_factor: float) -> LatticeState:
    """Return the stable equilibrium at a load factor that descent reaches from a path's last one, disturbed
    if it is at this load factor and unstable. Raises LoadStepFailed without one."""
    problem, state, factor = path.structure, path.state, path.factor
    assert isinstance(problem, Problem)
    problem.assembly.require_energy()
    try:
        if load_factor != path.load_factor:
            u = problem.project_to_supports(state.u, load_factor)
            state, factor = _minimise(path, problem, u, load_factor), None
        factor = factor or path.factored(path.tangent(state, load_factor))
        if load_factor != path.load_factor and not factor.negative:
            return state
        for share in DISTURBANCES:  # a saddle is e.g. a flat sheet that has buckled
            u = _perturbed(problem, state, factor, share)
            minimum = _minimise(path, problem, problem.project_to_supports(u, load_factor), load_factor)
            if not problem.assembly.natural or not path.factored(path.tangent(minimum, load_factor)).negative:
                break
        return minimum
    except SingularMatrixError as error:
        raise LoadStepFailed(Status.SINGULAR, str(error), 0.0) from None


def _minimise(path: LatticePath, problem: Problem, u: np.ndarray, load_factor: float) -> LatticeState:
    wait, drive, first = 0, Drive(load_factor), problem.potential(u, load_factor)
    for _ in range(STEPS):
        residual = problem.residual(u, load_factor)
        factor, wait = _definite_factor(path, problem, u, load_factor, wait)
        relative = residual.norm / residual.size if residual.size > 0.0 else residual.norm
        before = problem.potential(u, load_factor)
        if relative < path.limits.refine_below and wait == 0:
            near = Start(LatticeState(u, load_factor, residual), load_factor, 1.0, abs(first - before))
            try:
                return newton(path, near)[0]
            except LoadStepFailed:
                pass
        gradient = -residual.reduced
        direction = factor.solve(-gradient, SOLVED)
        slope = float(gradient @ direction)
        if not slope < 0.0:  # also catches nan
            raise _failed("no direction of descent: the projected tangent is not positive definite")
        move = problem.expand(direction)
        share = min(1.0, 0.25 * problem.size / float(np.abs(move).max()))
        start, end = (u, drive), (u + share * move, drive)
        share *= min(
            (contact.near(end).free_share(contact.near(start)) for contact in problem.contacts), default=1.0
        )
        while share > 1e-10:
            if problem.potential(u + share * move, load_factor) <= before + 1e-4 * share * slope:
                break
            share /= 2.0
        else:
            raise _failed("the energy descends no further")
        u = u + share * move
        path.note(load_factor, relative, share * float(np.abs(move).max()) / problem.size)
    raise _failed(f"no equilibrium in {STEPS} descent steps")


def _failed(reason: str) -> LoadStepFailed:
    return LoadStepFailed(Status.STEP_LIMIT, reason, 0.0)


def _perturbed(problem: Problem, state: LatticeState, factor: Factor, share: float) -> np.ndarray:
    """Return the displacement of an unstable equilibrium moved along a direction of negative curvature.

    The move is the given share of the layer distance, with the sign of lower energy (if equal the first).
    """
    n, start = problem.system.unknowns, np.random.default_rng(0).standard_normal(problem.system.unknowns)
    inverse = LinearOperator((n, n), matvec=factor.solve, dtype=float)
    try:
        _, vectors = eigsh(factor.matrix, k=1, sigma=0.0, OPinv=inverse, which="SA", v0=start, tol=1e-4)
    except ArpackNoConvergence:
        raise _failed("no direction of negative curvature found") from None
    move = problem.expand(vectors[:, 0])
    move *= share * problem.assembly.lattice.spacing[2] / np.abs(move).max()
    return min((state.u + move, state.u - move), key=lambda u: problem.potential(u, state.load_factor))


def _definite_factor(
    path: LatticePath, problem: Problem, u: np.ndarray, load_factor: float, wait: int
) -> tuple[Factor, int]:
    """Return factors of a positive definite tangent, and the number of steps to stay with the projected
    one."""
    if wait == 0:
        try:
            factor = path.factored(problem.tangent(u, load_factor))
            if factor.negative == 0:
                return factor, 0
        except SingularMatrixError:
            pass
        wait = PROJECTED_RUN
    return path.factored(problem.tangent(u, load_factor, definite=True)), wait - 1
