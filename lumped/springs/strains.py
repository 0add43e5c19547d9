"""Strain springs: energy, stress, force, tangent of cells that resist stretching and shearing of their sides.

A cell whose four corners, in turn, are the means of p masses each has the mean sides a = (d1 − d2)/2 along x
and b = (d1 + d2)/2 along y, d1 and d2 its diagonals, and the Green strains

    ε1 = (|a|² − a0²)/(2 a0²),   ε2 = (|b|² − b0²)/(2 b0²),   γ = a·b/(a0 b0).

It stores ½ (k1 ε1² + k2 ε2² + k3 γ²) a0 b0; stresses τ = k ε [N/m]. Rigid motions leave it alone. Links and
area springs do for cells of moderate aspect; these make up what they cannot (see
`lumped.calibration.least_squares`): in each layer the shear that diagonal links of a long cell have too
little of, on the mid-surface the stretching that cross-layer links leave over.

Arrays as in `lumped.springs.areas`, but stiffness and stress (c, 3): of ε1, ε2, γ [N/m].
"""

from __future__ import annotations

import numpy as np
from numba import njit

from lumped.springs.areas import add_blocks, diagonal

A_SIGNS = np.array([-0.5, 0.5, 0.5, -0.5])  # a = Σ A_SIGNS[corner] x[corner]
B_SIGNS = np.array([-0.5, -0.5, 0.5, 0.5])


@njit(cache=True)
def diagonal_changes(u: np.ndarray, nodes: np.ndarray, c: int, change: np.ndarray) -> None:
    """Change of the two diagonals of cell c, (2, 3), into `change`."""
    change[0, 0], change[0, 1], change[0, 2] = diagonal(u, nodes, c, 0)
    change[1, 0], change[1, 1], change[1, 2] = diagonal(u, nodes, c, 1)


@njit(cache=True)
def measure(
    u: np.ndarray, nodes: np.ndarray, diagonals: np.ndarray, c: int, change: np.ndarray, sides: np.ndarray
) -> tuple[float, float, float, float, float]:
    """Strains ε1, ε2, γ and the squares a0², b0²; fills change (2, 3) of the sides, and sides (2, 3)."""
    diagonal_changes(u, nodes, c, change)
    first = second = shear = a0 = b0 = 0.0
    for q in range(3):
        a, b = (
            0.5 * (diagonals[c, 0, q] - diagonals[c, 1, q]),
            0.5 * (diagonals[c, 0, q] + diagonals[c, 1, q]),
        )
        da, db = 0.5 * (change[0, q] - change[1, q]), 0.5 * (change[0, q] + change[1, q])
        change[0, q], change[1, q] = da, db
        sides[0, q], sides[1, q] = a + da, b + db
        # |a|² − a0² = (2 a + δ)·δ, and a·b is zero at rest: no digits lost
        first += (2.0 * a + da) * da
        second += (2.0 * b + db) * db
        shear += da * b + (a + da) * db
        a0 += a * a
        b0 += b * b
    return first / (2.0 * a0), second / (2.0 * b0), shear / np.sqrt(a0 * b0), a0, b0


@njit(cache=True)
def stresses(u: np.ndarray, nodes: np.ndarray, diagonals: np.ndarray, stiffness: np.ndarray) -> np.ndarray:
    """Stresses k ε of every cell, (c, 3) [N/m]."""
    change, sides = np.empty((2, 3)), np.empty((2, 3))
    out = np.empty((len(nodes), 3))
    for c in range(len(nodes)):
        e1, e2, shear, _, _ = measure(u, nodes, diagonals, c, change, sides)
        out[c, 0], out[c, 1], out[c, 2] = stiffness[c, 0] * e1, stiffness[c, 1] * e2, stiffness[c, 2] * shear
    return out


@njit(cache=True)
def strain_rates(
    v: np.ndarray,
    nodes: np.ndarray,
    diagonals: np.ndarray,
    c: int,
    moving: np.ndarray,
    sides: np.ndarray,
    a0: float,
    b0: float,
) -> tuple[float, float, float]:
    """ε̇1, ε̇2, γ̇ of cell c with sides (2, 3); fills moving (2, 3), the velocities of the sides."""
    diagonal_changes(v, nodes, c, moving)
    r1 = r2 = r3 = 0.0
    for q in range(3):
        va, vb = 0.5 * (moving[0, q] - moving[1, q]), 0.5 * (moving[0, q] + moving[1, q])
        moving[0, q], moving[1, q] = va, vb
        r1 += sides[0, q] * va / a0
        r2 += sides[1, q] * vb / b0
        r3 += (sides[1, q] * va + sides[0, q] * vb) / np.sqrt(a0 * b0)
    return r1, r2, r3


@njit(cache=True)
def rates(
    u: np.ndarray, v: np.ndarray, nodes: np.ndarray, diagonals: np.ndarray, stiffness: np.ndarray
) -> np.ndarray:
    """Rates k ε̇ of the stresses as the masses move with v (n, 3), (c, 3) [N/m per unit of v's time]."""
    change, sides = np.empty((2, 3)), np.empty((2, 3))
    out = np.empty((len(nodes), 3))
    for c in range(len(nodes)):
        _, _, _, a0, b0 = measure(u, nodes, diagonals, c, change, sides)
        r1, r2, r3 = strain_rates(v, nodes, diagonals, c, change, sides, a0, b0)
        out[c, 0], out[c, 1], out[c, 2] = stiffness[c, 0] * r1, stiffness[c, 1] * r2, stiffness[c, 2] * r3
    return out


@njit(cache=True)
def extrapolated(
    u: np.ndarray, v: np.ndarray, nodes: np.ndarray, diagonals: np.ndarray, stiffness: np.ndarray
) -> np.ndarray:
    """Stresses that the linearisation at u predicts after a step v (n, 3) [m], (c, 3) [N/m]."""
    change, sides = np.empty((2, 3)), np.empty((2, 3))
    out = np.empty((len(nodes), 3))
    for c in range(len(nodes)):
        e1, e2, e3, a0, b0 = measure(u, nodes, diagonals, c, change, sides)
        r1, r2, r3 = strain_rates(v, nodes, diagonals, c, change, sides, a0, b0)
        out[c, 0], out[c, 1] = stiffness[c, 0] * (e1 + r1), stiffness[c, 1] * (e2 + r2)
        out[c, 2] = stiffness[c, 2] * (e3 + r3)
    return out


@njit(cache=True)
def scatter(
    nodes: np.ndarray,
    c: int,
    t1: float,
    t2: float,
    t3: float,
    sides: np.ndarray,
    a0: float,
    b0: float,
    force: np.ndarray,
) -> None:
    """Add the forces of stresses t1, t2, t3 on sides (2, 3) of cell c."""
    p = nodes.shape[2]
    area = np.sqrt(a0 * b0)
    for q in range(3):
        on_a = (t1 * sides[0, q] / a0 + t3 * sides[1, q] / area) * area / p
        on_b = (t2 * sides[1, q] / b0 + t3 * sides[0, q] / area) * area / p
        for corner in range(4):
            value = A_SIGNS[corner] * on_a + B_SIGNS[corner] * on_b
            for s in range(p):
                force[nodes[c, corner, s], q] += value


@njit(cache=True)
def add_forces(
    u: np.ndarray, nodes: np.ndarray, diagonals: np.ndarray, stiffness: np.ndarray, force: np.ndarray
) -> float:
    """Add the internal force to `force` (n, 3) [N]; returns the energy [J]."""
    change, sides = np.empty((2, 3)), np.empty((2, 3))
    energy = 0.0
    for c in range(len(nodes)):
        e1, e2, shear, a0, b0 = measure(u, nodes, diagonals, c, change, sides)
        t1, t2, t3 = stiffness[c, 0] * e1, stiffness[c, 1] * e2, stiffness[c, 2] * shear
        energy += 0.5 * (t1 * e1 + t2 * e2 + t3 * shear) * np.sqrt(a0 * b0)
        scatter(nodes, c, t1, t2, t3, sides, a0, b0, force)
    return energy


@njit(cache=True)
def add_average_forces(
    start: np.ndarray,
    end: np.ndarray,
    nodes: np.ndarray,
    diagonals: np.ndarray,
    stiffness: np.ndarray,
    force: np.ndarray,
) -> None:
    """Add the force over a step from `start` to `end` (n, 3) [m] whose work is the energy stored in it.

    The strains are quadratic in the sides: the mean stress on the mean sides is exact (Simo, Tarnow 1992).
    """
    change, first, second = np.empty((2, 3)), np.empty((2, 3)), np.empty((2, 3))
    for c in range(len(nodes)):
        e1, e2, e3, a0, b0 = measure(start, nodes, diagonals, c, change, first)
        f1, f2, f3, _, _ = measure(end, nodes, diagonals, c, change, second)
        for q in range(3):
            first[0, q] = 0.5 * (first[0, q] + second[0, q])
            first[1, q] = 0.5 * (first[1, q] + second[1, q])
        t1 = 0.5 * stiffness[c, 0] * (e1 + f1)
        t2 = 0.5 * stiffness[c, 1] * (e2 + f2)
        t3 = 0.5 * stiffness[c, 2] * (e3 + f3)
        scatter(nodes, c, t1, t2, t3, first, a0, b0, force)


@njit(cache=True)
def add_tangent(
    u: np.ndarray,
    nodes: np.ndarray,
    diagonals: np.ndarray,
    stiffness: np.ndarray,
    stress: np.ndarray,
    slots: np.ndarray,
    blocks: np.ndarray,
) -> None:
    """Add Σ k g gᵀ and the stresses' geometric part of every cell to the 3×3 blocks."""
    change, sides, hessian = np.empty((2, 3)), np.empty((2, 3)), np.empty((4, 9))
    for c in range(len(nodes)):
        _, _, _, a0, b0 = measure(u, nodes, diagonals, c, change, sides)
        _of_diagonals(stiffness[c], stress[c, 0], stress[c, 1], stress[c, 2], sides, a0, b0, hessian)
        add_blocks(hessian, nodes.shape[2], slots[c], blocks)


@njit(cache=True)
def add_own_tangent(
    u: np.ndarray,
    nodes: np.ndarray,
    diagonals: np.ndarray,
    stiffness: np.ndarray,
    share: float,
    slots: np.ndarray,
    blocks: np.ndarray,
) -> None:
    """The same with this share of the stresses at u."""
    change, sides, hessian = np.empty((2, 3)), np.empty((2, 3)), np.empty((4, 9))
    for c in range(len(nodes)):
        e1, e2, e3, a0, b0 = measure(u, nodes, diagonals, c, change, sides)
        k = stiffness[c]
        _of_diagonals(k, share * k[0] * e1, share * k[1] * e2, share * k[2] * e3, sides, a0, b0, hessian)
        add_blocks(hessian, nodes.shape[2], slots[c], blocks)


@njit(cache=True)
def _of_diagonals(
    stiffness: np.ndarray,
    t1: float,
    t2: float,
    t3: float,
    sides: np.ndarray,
    a0: float,
    b0: float,
    hessian: np.ndarray,
) -> None:
    """The tangent of a cell in its diagonals, (4, 9) of (d1, d1), (d1, d2), (d2, d1), (d2, d2), under the
    stresses t: that in a and b, with a = (d1 − d2)/2 and b = (d1 + d2)/2."""
    area = np.sqrt(a0 * b0)
    share = 0.25 * area
    k1, k2 = share * stiffness[0] / (a0 * a0), share * stiffness[1] / (b0 * b0)
    k3 = share * stiffness[2] / (a0 * b0)
    across_a, across_b, across = share * t1 / a0, share * t2 / b0, share * t3 / area
    for q in range(3):
        a, b = sides[0, q], sides[1, q]
        for r in range(3):
            aa = k1 * a * sides[0, r] + k3 * b * sides[1, r]
            bb = k2 * b * sides[1, r] + k3 * a * sides[0, r]
            ab, ba = k3 * b * sides[0, r], k3 * a * sides[1, r]
            if q == r:
                aa, bb, ab, ba = aa + across_a, bb + across_b, ab + across, ba + across
            at = 3 * q + r
            hessian[0, at] = bb + aa + (ab + ba)
            hessian[1, at] = bb - aa + (ab - ba)
            hessian[2, at] = bb - aa - (ab - ba)
            hessian[3, at] = bb + aa - (ab + ba)
