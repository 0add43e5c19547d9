"""Strain dampers: potential, force and tangents of cells that resist the rates of their sides' Green strains.

Dampers of coefficients c (three, [N·s/m]) on a cell of `lumped.springs.strains` resist the rates ε̇ = ∇ε·v:
potential ½ Σ c ε̇² a0 b0, force Σ c ε̇ ∇ε a0 b0, power taken Σ c ε̇² a0 b0. Tangents: Σ c ∇ε ∇εᵀ a0 b0 with
respect to the velocity, Σ c [∇ε (∇²ε v)ᵀ + ε̇ ∇²ε] a0 b0 with respect to the displacement; all but the part
with ∇²ε v is the strain springs' own tangent, of c or of the stresses c ε̇.

Arrays as in `lumped.springs.strains`: damping (c, 3) [N·s/m]; displacement, velocity and force (n, 3).
"""

from __future__ import annotations

import numpy as np
from numba import njit

from lumped.springs.strains import A_SIGNS, B_SIGNS, measure, scatter, strain_rates


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
    change, sides = np.empty((2, 3)), np.empty((2, 3))
    power = 0.0
    for c in range(len(nodes)):
        _, _, _, a0, b0 = measure(u, nodes, diagonals, c, change, sides)
        r1, r2, r3 = strain_rates(v, nodes, diagonals, c, change, sides, a0, b0)
        t1, t2, t3 = damping[c, 0] * r1, damping[c, 1] * r2, damping[c, 2] * r3
        power += (t1 * r1 + t2 * r2 + t3 * r3) * np.sqrt(a0 * b0)
        scatter(nodes, c, t1, t2, t3, sides, a0, b0, force)
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
    """Add Σ c ∇ε (∇²ε v)ᵀ a0 b0 of every cell to the 3×3 blocks."""
    change, sides, moving = np.empty((2, 3)), np.empty((2, 3)), np.empty((2, 3))
    p = nodes.shape[2]
    for c in range(len(nodes)):
        _, _, _, a0, b0 = measure(u, nodes, diagonals, c, change, sides)
        strain_rates(v, nodes, diagonals, c, moving, sides, a0, b0)
        area = np.sqrt(a0 * b0)
        for m in range(4):
            for n in range(4):
                for q in range(3):
                    g1, g2 = A_SIGNS[m] * sides[0, q] / a0, B_SIGNS[m] * sides[1, q] / b0
                    g3 = (A_SIGNS[m] * sides[1, q] + B_SIGNS[m] * sides[0, q]) / area
                    for r in range(3):
                        h1, h2 = A_SIGNS[n] * moving[0, r] / a0, B_SIGNS[n] * moving[1, r] / b0
                        h3 = (A_SIGNS[n] * moving[1, r] + B_SIGNS[n] * moving[0, r]) / area
                        value = damping[c, 0] * g1 * h1 + damping[c, 1] * g2 * h2 + damping[c, 2] * g3 * h3
                        for s in range(p):
                            for t in range(p):
                                blocks[slots[c, m * p + s, n * p + t], q, r] += value * area / (p * p)
