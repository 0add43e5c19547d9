"""Whether an equilibrium is stable: by its tangent's inertia or, under follower loads, whose tangent is not
symmetric, by its real eigenvalues (see `sheetbench.numerics.stability`)."""

from __future__ import annotations

from collections.abc import Sequence

from sheetbench.answers.solution import Status
from sheetbench.errors import NoEquilibrium
from sheetbench.numerics.continuation.path import Path
from sheetbench.numerics.continuation.structure import Forces, State
from sheetbench.numerics.direct import SingularMatrixError


def stability(path: Path[State, Forces]) -> tuple[Status, str]:
    """Whether the tangent at the path's last equilibrium is positive definite or, under follower loads, has
    no real eigenvalue below 0; a sentence where it is not, or where that is not known."""
    structure = path.structure
    try:
        if structure.symmetric:
            path.factor = path.factor or path.factored(path.tangent(path.state, path.load_factor))
            negative, zero = path.factor.negative - structure.multipliers, path.factor.zero
        else:
            path.factor = path.factored(path.tangent(path.state, path.load_factor))
            found = None if structure.multipliers else path.factor.negative_real()
            if found is None:
                return (
                    Status.CONVERGED,
                    "stability not known: the tangent's eigenvalues nearest to zero were not found, or its "
                    "determinant has the sign of further negative ones",
                )
            negative, zero = found, 0
    except SingularMatrixError as error:
        return Status.SINGULAR, str(error)
    if zero:
        return Status.SINGULAR, f"the tangent has {zero} zero eigenvalues"
    if negative:
        return Status.UNSTABLE, f"the tangent has {negative} negative eigenvalues"
    return Status.CONVERGED, ""


def require_stable(model: str, status: Status, notes: Sequence[str]) -> None:
    """Raise NoEquilibrium unless a path ended in a stable equilibrium that the model knows."""
    if status is not Status.CONVERGED:
        raise NoEquilibrium(f"{model}: {status}: {'; '.join([*notes, status.advice])}")
