"""A correction of Newton's method on a lattice as compiled loops: tangent, factors in a band, step, and the
forces where it leads. With u = T q + g(λ), equilibrium is Tᵀ (λ f(u) − f_int(u)) = 0."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from lumped.springs import all_families
from lumped.springs.all_families import SpringArrays, Stresses
from sheetbench.numerics import banded
from sheetbench.numerics.aliasing import empty, zeros
from sheetbench.numerics.options import njit
from sheetbench.numerics.sparse_products import Rows, product, transposed_product


class Equations(NamedTuple):
    """held: (n, 3) bool, what supports hold; free: T; band: where the reduced matrix goes, if in a band;
    load: f of dead loads (n, 3) [N]; driving: norm of the forces [N]
    of the natural state on the flat sheet."""

    held: np.ndarray
    free: Rows
    band: banded.Band
    load: np.ndarray
    driving: float


@njit
def advance(
    u: np.ndarray,
    step: np.ndarray,
    moved: np.ndarray,
    free: Rows,
    springs: SpringArrays,
) -> tuple[np.ndarray, float, np.ndarray, Stresses]:
    """Return the displacement (n, 3) [m] after a step (m,) [m] of the unknowns and the motion `moved` (n, 3)
    [m] of the supports, empty without one; the largest component of the change [m]; the internal force (n, 3)
    [N] there; and the stresses that the linearisation at u predicts there."""
    move = product(free, step).reshape(u.shape)
    if len(moved):
        move += moved
    after, length = empty(u.shape), 0.0
    for i in range(len(u)):
        for q in range(3):
            after[i, q] = u[i, q] + move[i, q]
            length = max(length, abs(move[i, q]))
    stresses = all_families.extrapolated(u, move, springs)
    return after, length, all_families.force(after, springs)[1], stresses


@njit
def correct(
    u: np.ndarray,
    stresses: Stresses,
    rows: np.ndarray,
    band: banded.Band,
    springs: SpringArrays,
) -> tuple[np.ndarray, np.ndarray, bool, np.ndarray]:
    """Return the blocks (b, 3, 3) [N/m] of the tangent at u, their factors in a band, whether the tangent is
    positive definite and the step finite, and the step (m,) [m] that balances `rows` (m,) [N]."""
    predicted = len(stresses[0]) + len(stresses[1]) > 0
    blocks = all_families.tangent(u, stresses, predicted, 1.0, 1.0, empty(0), springs)
    factors, definite = banded.factored(blocks, band)
    step = banded.solve_unrefined(factors, band.width, band.order, rows) if definite else zeros(len(rows))
    return blocks, factors, definite and np.isfinite(np.sum(step)), step


@njit
def unbalanced_force(
    internal: np.ndarray, load: np.ndarray, load_factor: float, equations: Equations, n: int
) -> tuple[np.ndarray, np.ndarray, float, float]:
    """Return load_factor × load less internal force r (k, 3) [N], Tᵀ r (n,), its norm, and the norm of the
    external forces plus those of the supports' and, driving, of a natural state [N]."""
    out = empty(internal.shape)
    total = loads = supports = 0.0
    for i in range(len(out)):
        for q in range(3):
            external = load_factor * load[i, q]
            out[i, q] = external - internal[i, q]
            loads += external**2
            if equations.held[i, q]:
                supports += internal[i, q] ** 2
    reduced = transposed_product(equations.free, out.ravel(), n)
    for value in reduced:
        total += value * value
    size = np.sqrt(loads) + np.sqrt(supports) + abs(load_factor) * equations.driving
    return out, reduced, np.sqrt(total), size
