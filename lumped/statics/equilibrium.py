"""Static equilibrium of a lattice: internal force = λ × external force, from the flat sheet to λ = 1.

Each correction solves K(u, N*) δ = λ f(u) − f_int(u), where the geometric part of the tangent takes the
tensions N* that the previous linearisation extrapolated instead of those at u: the mixed-integration-point
Newton of Magisano, Leonetti and Garcea (2017), whose steps are not held back by the spurious stretching of
a large rotation. The last corrections use the true tangent: they refine the answer to rounding, and their
inertia decides stability.

Load steps adapt: a step's predictor, linear in the load, may displace no mass farther than a share of the
sheet's longer side; a step that fails is halved with the factors at hand. Where the path ends before
λ = 1 and the forces have an energy, a regularised Newton descent (`lumped.statics.energy_descent`) looks for
a stable state there.

Watchdogs end a path: a number that is not finite, corrections that grow or do not settle (a load step's
own), collapsed links and inverted cells at an equilibrium (`lumped.statics.faults`), too many
factorisations.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lumped.statics import limits
from lumped.statics.faults import broken
from lumped.statics.problem import SOLVED, Advance, Problem, Residual, Tangent
from sheetbench.numerics.reduced import Factor, SingularMatrixError


@dataclass
class State:
    """An equilibrium: displacement, load factor, blocks and factors of the true tangent there.

    negative: real eigenvalues of the tangent below zero, None when not known; residual: at u, where it was
    looked at.
    """

    u: np.ndarray
    load_factor: float
    blocks: np.ndarray
    factor: Factor
    negative: int | None
    residual: Residual | None = None


class StepFailed(ArithmeticError):
    """A load step found no equilibrium; the text says why."""


def at_rest(problem: Problem) -> State:
    """The flat, stress-free state. Raises SingularMatrixError when its tangent has no factors."""
    u = np.zeros_like(problem.loads.dead)
    blocks, factor = problem.linearise(u, 0.0)
    return State(u, 0.0, blocks, factor, problem.negative(factor))


def follow(
    problem: Problem,
    start: State,
    target: float = 1.0,
    *,
    reach: float | None = None,
    step: float | None = None,
    careful: bool = False,
    limit: int = limits.FACTORISATIONS,
) -> tuple[State, str]:
    """The equilibrium at load factor `target` along the path from `start`, or the last one before it, with
    the reason why the path ended ("" when it did not). reach: how far [m] the first load step may go, and by
    what load, unless it starts anew. careful: no load step may leave the branch that it begins on. limit: of
    factorisations in all."""
    state = start
    reach = reach or (limits.CAREFUL_REACH if careful else limits.FIRST_REACH) * problem.size
    step = step or target - start.load_factor
    shortest = abs(step) * limits.SHORTEST_STEP
    while abs(target - state.load_factor) > 1e-12:
        if careful and state.negative is None:
            return state, HELD_TO_NOTHING
        step = np.sign(target - state.load_factor) * min(abs(step), abs(target - state.load_factor))
        predicted = predictor(problem, state, step)
        farthest = float(np.abs(predicted).max())
        if farthest > reach:
            step *= reach / farthest
            predicted = predictor(problem, state, step)
            farthest = float(np.abs(predicted).max())
        try:
            before = problem.factorisations
            last = abs(target - state.load_factor - step) < 1e-12
            tolerance = limits.RESIDUAL_TOLERANCE if last else limits.REFINE_BELOW
            found = _correct(problem, state, state.load_factor + step, predicted, tolerance)
            longest = _require_continuous(problem, state, found, predicted) if careful else np.inf
            state = found
        except (StepFailed, SingularMatrixError) as failure:
            step /= 2.0
            reach = min(reach, farthest) / 2.0
            ends = abs(step) < shortest and reach < limits.SHORTEST_REACH * problem.size
            if ends or problem.factorisations > limit:
                return state, str(failure)
            continue
        problem.fault = broken(problem.assembly, state.u[None])[1]
        if problem.fault is not None:
            return state, problem.fault.message
        if problem.factorisations > limit:
            return state, f"{limit} factorisations were not enough"
        if careful:
            reach = longest
        elif problem.factorisations - before <= limits.LENGTHEN_UP_TO:
            reach *= 1.5
        step *= 4.0
    return state, ""


def _require_continuous(problem: Problem, start: State, end: State, predicted: np.ndarray) -> float:
    """How far [m] the next careful step may go. Raise StepFailed where an equilibrium is on another branch
    than the one that a step (n, 3) [m] set out from: far from where the step led, or past a change of
    stability by more than a short step."""
    length, side = float(np.abs(predicted).max()), problem.size
    miss = float(np.abs(end.u - start.u - predicted).max())
    if miss > max(min(limits.CONTINUOUS * length, limits.MISS * side), limits.IDLE_CORRECTION * side):
        raise StepFailed("the path folds")
    if end.negative is None or start.negative is None:
        raise StepFailed(HELD_TO_NOTHING)
    if end.negative > start.negative and length > limits.BRANCHING * side:
        raise StepFailed("the path loses stability")
    if miss == 0.0:
        return limits.GROWTH * length
    square = length**2 / miss  # a miss grows with the square of the step
    reached = limits.SAFE * limits.CONTINUOUS * square, (limits.SAFE * limits.MISS * side * square) ** 0.5
    return float(min(limits.GROWTH * length, *reached))


HELD_TO_NOTHING = "the path cannot be held to its branch: the tangent's factors do not tell the inertia"


def predictor(problem: Problem, state: State, step: float) -> np.ndarray:
    """Displacement (n, 3) of a load step, linear at the state."""
    moved = problem.prescribed(state.load_factor + step) - problem.prescribed(state.load_factor)
    unbalanced = step * problem.growing(state.u)
    if moved.any():
        unbalanced = unbalanced - problem.system.apply(state.blocks, moved)
    return problem.expand(state.factor.solve(problem.reduce(unbalanced), SOLVED)) + moved


def _correct(
    problem: Problem, start: State, load_factor: float, predicted: np.ndarray, tolerance: float
) -> State:
    """Equilibrium at a load factor from a predicted step. Raises StepFailed, SingularMatrixError."""
    began = problem.advance(start.u, predicted, load_factor, True)
    return newton_at_load(problem, began, load_factor, tolerance)


def newton_at_load(
    problem: Problem, began: Advance, load_factor: float, tolerance: float = limits.RESIDUAL_TOLERANCE
) -> State:
    """Equilibrium at a load factor from where a step has led, with the stresses predicted there. Raises
    StepFailed, SingularMatrixError."""
    u, length, residual, stresses = began
    lengths = [length]
    near: Factor | None = None
    made: Tangent | None = None
    for _ in range(limits.CORRECTIONS):
        problem.note(load_factor, residual.relative, lengths[-1])
        if not np.isfinite(residual.relative):
            raise StepFailed("a number overflowed")
        if residual.relative < limits.REFINE_BELOW or all_rounding(problem, u, residual, lengths[-1]):
            near = None  # its memory is needed
            close = made if lengths[-1] <= limits.REUSE_FACTORS_WITHIN * problem.size else None
            return refine(problem, u, load_factor, tolerance, close, residual)
        done = None if near is None else problem.solve_near(u, load_factor, residual, stresses, near)
        if done is None:
            near = made = None  # whose memory the new factors may need
            made = problem.linearise(u, load_factor, stresses)
            done = problem.correct(made.factor, u, load_factor, residual, True)
            if problem.iterates:
                near, made = made.factor, None
        u, length, residual, stresses = done
        lengths.append(length)
        growing = len(lengths) > 4 and lengths[-1] > lengths[-2] > lengths[-3]
        if growing or length > limits.FARTHEST * problem.size:
            raise StepFailed("the corrections grow")
    raise StepFailed(f"no equilibrium in {limits.CORRECTIONS} corrections")


def refine(
    problem: Problem,
    u: np.ndarray,
    load_factor: float,
    tolerance: float = limits.RESIDUAL_TOLERANCE,
    near: Tangent | None = None,
    residual: Residual | None = None,
) -> State:
    """Newton with the true tangent from close by, to rounding; the last factors tell stability, and serve as
    long as they bring the residual down quickly. near: the tangent of u, or one so close that it tells the
    same; residual: that at u, where it is known.

    Raises StepFailed when it does not converge there.
    """
    left = problem.residual(u, load_factor) if residual is None else residual
    aim = max(tolerance, rounding_floor(problem, u, left))
    for fresh in range(limits.REFINEMENTS + 1):
        if fresh:
            near = None  # its memory is needed
            near = problem.linearise(u, load_factor)
            done = problem.correct(near.factor, u, load_factor, left)
            far = done.length > limits.LONGEST_REFINEMENT * problem.size
            if far or not np.isfinite(done.residual.relative):
                raise StepFailed("the polishing step is not small")
            if done.residual.relative < left.relative:
                u, left = done.u, done.residual
            problem.note(load_factor, left.relative, done.length)
        if near is None:
            continue
        while not left.relative < aim:
            done = problem.correct(near.factor, u, load_factor, left)
            if not done.residual.relative < limits.STALE_FACTORS_ABOVE * left.relative:
                break
            u, left = done.u, done.residual
            problem.note(load_factor, left.relative, done.length)
        if left.relative < aim:
            return State(u, load_factor, near.blocks, near.factor, problem.negative(near.factor), left)
    raise StepFailed("the residual stagnates")


def all_rounding(problem: Problem, u: np.ndarray, residual: Residual, correction: float) -> bool:
    """Whether a residual is what rounding leaves; in double precision the correction [m] before it was idle.

    Where nothing strains the sheet, as on a turned clamp alone, the forces are all rounding, and no residual
    is small beside them.
    """
    if problem.assembly.precision == "double" and correction > limits.IDLE_CORRECTION * problem.size:
        return False
    return residual.relative < rounding_floor(problem, u, residual)


def rounding_floor(problem: Problem, u: np.ndarray, residual: Residual) -> float:
    """Residual at u, relative to the forces, that rounding of the link forces leaves."""
    return rounding(problem, u) / residual.scale if residual.scale > 0.0 else np.inf


def rounding(problem: Problem, u: np.ndarray) -> float:
    """Norm of the forces [N] that rounding of the link forces leaves."""
    assembly = problem.assembly
    # relative displacements are differences of u: their rounding, times the stiffness
    carried = assembly.all_families.link_stiffness * np.abs(u).max()
    if assembly.coupling is not None:
        carried += assembly.coupling.carried()
    return float(assembly.rounding * np.linalg.norm(carried))
