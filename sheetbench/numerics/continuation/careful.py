"""Load steps that stay on their branch of equilibria, and when to take them."""

from __future__ import annotations

from sheetbench.answers.solution import Status
from sheetbench.numerics.continuation.newton import Predictor
from sheetbench.numerics.continuation.path import LoadStepFailed, Path
from sheetbench.numerics.continuation.stability import stability
from sheetbench.numerics.continuation.structure import Forces, State
from sheetbench.numerics.direct import Factor, SingularMatrixError


def careful_budget(path: Path[State, Forces]) -> int:
    """Return how many factorisations a second, careful run may take, which looks for a branch that large load
    steps may have left; 0 if none is needed: the equilibrium is stable and was found quickly, or the path is
    one linear step, without a correction, and has jumped over nothing."""
    one_step = path.factorisations == 1 and not path.structure.prestrained
    if not path.structure.symmetric or path.load_factor == 0.0 or one_step:
        return 0
    taken, limits = path.factorisations, path.limits
    unstable = stability(path)[0] is Status.UNSTABLE
    if unstable and path.structure.has_meaning(path.state):
        return limits.factorisations
    budget = min(limits.careful_budget_factor * taken, limits.factorisations)
    return budget if unstable or taken > limits.careful_after else 0


class UnknownInertia(LoadStepFailed):
    """Nothing tells whether a load step has left its branch."""


def negatives(factor: Factor | None) -> int:
    """Negative eigenvalues of a factorised tangent. Raises UnknownInertia where they are not known."""
    if factor is None or factor.inertia is None:
        reason = "the path cannot be held to its branch: the tangent's factors do not tell the inertia"
        raise UnknownInertia(Status.STEP_LIMIT, reason, 0.0)
    return factor.inertia.negative


def continuous(
    path: Path[State, Forces],
    first: Predictor[State, Forces],
    state: State,
    negative: int,
    found: Factor | None,
) -> tuple[Factor, float]:
    """The factors of the tangent at an equilibrium, and how far the next linear step may go. Raises
    StepFailed where it is on another branch than the one that the step set out from: far from where the
    linear step led, or past a change of stability by more than a short step, or, where a
    natural strain loads it that may not move it, at all. negative: eigenvalues before; found: the factors,
    where they are at hand."""
    limits, miss = path.limits, path.structure.length(first.state, state)
    if miss > max(min(limits.continuous * first.length, limits.miss), max(limits.idle, limits.tolerance)):
        raise LoadStepFailed(Status.STEP_LIMIT, "the path folds", first.length)
    try:
        found = found or path.factored(path.tangent(state, first.target))
    except SingularMatrixError as error:
        raise LoadStepFailed(Status.SINGULAR, str(error), first.length) from None
    short = first.length <= limits.branching and not path.structure.prestrained
    if negatives(found) > negative and not short:
        raise LoadStepFailed(Status.STEP_LIMIT, "the path loses stability", first.length)
    longest = limits.growth * first.length
    if miss > 0.0:  # it grows with the square of the step
        square = first.length**2 / miss
        longest = min(
            longest, limits.safe * limits.continuous * square, (limits.safe * limits.miss * square) ** 0.5
        )
    return found, longest
