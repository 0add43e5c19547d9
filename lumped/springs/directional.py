"""The seed's per-direction law F_q = k_q Δ_q (1 − L/r): links of unequal stiffness along x, y and z.

It has no energy, hence no tension to extrapolate, and an unsymmetric tangent. Arrays as in
`lumped.springs.links`, but stiffness (m, 3) [N/m].
"""

from __future__ import annotations

import numpy as np
from numba import njit

from lumped.springs.links import stretch


@njit(cache=True)
def add_forces(
    u: np.ndarray,
    nodes: np.ndarray,
    offset: np.ndarray,
    rest_length: np.ndarray,
    stiffness: np.ndarray,
    force: np.ndarray,
) -> float:
    """Add the force on the links' ends to `force` (n, 3) [N]; there is no energy, 0 [J]."""
    for m in range(len(nodes)):
        a, b = nodes[m, 0], nodes[m, 1]
        e, _, nx, ny, nz = stretch(u, nodes, offset, rest_length, m)
        for q, n in ((0, nx), (1, ny), (2, nz)):
            value = stiffness[m, q] * e * n
            force[a, q] -= value
            force[b, q] += value
    return 0.0


@njit(cache=True)
def add_tangent(
    u: np.ndarray,
    nodes: np.ndarray,
    offset: np.ndarray,
    rest_length: np.ndarray,
    stiffness: np.ndarray,
    stress: np.ndarray,
    slots: np.ndarray,
    blocks: np.ndarray,
) -> None:
    """Tangent of the per-direction law, diag(k) [n nᵀ + (e/r)(I − n nᵀ)]; `stress` is not looked at."""
    n = np.empty(3)
    for m in range(len(nodes)):
        e, length, n[0], n[1], n[2] = stretch(u, nodes, offset, rest_length, m)
        across = e / length
        for p in range(3):
            for q in range(3):
                value = (1.0 - across) * n[p] * n[q]
                if p == q:
                    value += across
                value *= stiffness[m, p]
                blocks[slots[m, 0], p, q] += value
                blocks[slots[m, 3], p, q] += value
                blocks[slots[m, 1], p, q] -= value
                blocks[slots[m, 2], p, q] -= value
