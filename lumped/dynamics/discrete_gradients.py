"""Average forces over a step that give back exactly the elastic energy stored in it: discrete gradients.

Between two states 0 and 1, with r̄ and d̄ the means of relative positions and diagonals:

    link   k (e0 + e1)/(l0 + l1) r̄          since l1² − l0² = 2 r̄·Δr and ½ k (e1² − e0²) = force·Δr
    area   τ̄ (ḡ22 d̄1 − ḡ12 d̄2, ḡ11 d̄2 − ḡ12 d̄1)/(|c0| + |c1|),   τ̄ = k ((a0 + a1)/2a_rest − 1)

with g_ij = d_i·d_j, ḡ their means and |c| = 2 a: |c|² = g11 g22 − g12² is quadratic in g, and g in d, so
that the mean values give the differences exactly. Neither quotient can vanish below, so nothing needs a
special case for small steps. Both depend on positions through scalar products only, so linear and angular
momentum are conserved too. At equal states they are the forces of `lumped.springs.links` and
`lumped.springs.areas`. Source: Simo and Tarnow (1992), Gonzalez (1996); the area's formula is derived here.
"""

from __future__ import annotations

import math

import numpy as np
from numba import njit

from lumped.springs.area_dampers import _scatter
from lumped.springs.areas import _diagonals
from lumped.springs.links import _stretch


@njit(cache=True)
def add_link_forces(start: np.ndarray, end: np.ndarray, nodes, offset, rest_length, stiffness, force) -> None:
    """Add the links' average internal force between displacements `start` and `end` (n, 3) [m]."""
    for m in range(len(nodes)):
        a, b = nodes[m, 0], nodes[m, 1]
        e0, l0, _, _, _ = _stretch(start, nodes, offset, rest_length, m)
        e1, l1, _, _, _ = _stretch(end, nodes, offset, rest_length, m)
        pull = stiffness[m] * (e0 + e1) / (l0 + l1)
        for q in range(3):
            mean = offset[m, q] + 0.5 * (start[b, q] - start[a, q] + end[b, q] - end[a, q])
            force[a, q] -= pull * mean
            force[b, q] += pull * mean


@njit(cache=True)
def _gram(d):
    """g11, g12, g22 of two vectors (2, 3)."""
    g11 = d[0, 0] * d[0, 0] + d[0, 1] * d[0, 1] + d[0, 2] * d[0, 2]
    g12 = d[0, 0] * d[1, 0] + d[0, 1] * d[1, 1] + d[0, 2] * d[1, 2]
    g22 = d[1, 0] * d[1, 0] + d[1, 1] * d[1, 1] + d[1, 2] * d[1, 2]
    return g11, g12, g22


@njit(cache=True)
def add_cell_forces(start, end, nodes, diagonals, stiffness, force) -> None:
    """Add the area springs' average internal force between displacements `start` and `end`."""
    first, second, pair = np.empty((2, 3)), np.empty((2, 3)), np.empty((2, 3))
    for c in range(len(nodes)):
        _diagonals(start, nodes, c, first)
        _diagonals(end, nodes, c, second)
        for d in range(2):
            for q in range(3):
                first[d, q] += diagonals[c, d, q]
                second[d, q] += diagonals[c, d, q]
        a11, a12, a22 = _gram(first)
        b11, b12, b22 = _gram(second)
        r11, r12, r22 = _gram(diagonals[c])
        size = math.sqrt(a11 * a22 - a12 * a12) + math.sqrt(b11 * b22 - b12 * b12)
        rest = math.sqrt(r11 * r22 - r12 * r12)
        g11, g12, g22 = 0.5 * (a11 + b11), 0.5 * (a12 + b12), 0.5 * (a22 + b22)
        stress = stiffness[c] * (0.5 * size / rest - 1.0) / size
        for q in range(3):
            d1, d2 = 0.5 * (first[0, q] + second[0, q]), 0.5 * (first[1, q] + second[1, q])
            pair[0, q] = stress * (g22 * d1 - g12 * d2)
            pair[1, q] = stress * (g11 * d2 - g12 * d1)
        _scatter(nodes, c, pair, force)
