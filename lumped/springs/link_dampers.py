"""Dampers collocated with the links: dissipation potential, force and tangents, as compiled loops.

A damper of coefficient c on a link of unit vector n and current length r resists the rate of its length,
w = n·Δv. Its dissipation potential is ½ c w², its force ± c w n on the ends, the power it takes c w² ≥ 0.
Tangents: c n nᵀ with respect to the velocity, (c/r) [n (PΔv)ᵀ + w P] with P = I − n nᵀ with respect to the
displacement (unsymmetric); all but the part with PΔv is the links' own tangent, of c or of the tension c w.
Source: the seed's collocated linear dampers, with the rate taken along the link.
Arrays as in `lumped.springs.links`; velocity (n, 3) [m/s]; damping (m,) [N·s/m].
"""

from __future__ import annotations

import numpy as np
from numba import njit

from lumped.springs.links import stretch


@njit(cache=True)
def add_forces(
    u: np.ndarray,
    v: np.ndarray,
    nodes: np.ndarray,
    offset: np.ndarray,
    rest_length: np.ndarray,
    damping: np.ndarray,
    force: np.ndarray,
) -> float:
    """Add the damping force, signed as an internal one, to `force` (n, 3) [N]; the power taken [W]."""
    power = 0.0
    for m in range(len(nodes)):
        a, b = nodes[m, 0], nodes[m, 1]
        _, _, nx, ny, nz = stretch(u, nodes, offset, rest_length, m)
        rate = nx * (v[b, 0] - v[a, 0]) + ny * (v[b, 1] - v[a, 1]) + nz * (v[b, 2] - v[a, 2])
        pull = damping[m] * rate
        power += pull * rate
        force[a, 0] -= pull * nx
        force[a, 1] -= pull * ny
        force[a, 2] -= pull * nz
        force[b, 0] += pull * nx
        force[b, 1] += pull * ny
        force[b, 2] += pull * nz
    return power


@njit(cache=True)
def add_turning(
    u: np.ndarray,
    v: np.ndarray,
    nodes: np.ndarray,
    offset: np.ndarray,
    rest_length: np.ndarray,
    damping: np.ndarray,
    slots: np.ndarray,
    blocks: np.ndarray,
) -> None:
    """Add c/r n (PΔv)ᵀ of every link to the 3×3 blocks."""
    n, across = np.empty(3), np.empty(3)
    for m in range(len(nodes)):
        a, b = nodes[m, 0], nodes[m, 1]
        _, length, n[0], n[1], n[2] = stretch(u, nodes, offset, rest_length, m)
        rate = 0.0
        for q in range(3):
            rate += n[q] * (v[b, q] - v[a, q])
        for q in range(3):
            across[q] = v[b, q] - v[a, q] - rate * n[q]
        for p in range(3):
            for q in range(3):
                value = damping[m] / length * n[p] * across[q]
                blocks[slots[m, 0], p, q] += value
                blocks[slots[m, 3], p, q] += value
                blocks[slots[m, 1], p, q] -= value
                blocks[slots[m, 2], p, q] -= value
