"""Whether an equilibrium is stable: by its tangent's inertia or, under follower loads, whose tangent is not
symmetric, by its real eigenvalues (collapse; flutter is a matter of dynamics)."""

from __future__ import annotations

import numpy as np
from scipy.sparse import csr_matrix
from scipy.sparse.linalg import LinearOperator, eigs

from fem_reference.solving.linear import DirectSolver, SingularMatrix
from fem_reference.solving.path import Path
from fem_reference.solving.structure import Forces, State, Structure
from sheetbench.scenes import Status


def stability(
    structure: Structure[State, Forces], solver: DirectSolver, path: Path[State]
) -> tuple[Status, str]:
    """Whether the tangent at the path's last equilibrium is positive definite or, under follower loads, has
    no real eigenvalue below 0; a sentence where it is not."""
    try:
        if structure.symmetric:
            path.factor = path.factor or solver.factor(_tangent(structure, path))
            inertia = path.factor.inertia
            if inertia is None:
                return Status.CONVERGED, "stability not checked: the factors do not tell the inertia"
            negative, zero = inertia.negative, inertia.zero
        else:
            lowest = nearest_to_zero(_tangent(structure, path), solver)
            negative, zero = int(np.sum((lowest.imag == 0.0) & (lowest.real < 0.0))), 0
    except SingularMatrix as error:
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


def nearest_to_zero(matrix: csr_matrix, solver: DirectSolver, count: int = 6) -> np.ndarray:
    """Eigenvalues (complex) of least magnitude of an unsymmetric matrix, by Arnoldi on its inverse."""
    n = matrix.shape[0]
    factor = solver.factor(matrix)
    if n <= count + 2:
        return np.linalg.eigvals(matrix.toarray()).astype(complex)
    inverse = LinearOperator((n, n), matvec=factor.solve, dtype=float)
    start = np.random.default_rng(0).uniform(-1.0, 1.0, n)
    return eigs(matrix, count, sigma=0.0, OPinv=inverse, v0=start, return_eigenvectors=False)
