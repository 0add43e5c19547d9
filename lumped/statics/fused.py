"""One Newton correction of a small lattice as a single compiled call that holds no lock.

Tangent, band, Cholesky factors, solution, new residual and, where asked for, the stresses that the
linearisation predicts: what `lumped.statics.problem` does call by call, for dead loads on central springs in
double precision. On small lattices the calls' own time is most of a solve's.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit

from lumped.linear import banded
from lumped.linear.maps import Rows, product, transposed_product
from lumped.springs import together
from lumped.springs.together import Springs, Stresses


class Corrected(NamedTuple):
    """Whether the tangent is positive definite, and if so: its blocks, band and factors; the correction
    (n, 3) [m] and its backward error; unbalanced force (n, 3) [N] behind it and its size relative to the
    forces; stresses that were predicted there."""

    definite: bool
    blocks: np.ndarray
    matrix: np.ndarray
    factors: np.ndarray
    step: np.ndarray
    miss: float
    unbalanced: np.ndarray
    residual: float
    stresses: Stresses


@njit(cache=True, nogil=True)
def corrected(
    u: np.ndarray,
    unbalanced: np.ndarray,
    external: np.ndarray,
    held: np.ndarray,
    stress: Stresses,
    predict: bool,
    springs: Springs,
    count: int,
    band: banded.Band,
    free: Rows,
    refinements: int,
) -> Corrected:
    """The correction at u (n, 3) [m] with these stresses in the tangent's `count` blocks."""
    n = len(band.order)
    blocks = together.tangent(u, springs, stress, count)
    matrix = banded.stored(blocks, band)
    factors = matrix.copy()
    if not banded.factor(factors, n, band.width):
        return Corrected(False, blocks, matrix, factors, unbalanced, np.inf, unbalanced, np.inf, stress)
    right = transposed_product(free, unbalanced.ravel(), n)
    x, miss = banded.solve(matrix, factors, band.width, band.order, right, refinements)
    step = product(free, x).reshape(u.shape)
    _, internal = together.force(u + step, springs)
    left, residual = unbalanced_force(internal, external, held, free, n)
    following = together.extrapolated(u, step, springs) if predict else stress
    return Corrected(True, blocks, matrix, factors, step, miss, left, residual, following)


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
