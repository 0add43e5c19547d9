"""Dampers collocated with the area springs: dissipation potential, force and tangents, as compiled loops.

A damper of coefficient c [N·s/m] on a cell of area a (a0 at rest) resists the rate ȧ = ∇a·v: potential
½ c (ȧ/a0)² a0, force (c/a0) ȧ ∇a, power taken (c/a0) ȧ². Tangents: (c/a0) ∇a ∇aᵀ with respect to the
velocity, (c/a0) [∇a (∇²a v)ᵀ + ȧ ∇²a] with respect to the displacement; all but the part with ∇²a v is the
area springs' own tangent, of c or of the stress (c/a0) ȧ. In the two diagonals, with n = c/|c|,
c = d1 × d2 and ċ = v1 × d2 + d1 × v2 (see `lumped.springs.areas`),

    ∇²a v = ½ (v2 × n + d2 × ṅ,  ṅ × d1 + n × v1),   ṅ = (ċ − n (n·ċ))/|c|.

With c = damping_time × k on every link and cell, the damping matrix of the undeformed lattice is
damping_time × its stiffness, positive also where single area springs are negative (ν < 1/3). In a strained
lattice nothing checks the sum: the energy dissipated, which every run tells, would fall.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from lumped.springs.areas import add_blocks, area_rate, diagonal, gradients, measure, scatter
from lumped.springs.vectors import cross, dot, less, outer, plus, times


@njit(cache=True, error_model="numpy")
def add_forces(
    u: np.ndarray,
    v: np.ndarray,
    nodes: np.ndarray,
    diagonals: np.ndarray,
    damping: np.ndarray,
    force: np.ndarray,
) -> float:
    """Add the damping force, signed as an internal one, to `force` (n, 3) [N]; the power taken [W]."""
    power = 0.0
    for c in range(len(nodes)):
        _, area, _, d1, d2, normal = measure(u, nodes, diagonals, c)
        g1, g2 = gradients(d1, d2, normal)
        rate = area_rate(v, nodes, c, g1, g2)
        stress = damping[c] * rate / area
        power += stress * rate
        scatter(nodes, c, times(stress, g1), times(stress, g2), force)
    return power


@njit(cache=True, error_model="numpy")
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
    p, hessian = nodes.shape[2], np.empty((4, 9))  # of (d1, d1), (d1, d2), (d2, d1), (d2, d2)
    for c in range(len(nodes)):
        _, area, size, d1, d2, normal = measure(u, nodes, diagonals, c)
        g1, g2 = gradients(d1, d2, normal)
        v1, v2 = diagonal(v, nodes, c, 0), diagonal(v, nodes, c, 1)
        rate = plus(cross(v1, d2), cross(d1, v2))
        turning = times(1.0 / size, less(rate, times(dot(normal, rate), normal)))
        turned1 = times(0.5, plus(cross(v2, normal), cross(d2, turning)))
        turned2 = times(0.5, plus(cross(turning, d1), cross(normal, v1)))
        outer(damping[c] / area, g1, turned1, hessian[0])
        outer(damping[c] / area, g1, turned2, hessian[1])
        outer(damping[c] / area, g2, turned1, hessian[2])
        outer(damping[c] / area, g2, turned2, hessian[3])
        add_blocks(hessian, p, slots[c], blocks)
