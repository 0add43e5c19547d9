"""The per-direction law of Habibi et al., F_q = k_q Δ_q (1 − L/r): links of unequal stiffness along x, y, z.

It has no energy, hence no tension to extrapolate, and an unsymmetric tangent. Arrays as in
`lumped.springs.links`, but stiffness (m, 3) [N/m].
"""

from __future__ import annotations

import numpy as np
from numba import njit

from lumped.springs.links import LinkArrays, measure


@njit(cache=True)
def add_forces(u: np.ndarray, links: LinkArrays, force: np.ndarray) -> float:
    """Add the force on the links' ends to `force` (n, 3) [N]; there is no energy, 0 [J]."""
    for m in range(len(links.nodes)):
        a, b = links.nodes[m, 0], links.nodes[m, 1]
        change, square, r = measure(u, links.nodes, links.offset, m)
        length = np.sqrt(square)
        e = change / (length + links.rest_length[m])
        for q in range(3):
            value = links.constants[m, q] * e * r[q] / length
            force[a, q] -= value
            force[b, q] += value
    return 0.0


@njit(cache=True)
def add_tangent(
    u: np.ndarray, links: LinkArrays, stress: np.ndarray, share: float, lower: bool, blocks: np.ndarray
) -> None:
    """Tangent of the per-direction law, diag(k) [n nᵀ + (e/r)(I − n nᵀ)], whatever the stress. It is
    unsymmetric: all of it is added."""
    n = np.empty(3)
    for m in range(len(links.nodes)):
        change, square, r = measure(u, links.nodes, links.offset, m)
        length = np.sqrt(square)
        n[0], n[1], n[2] = r[0] / length, r[1] / length, r[2] / length
        across = change / (length + links.rest_length[m]) / length
        for p in range(3):
            for q in range(3):
                value = (1.0 - across) * n[p] * n[q]
                if p == q:
                    value += across
                value *= links.constants[m, p]
                blocks[links.slots[m, 0], p, q] += value
                blocks[links.slots[m, 3], p, q] += value
                blocks[links.slots[m, 1], p, q] -= value
                blocks[links.slots[m, 2], p, q] -= value
