"""Whether an equilibrium is stable: by its tangent's inertia or, under follower loads, whose tangent is not
symmetric, by its real eigenvalues (see `sheetbench.numerics.stability`)."""

from __future__ import annotations

from scipy.sparse import csr_matrix

from fem_reference.solving.path import Path
from fem_reference.solving.structure import Forces, State, Structure
from sheetbench.numerics.direct import DirectSolver, SingularMatrixError
from sheetbench.scenes import Status


def stability(
    structure: Structure[State, Forces], solver: DirectSolver, path: Path[State]
) -> tuple[Status, str]:
    """Whether the tangent at the path's last equilibrium is positive definite or, under follower loads, has
    no real eigenvalue below 0; a sentence where it is not, or where that is not known."""
    try:
        if structure.symmetric:
            path.factor = path.factor or solver.factor(_tangent(structure, path))
            inertia = path.factor.inertia
            if inertia is None:
                return Status.CONVERGED, "stability not known: the factors do not tell the inertia"
            negative, zero = inertia.negative, inertia.zero
        else:
            found = solver.factor(_tangent(structure, path)).negative_real()
            if found is None:
                return Status.CONVERGED, "stability not known: no eigenvalues of the tangent were found"
            negative, zero = found, 0
    except SingularMatrixError as error:
        return Status.SINGULAR, str(error)
    if zero:
        return Status.SINGULAR, f"the tangent has {zero} zero eigenvalues"
    if negative:
        return Status.UNSTABLE, f"the tangent has {negative} negative eigenvalues"
    return Status.CONVERGED, ""


def _tangent(structure: Structure[State, Forces], path: Path[State]) -> csr_matrix:
    """At the path's last equilibrium; counted as one that is factorised."""
    path.factorisations += 1
    forces = structure.forces(path.state, path.load_factor)
    return structure.system(path.state, forces, path.load_factor, mixed=False)[0]
