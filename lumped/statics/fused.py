"""One Newton correction of a small lattice as a single compiled call that holds no lock.

Tangent, band, Cholesky factors, solution, new residual and, where asked for, the stresses that the
linearisation predicts: what `lumped.statics.problem` does call by call, for dead loads on central springs in
double precision. On small lattices the calls' own time is most of a solve's. Cholesky's solutions are not
refined: their backward error is of the order of rounding, and it is looked at.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numba import njit

from lumped.springs import together
from lumped.springs.together import Springs, Stresses
from sheetbench.numerics import banded
from sheetbench.numerics.banded import Band
from sheetbench.numerics.maps import Rows, product, transposed_product

NOT_REFINED: Any = np.int64(0)  # corrections of a solution; Python's own numba would compile for once more


class Posed(NamedTuple):
    """A lattice of n masses under supports and dead loads as arrays.

    springs, and how many blocks their tangent has, each of which masses (rows, indices); band and free:
    where the blocks go, and u = T q; held: (n, 3) bool, what supports act on; dead: (n, 3) [N]; placed:
    (n, 3) [m] that supports move masses by at full load, moves: whether they do; link_stiffness: (n,) [N/m],
    links' at each mass; columns, positions, areas: `Assembly.plan`; size: the sheet's longer side [m].
    """

    springs: Springs
    blocks: int
    rows: np.ndarray
    indices: np.ndarray
    band: Band
    free: Rows
    held: np.ndarray
    dead: np.ndarray
    placed: np.ndarray
    moves: bool
    link_stiffness: np.ndarray
    columns: np.ndarray
    positions: np.ndarray
    areas: np.ndarray
    size: float


class Work(NamedTuple):
    """The tangent last factored: its blocks, its band and the factors."""

    blocks: np.ndarray
    matrix: np.ndarray
    factors: np.ndarray


class Corrected(NamedTuple):
    """Whether the tangent is positive definite, and if so: the correction (n, 3) [m] and its backward error;
    unbalanced force (n, 3) [N] behind it and its size relative to the forces; stresses that were predicted
    there."""

    definite: bool
    step: np.ndarray
    miss: float
    unbalanced: np.ndarray
    residual: float
    stresses: Stresses


@njit(cache=True, nogil=True)
def room(count: int, band: Band) -> Work:
    """Room for tangents of `count` blocks."""
    return Work(np.empty((count, 3, 3)), banded.room(band), banded.room(band))


@njit(cache=True, nogil=True)
def factored(u: np.ndarray, stress: Stresses, posed: Posed, work: Work) -> bool:
    """Whether the tangent at u (n, 3) [m] with these stresses is positive definite; its factors to `work`."""
    work.blocks[:] = 0.0
    together.add_tangent(u, posed.springs, stress, 1.0, work.blocks)
    banded.store(work.blocks, posed.band, work.matrix)
    work.factors[:] = work.matrix
    return banded.factor(work.factors, len(posed.band.order), posed.band.width)


@njit(cache=True, nogil=True)
def solved(force: np.ndarray, posed: Posed, work: Work) -> tuple[np.ndarray, float]:
    """The displacement (n, 3) [m] by a force (n, 3) [N] with the factors at hand, and its backward error."""
    band = posed.band
    right = transposed_product(posed.free, force.ravel(), len(band.order))
    x, miss = banded.solve(work.matrix, work.factors, band.width, band.order, right, NOT_REFINED)
    return product(posed.free, x).reshape(force.shape), miss


@njit(cache=True, nogil=True)
def corrected(
    u: np.ndarray,
    unbalanced: np.ndarray,
    load_factor: float,
    stress: Stresses,
    predict: bool,
    posed: Posed,
    work: Work,
) -> Corrected:
    """The correction at u (n, 3) [m] with these stresses in the tangent."""
    if not factored(u, stress, posed, work):
        return Corrected(False, unbalanced, np.inf, unbalanced, np.inf, stress)
    step, miss = solved(unbalanced, posed, work)
    left, residual = residual_at(u + step, load_factor, posed)
    following = together.extrapolated(u, step, posed.springs) if predict else stress
    return Corrected(True, step, miss, left, residual, following)


@njit(cache=True, nogil=True)
def residual_at(u: np.ndarray, load_factor: float, posed: Posed) -> tuple[np.ndarray, float]:
    """Unbalanced force (n, 3) [N] at u, and its norm on the free unknowns relative to the forces."""
    _, internal = together.force(u, posed.springs)
    return unbalanced_force(internal, load_factor * posed.dead, posed.held, posed.free, len(posed.band.order))


@njit(cache=True, nogil=True)
def unbalanced_force(
    internal: np.ndarray, external: np.ndarray, held: np.ndarray, free: Rows, n: int
) -> tuple[np.ndarray, float]:
    """External less internal force (n, 3), and its norm on the free unknowns over the forces' `scale`."""
    out = external - internal
    size = scale(internal, external, held)
    total = 0.0
    for value in transposed_product(free, out.ravel(), n):
        total += value * value
    return out, np.sqrt(total) / size if size > 0.0 else np.sqrt(total)


@njit(cache=True, nogil=True)
def scale(internal: np.ndarray, external: np.ndarray, held: np.ndarray) -> float:
    """Norm of the external forces plus that of the supports'."""
    loads = supports = 0.0
    for i in range(len(internal)):
        for q in range(3):
            loads += external[i, q] ** 2
            if held[i, q]:
                supports += internal[i, q] ** 2
    return np.sqrt(loads) + np.sqrt(supports)
