"""Dampers collocated with the area springs: dissipation potential, force and tangents, as compiled loops.

A damper of coefficient c [N·s/m] on a cell of area a (a0 at rest) resists the rate ȧ = ∇a·v: potential
½ c (ȧ/a0)² a0, force (c/a0) ȧ ∇a, power taken (c/a0) ȧ². Tangents: (c/a0) ∇a ∇aᵀ with respect to the
velocity, (c/a0) [∇a (∇²a v)ᵀ + ȧ ∇²a] with respect to the displacement; all but the part with ∇²a v is the
area springs' own tangent, of c or of the stress (c/a0) ȧ. In the two diagonals, with n = c/|c|,
c = d1 × d2 and ċ = v1 × d2 + d1 × v2 (see `lumped.springs.areas`),

    ∇²a v = ½ (v2 × n + d2 × ṅ,  ṅ × d1 + n × v1),   ṅ = (ċ − n (n·ċ))/|c|.

With c = damping_time × k on every link and cell, the damping matrix of the undeformed lattice is
damping_time × its stiffness, positive also where single area springs are negative (ν < 1/3).
"""

from __future__ import annotations

import numpy as np
from numba import njit

from lumped.springs.areas import cross, diagonal_changes, measure, scatter


@njit(cache=True)
def add_forces(
    u: np.ndarray,
    v: np.ndarray,
    nodes: np.ndarray,
    diagonals: np.ndarray,
    damping: np.ndarray,
    force: np.ndarray,
) -> float:
    """Add the damping force, signed as an internal one, to `force` (n, 3) [N]; the power taken [W]."""
    change, current, gradient = np.empty((2, 3)), np.empty((2, 3)), np.empty((2, 3))
    normal, work = np.empty(3), np.empty(3)
    power = 0.0
    for c in range(len(nodes)):
        _, area, _ = measure(u, nodes, diagonals, c, change, current, normal, gradient, work)
        diagonal_changes(v, nodes, c, change)
        rate = 0.0
        for q in range(3):
            rate += gradient[0, q] * change[0, q] + gradient[1, q] * change[1, q]
        stress = damping[c] * rate / area
        power += stress * rate
        for q in range(3):
            gradient[0, q] *= stress
            gradient[1, q] *= stress
        scatter(nodes, c, gradient, force)
    return power


@njit(cache=True)
def add_turning(
    u: np.ndarray,
    v: np.ndarray,
    nodes: np.ndarray,
    diagonals: np.ndarray,
    damping: np.ndarray,
    slots: np.ndarray,
    blocks: np.ndarray,
) -> None:
    """Add (c/a0) ∇a (∇²a v)ᵀ of every cell to the 3×3 blocks."""
    change, current, gradient = np.empty((2, 3)), np.empty((2, 3)), np.empty((2, 3))
    normal, work, turning = np.empty(3), np.empty(3), np.empty(3)
    turned = np.empty((2, 3))
    p = nodes.shape[2]
    for c in range(len(nodes)):
        _, area, size = measure(u, nodes, diagonals, c, change, current, normal, gradient, work)
        diagonal_changes(v, nodes, c, change)
        cross(change[0], current[1], turning)
        cross(current[0], change[1], work)
        along = 0.0
        for q in range(3):
            turning[q] += work[q]
            along += normal[q] * turning[q]
        for q in range(3):
            turning[q] = (turning[q] - along * normal[q]) / size
        cross(change[1], normal, turned[0])
        cross(current[1], turning, work)
        for q in range(3):
            turned[0, q] = 0.5 * (turned[0, q] + work[q])
        cross(turning, current[0], turned[1])
        cross(normal, change[0], work)
        for q in range(3):
            turned[1, q] = 0.5 * (turned[1, q] + work[q])
        for corner in range(4):
            d, sign = corner % 2, -1.0 if corner < 2 else 1.0
            for other in range(4):
                e, scale = other % 2, sign * (-1.0 if other < 2 else 1.0) / (p * p)
                for s in range(p):
                    for t in range(p):
                        slot = slots[c, corner * p + s, other * p + t]
                        for q in range(3):
                            for r in range(3):
                                blocks[slot, q, r] += (
                                    scale * damping[c] / area * gradient[d, q] * turned[e, r]
                                )
