"""Equilibrium of a structure under a load that grows from 0 to 1: mixed Newton with adaptive steps.

Strains are quadratic in the unknowns, so Newton's method on the displacements sees, after a large rotation,
membrane stresses that are nothing but the error of its own linear step, and wanders. Magisano, Leonetti &
Garcea (2017, "mixed integration point") take for the geometric stiffness the stress that the last
linear step extrapolated, σ* = C (ε + B δu), and leave the residual alone: the answer is the
same, the path from the flat sheet is a few iterations long. Supports move in the first linear step.

A load step that does not converge is halved; after one that converges easily it is doubled. At the end
the inertia of the true tangent says whether the equilibrium is stable.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any, Protocol

import numpy as np
from scipy.sparse import csr_matrix

from fem_reference.linear import DirectSolver, SingularMatrix
from scenes import Iteration, Status

TOLERANCE = 1e-9  # residual, relative to the forces that balance
ROUNDING = 1e-6  # below it a residual that no longer falls while steps vanish is rounding
VANISHING = 1e-10  # such a step, relative to the structure's size
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


def trace(structure: Structure, solver: DirectSolver, first_step: float = 1.0) -> Path:
    """The equilibrium at load factor 1, or the last one on the way with the reason it is the last."""
    path = Path(structure.rest())
    size = first_step
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
    state, length, before = path.state, np.inf, np.inf
    for _ in range(ITERATIONS):
        forces = structure.forces(state, target)
        imbalance, gap = structure.imbalance(state, forces), structure.gap(state, target)
        relative = imbalance / forces.size if forces.size > 0.0 else imbalance
        path.history.append(Iteration(target, relative, length if np.isfinite(length) else 0.0))
        if not np.isfinite(relative):
            return None, Status.NON_FINITE
        stalled = length <= VANISHING and relative <= ROUNDING and imbalance > 0.5 * before
        if gap <= TOLERANCE and (relative <= TOLERANCE or stalled):
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
        state, before = following, imbalance
    return None, Status.STEP_LIMIT


def _stability(structure: Structure, solver: DirectSolver, path: Path) -> tuple[Status, str]:
    """Whether the potential (with follower loads: the tangent's symmetric part) has a minimum here."""
    forces = structure.forces(path.state, 1.0)
    matrix, _ = structure.system(path.state, forces, 1.0, mixed=False)
    path.factorisations += 1
    if not structure.symmetric:
        matrix, solver = ((matrix + matrix.T) * 0.5).tocsr(), DirectSolver(symmetric=True)
    try:
        inertia = solver.factor(matrix).inertia
    except SingularMatrix as error:
        return Status.SINGULAR, str(error)
    if inertia is None:
        return Status.CONVERGED, "stability not checked: the factors do not tell the inertia"
    if inertia.zero:
        return Status.SINGULAR, f"the tangent has {inertia.zero} zero eigenvalues"
    if inertia.negative:
        return Status.UNSTABLE, f"the tangent has {inertia.negative} negative eigenvalues"
    return Status.CONVERGED, ""
