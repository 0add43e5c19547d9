"""A step of Newton's method on a lattice and the unbalanced force after it, as compiled loops: for
u = T q + g(λ), equilibrium is Tᵀ (λ f(u) − f_int(u)) = 0."""

from __future__ import annotations

from typing import Any

import numpy as np

from lumped.springs import all_families
from lumped.springs.all_families import SpringArrays, Stresses
from sheetbench.numerics.aliasing import empty
from sheetbench.numerics.options import Pointer, njit
from sheetbench.numerics.sparse_products import Rows, product, transposed_product


@njit
def unbalanced_force(
    internal: np.ndarray,
    load: np.ndarray,
    load_factor: float,
    held: np.ndarray,
    free: Rows,
    driving: float,
    n: int,
) -> tuple[np.ndarray, np.ndarray, float, float]:
    """Return load_factor × load less internal force r (k, 3) [N], Tᵀ r (n,), its norm, and the norm of the
    external forces plus the norms of the supports' and, `driving`, of a natural state's forces [N]. held: (k,
    3) bool, components that supports hold; free: T."""
    out = empty(internal.shape)
    total = loads = supports = 0.0
    for i in range(len(out)):
        for q in range(3):
            external = load_factor * load[i, q]
            out[i, q] = external - internal[i, q]
            loads += external**2
            if held[i, q]:
                supports += internal[i, q] ** 2
    reduced = transposed_product(free, out.ravel(), n)
    for value in reduced:
        total += value * value
    size = np.sqrt(loads) + np.sqrt(supports) + abs(load_factor) * driving
    return out, reduced, np.sqrt(total), size


@njit
def advance(
    u: np.ndarray,
    step: np.ndarray,
    moved: np.ndarray,
    springs: Pointer[SpringArrays],
    load: np.ndarray,
    load_factor: float,
    held: np.ndarray,
    free: Rows,
    driving: float,
) -> tuple[np.ndarray, float, Stresses, np.ndarray, Any]:
    """Advance the displacement u (n, 3) [m] by a step (m,) [m] of the unknowns and the supports' motion
    `moved` (n, 3) [m], empty without one. Return it with the largest component of the change [m], the
    stresses that the linearisation at u predicts, the springs' force (n, 3) [N] afterwards, and its
    `unbalanced_force`."""
    move = product(free, step).reshape(u.shape)
    after, length = empty(u.shape), 0.0
    for i in range(len(u)):
        for q in range(3):
            if len(moved):
                move[i, q] += moved[i, q]
            after[i, q] = u[i, q] + move[i, q]
            length = max(length, abs(move[i, q]))
    stresses = all_families.extrapolated(u, move, springs)
    internal = all_families.force(after, springs)[1]
    unbalanced = unbalanced_force(internal, load, load_factor, held, free, driving, len(step))
    return after, length, stresses, internal, unbalanced
