"""Stability of an equilibrium: by the inertia of its tangent or, under follower loads, by real eigenvalues.

The tangent under follower loads is not symmetric (see `sheetbench.numerics.stability`).
"""

from collections.abc import Sequence

from sheetbench.answers.solution import Status
from sheetbench.errors import NoEquilibrium
from sheetbench.numerics.continuation.path import Path
from sheetbench.numerics.continuation.structure import Forces, State
from sheetbench.numerics.direct import SingularMatrixError


def stability(path: Path[State, Forces]) -> tuple[Status, str]:
    """Return the status of a path's last equilibrium, and a sentence unless it is stable. It is stable if its
    tangent is positive definite or, under follower loads, has no real eigenvalue below 0. The sentence also
    reports that stability is not known."""
    structure = path.structure
    try:
        if structure.symmetric:
            path.factor = path.factor or path.factored(path.tangent(path.state, path.load_factor))
            negative, zero = path.factor.negative - structure.multipliers, path.factor.zero
        else:
            path.factor = path.factored(path.tangent(path.state, path.load_factor))
            count = None if structure.multipliers else path.factor.negative_real()
            if count is None:
                return (
                    Status.CONVERGED,
                    "stability not known: the tangent's eigenvalues nearest to zero were not found, or its "
                    "determinant has the sign of further negative ones",
                )
            negative, zero = count, 0
    except SingularMatrixError as error:
        return Status.SINGULAR, str(error)
    if zero:
        return Status.SINGULAR, f"the tangent has {zero} zero eigenvalues"
    if negative:
        return Status.UNSTABLE, f"the tangent has {negative} negative eigenvalues"
    return Status.CONVERGED, ""


def require_stable(model: str, status: Status, notes: Sequence[str]) -> None:
    """Raise NoEquilibrium unless a path ended in a stable equilibrium within the model's limits."""
    if status is not Status.CONVERGED:
        raise NoEquilibrium(f"{model}: {status}: {'; '.join([*notes, status.advice])}")
