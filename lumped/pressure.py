"""Pressure on the mid-surface, bilinear over every cell of corners x₀ … x₃ in turn, as compiled loops.

    F_a = p ∫ N_a x,ξ × x,η dξ dη = p Σ_b M_ab c_b,     c_b = (x_{b+1} − x_b) × (x_{b−1} − x_b),

with M_ab = ∫ N_a N_b over the unit square, 4/36 for a = b, 2/36 for neighbours, 1/36 across: exact. The
diagonals d = x₂ − x₀ and e = x₃ − x₁ have d × e = c₀ + c₂ = c₁ + c₃: so F_a = p (c_a + d × e)/12, and a
cell's forces sum up to p ½ d × e. Each corner is the mean of a column of masses and shares its force equally
among them. If the edges sweep no area (`scenes.encloses_volume`), the forces are the derivatives of p V,
V = ∫ z (x,ξ × x,η)·e_z = Σ z_a F_a·e_z/p the volume over the plan, and the tangent is symmetric; otherwise
the edges add an unsymmetric part (Schweizerhof and Ramm 1984).
"""

from __future__ import annotations

import numpy as np

from sheetbench.numerics.aliasing import empty, zeros
from sheetbench.numerics.options import njit

WEIGHTS = np.array([4.0, 2.0, 1.0, 2.0]) / 36.0  # M_ab by (b − a) mod 4


@njit
def _middle(x: np.ndarray, p: int) -> np.ndarray:
    """Return the mean position of every column of p masses, stored in the row of its first mass, (n, 3)."""
    out = zeros(x.shape)
    for mass in range(len(x)):
        for q in range(3):
            out[mass - mass % p, q] += x[mass, q] / p
    return out


@njit
def add_forces(x: np.ndarray, cells: np.ndarray, pressure: np.ndarray, force: np.ndarray) -> None:
    """Add the force at positions x (n, 3) [m] on cells (c, 4, p) under pressure (c,) [Pa] to `force` (n, 3)
    [N]."""
    p, on_middle = cells.shape[2], zeros(x.shape)
    add_surface_forces(_middle(x, p), cells[:, :, 0], pressure, on_middle)
    for mass in range(len(x)):
        for q in range(3):
            force[mass, q] += on_middle[mass - mass % p, q] / p


@njit
def add_surface_forces(x: np.ndarray, cells: np.ndarray, pressure: np.ndarray, force: np.ndarray) -> None:
    """Add the force at points x (m, 3) [m] of the mid-surface on cells (c, 4) under pressure (c,) [Pa] to
    `force` (m, 3) [N]."""
    for c in range(len(cells)):
        i, j, k, m = cells[c]
        share = pressure[c] / 12.0
        for q, r, s in ((0, 1, 2), (1, 2, 0), (2, 0, 1)):
            dr, ds, er, es = x[k, r] - x[i, r], x[k, s] - x[i, s], x[m, r] - x[j, r], x[m, s] - x[j, s]
            fr, fs = x[j, r] - x[i, r], x[j, s] - x[i, s]
            both = share * (dr * es - ds * er)
            first, second = share * (fr * es - fs * er), share * (fr * ds - fs * dr)  # c₀ and c₁
            force[i, q] += both + first
            force[j, q] += both + second
            force[k, q] += 2.0 * both - first
            force[m, q] += 2.0 * both - second


@njit
def add_couples(x: np.ndarray, columns: np.ndarray, moments: np.ndarray, force: np.ndarray) -> None:
    """Add couples (e,) [N·m] at positions x (n, 3) [m] to `force` (n, 3) [N], each on the outer layers of a
    column of masses about the chord between its neighbours; columns: (e, 3, p), the column, the one before
    and the one after."""
    along, across = empty(3), empty(3)
    for e in range(len(columns)):
        top, bottom, length, square = columns[e, 0, -1], columns[e, 0, 0], 0.0, 0.0
        for q in range(3):
            along[q], across[q] = 0.0, x[top, q] - x[bottom, q]
            for k in range(columns.shape[2]):
                along[q] += x[columns[e, 2, k], q] - x[columns[e, 1, k], q]
            length, square = length + along[q] ** 2, square + across[q] ** 2
        scale = moments[e] / (np.sqrt(length) * square)
        for q, r, s in ((0, 1, 2), (1, 2, 0), (2, 0, 1)):
            couple = scale * (along[r] * across[s] - along[s] * across[r])
            force[top, q] += couple
            force[bottom, q] -= couple


@njit
def add_tangent(
    x: np.ndarray, cells: np.ndarray, slots: np.ndarray, pressure: np.ndarray, blocks: np.ndarray
) -> None:
    """Add the derivative of the force to the blocks (b, 3, 3) [N/m] at the slots (c, 4 p, 4 p) of the cells'
    masses. δc = [r]× δs − [s]× δr with r, s the two sides from a corner."""
    p = cells.shape[2]
    middle, by = _middle(x, p), empty((4, 4, 3))
    for c in range(len(cells)):
        corners = middle[cells[c, :, 0]]
        by[:] = 0.0
        for b in range(4):
            after, before = (b + 1) % 4, (b + 3) % 4
            for q in range(3):
                r, s = corners[after, q] - corners[b, q], corners[before, q] - corners[b, q]
                for a in range(4):
                    weight = WEIGHTS[(b - a) % 4] * pressure[c] / p**2
                    by[a, before, q] += weight * r
                    by[a, after, q] -= weight * s
                    by[a, b, q] += weight * (s - r)
        for i in range(4 * p):
            for j in range(4 * p):
                v, block = by[i // p, j // p], blocks[slots[c, i, j]]
                block[0, 1] -= v[2]
                block[0, 2] += v[1]
                block[1, 0] += v[2]
                block[1, 2] -= v[0]
                block[2, 0] -= v[1]
                block[2, 1] += v[0]
