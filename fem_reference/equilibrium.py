"""Equilibrium of a structure under a load that grows from 0 to 1: mixed Newton with adaptive steps.

Strains are quadratic in the unknowns, so Newton's method on the displacements sees, after a large rotation,
membrane stresses that are nothing but the error of its own linear step, and wanders. Magisano, Leonetti &
Garcea (2017, "mixed integration point") take for the geometric stiffness the stress that the last
linear step extrapolated, σ* = C (ε + B δu), and leave the residual alone: the answer is the
same, the path from the flat sheet is a few iterations long. Supports move in the first linear step.

A load step that does not converge is halved; after one that converges easily it is doubled. At the end
the inertia of the true tangent says whether the equilibrium is stable; under follower loads, whose tangent is
not symmetric, its real eigenvalues do (collapse; flutter is a matter of dynamics).
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any, Protocol

import numpy as np
from scipy.sparse import csr_matrix
from scipy.sparse.linalg import LinearOperator, eigs

from fem_reference.linear import DirectSolver, SingularMatrix
from scenes import Iteration, Status

TOLERANCE = 5e-9  # residual, relative to the forces that balance
VANISHING = 1e-13  # work of a step, relative to the load step's first: beyond it only rounding is left
ITERATIONS = 16  # in one load step
EASY = 6  # a load step that took no more is followed by a longer one
FACTORISATIONS = 400  # in all
SMALLEST_STEP = 1.0 / 1024.0
FARTHEST = 1e3  # a step beyond so many sizes of the structure has diverged


class Structure(Protocol):
    """What `trace` needs; states and forces are the structure's own."""

    @property
    def symmetric(self) -> bool: ...
    def rest(self) -> Any: ...
    def forces(self, state: Any, load_factor: float) -> Any: ...
    def imbalance(self, state: Any, forces: Any) -> float: ...
    def gap(self, state: Any, load_factor: float) -> float: ...
    def system(
        self, state: Any, forces: Any, load_factor: float, mixed: bool = True
    ) -> tuple[csr_matrix, np.ndarray]: ...
    def advance(self, state: Any, forces: Any, load_factor: float, step: np.ndarray) -> Any: ...
    def length(self, start: Any, end: Any) -> float: ...


@dataclass
class Path:
    """Where the tracing stands: the last equilibrium, its load factor, and what it took."""

    state: Any
    load_factor: float = 0.0
    status: Status = Status.STEP_LIMIT
    factorisations: int = 0
    history: list[Iteration] = field(default_factory=list)
    message: str = ""


def trace(structure: Structure, solver: DirectSolver) -> Path:
    """The equilibrium at load factor 1, or the last one on the way with the reason it is the last."""
    path = Path(structure.rest())
    size = 1.0
    while path.load_factor < 1.0:
        target = min(1.0, path.load_factor + size)
        before = path.factorisations
        state, status = _newton(structure, solver, path, target)
        if state is not None:
            path.state, path.load_factor = state, target
            size *= 2.0 if path.factorisations - before <= EASY else 1.0
            continue
        size /= 2.0
        if size < SMALLEST_STEP or path.factorisations >= FACTORISATIONS:
            path.status = status
            path.message = f"no equilibrium found beyond load factor {path.load_factor:.4g}"
            return path
    path.status, path.message = _stability(structure, solver, path)
    return path


def _newton(structure: Structure, solver: DirectSolver, path: Path, target: float) -> tuple[Any, Status]:
    """The equilibrium at load factor `target` from the path's last, or None and why."""
    state, before, length = path.state, np.inf, 0.0
    works: list[float] = []
    for _ in range(ITERATIONS):
        forces = structure.forces(state, target)
        imbalance = structure.imbalance(state, forces)
        relative = imbalance / forces.size if forces.size > 0.0 else imbalance
        path.history.append(Iteration(target, relative, length))
        if not np.isfinite(relative):
            return None, Status.NON_FINITE
        rounded = bool(works) and works[-1] <= VANISHING * works[0] and imbalance > 0.5 * before
        if structure.gap(state, target) <= TOLERANCE and (relative <= TOLERANCE or rounded):
            return state, Status.CONVERGED
        if path.factorisations >= FACTORISATIONS:
            return None, Status.STEP_LIMIT
        path.factorisations += 1
        try:
            matrix, rows = structure.system(state, forces, target)
            step = solver.factor(matrix).solve(rows)
        except SingularMatrix:
            return None, Status.SINGULAR
        following = structure.advance(state, forces, target, step)
        length = structure.length(state, following)
        if not length < FARTHEST:
            return None, Status.DIVERGED
        works.append(abs(float(step @ rows)))
        state, before = following, imbalance
    return None, Status.STEP_LIMIT


def _stability(structure: Structure, solver: DirectSolver, path: Path) -> tuple[Status, str]:
    """Whether the tangent is positive definite or, under follower loads, has no real eigenvalue below 0."""
    forces = structure.forces(path.state, 1.0)
    matrix, _ = structure.system(path.state, forces, 1.0, mixed=False)
    path.factorisations += 1
    try:
        if structure.symmetric:
            inertia = solver.factor(matrix).inertia
            if inertia is None:
                return Status.CONVERGED, "stability not checked: the factors do not tell the inertia"
            negative, zero = inertia.negative, inertia.zero
        else:
            lowest = nearest_to_zero(matrix, solver)
            negative, zero = int(np.sum((lowest.imag == 0.0) & (lowest.real < 0.0))), 0
    except SingularMatrix as error:
        return Status.SINGULAR, str(error)
    if zero:
        return Status.SINGULAR, f"the tangent has {zero} zero eigenvalues"
    if negative:
        return Status.UNSTABLE, f"the tangent has {negative} negative eigenvalues"
    return Status.CONVERGED, ""


def nearest_to_zero(matrix: csr_matrix, solver: DirectSolver, count: int = 6) -> np.ndarray:
    """Eigenvalues (complex) of least magnitude of an unsymmetric matrix, by Arnoldi on its inverse."""
    n = matrix.shape[0]
    factor = solver.factor(matrix)
    if n <= count + 2:
        return np.linalg.eigvals(matrix.toarray()).astype(complex)
    inverse = LinearOperator((n, n), matvec=factor.solve, dtype=float)
    start = np.random.default_rng(0).uniform(-1.0, 1.0, n)
    return eigs(matrix, count, sigma=0.0, OPinv=inverse, v0=start, return_eigenvectors=False)
