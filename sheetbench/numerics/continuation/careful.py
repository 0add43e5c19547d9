"""Load steps that stay on their branch of equilibria, and when to take them."""

from __future__ import annotations

from typing import Protocol, TypeVar

from sheetbench.numerics.continuation.path import FACTORISATIONS, Path, StepFailed
from sheetbench.numerics.continuation.stability import stability
from sheetbench.numerics.continuation.structure import Forces, State
from sheetbench.numerics.direct import Factor, SingularMatrixError
from sheetbench.scenes import Status

DOUBTFUL = 16  # factorisations from which on a load step may have jumped over a fold
DEARER = 4  # times as many may be taken to see whether one has
CONTINUOUS = 0.5  # of a careful linear step: what its equilibrium may be off it,
MISS = 0.05  # and in sizes of the structure
SAFE, GROWTH = 0.8, 4.0  # of what the last miss lets the next step go; of the last step
BRANCHING = 1e-3  # sizes of the structure: linear steps so short may cross a bifurcation

Linear = TypeVar("Linear", covariant=True)


class Reached(Protocol[Linear]):
    """A linear step: the state it leads to, its length, and the load factor that it is for."""

    @property
    def state(self) -> Linear: ...

    length: float
    target: float


def worth(path: Path[State, Forces]) -> int:
    """Factorisations that it is worth to look for another branch, which large load steps may have left: where
    the equilibrium is unstable, or, up to DEARER times those before, where it took long to find; else none. A
    path that is one linear step, without a correction, has jumped over nothing."""
    if not path.structure.symmetric or path.load_factor == 0.0 or path.factorisations == 1:
        return 0
    taken = path.factorisations
    if stability(path)[0] is Status.UNSTABLE:
        return FACTORISATIONS
    return min(DEARER * taken, FACTORISATIONS) if taken > DOUBTFUL else 0


def negatives(factor: Factor | None) -> int:
    """Negative eigenvalues of a factorised tangent; 0 where they are not known."""
    return factor.inertia.negative if factor is not None and factor.inertia is not None else 0


def continuous(
    path: Path[State, Forces], first: Reached[State], state: State, negative: int, rounding: float
) -> tuple[Factor, float]:
    """The factors of the tangent at an equilibrium, and how far the next linear step may go. Raises
    StepFailed where it is on another branch than the one that the step set out from: far from where the
    linear step led, or past a change of stability by more than a short step. negative: eigenvalues before;
    rounding: length that is none."""
    miss = path.structure.length(first.state, state)
    if miss > max(min(CONTINUOUS * first.length, MISS), rounding):
        raise StepFailed(Status.STEP_LIMIT, "the path folds", first.length)
    try:
        found = path.factored(path.tangent(state, first.target))
    except SingularMatrixError as error:
        raise StepFailed(Status.SINGULAR, str(error), first.length) from None
    if negatives(found) > negative and first.length > BRANCHING:
        raise StepFailed(Status.STEP_LIMIT, "the path loses stability", first.length)
    longest = GROWTH * first.length
    if miss > 0.0:  # it grows with the square of the step
        square = first.length**2 / miss
        longest = min(longest, SAFE * CONTINUOUS * square, (SAFE * MISS * square) ** 0.5)
    return found, longest
