"""Area springs: energy, stress, force and tangent of cells that resist a change of area.

A cell whose four corners, in turn, are the means of p masses each has the area a = ½ |c|, with
c = d1 × d2 of its diagonals (exact for a flat cell, the area of the mid-point parallelogram doubled
for a warped one). It stores ½ k (a/a0 − 1)² a0. Stress τ = k (a/a0 − 1) [N/m]; force τ ∇a; tangent
(k/a0) ∇a ∇aᵀ + τ ∇²a, with τ an argument of its own as for the links. With n = c/|c|:

    ∂a/∂d1 = ½ d2 × n,   ∂a/∂d2 = ½ n × d1,
    ∇²a[δ, δ] = ½ [ (|δc|² − (n·δc)²)/|c| + 2 n·(δd1 × δd2) ],   δc = δd1 × d2 + d1 × δd2.

Arrays: nodes (c, 4, p); diagonals (c, 2, 3) [m] at rest; stiffness (c,) [N/m]; stress (c,) [N/m];
slots (c, 4p, 4p) block numbers, corner-major; blocks (b, 3, 3) [N/m], added to.
"""

from __future__ import annotations

import math

import numpy as np
from numba import njit


@njit(cache=True)
def cross(a: np.ndarray, b: np.ndarray, out: np.ndarray) -> None:
    out[0] = a[1] * b[2] - a[2] * b[1]
    out[1] = a[2] * b[0] - a[0] * b[2]
    out[2] = a[0] * b[1] - a[1] * b[0]


@njit(cache=True)
def diagonal_changes(u: np.ndarray, nodes: np.ndarray, c: int, change: np.ndarray) -> None:
    """Change of the two diagonals of cell c, (2, 3), into `change`."""
    p = nodes.shape[2]
    for q in range(3):
        first = second = 0.0
        for s in range(p):
            first += u[nodes[c, 2, s], q] - u[nodes[c, 0, s], q]
            second += u[nodes[c, 3, s], q] - u[nodes[c, 1, s], q]
        change[0, q] = first / p
        change[1, q] = second / p


@njit(cache=True)
def measure(
    u: np.ndarray,
    nodes: np.ndarray,
    diagonals: np.ndarray,
    c: int,
    change: np.ndarray,
    current: np.ndarray,
    normal: np.ndarray,
    gradient: np.ndarray,
    work: np.ndarray,
) -> tuple[float, float, float]:
    """Relative area change, rest area, |c|; fills normal (3,) and gradient (2, 3) = ∂a/∂d1, ∂a/∂d2."""
    diagonal_changes(u, nodes, c, change)
    d1, d2 = diagonals[c, 0], diagonals[c, 1]
    for q in range(3):
        current[0, q] = d1[q] + change[0, q]
        current[1, q] = d2[q] + change[1, q]
    cross(current[0], current[1], normal)
    size = math.sqrt(normal[0] ** 2 + normal[1] ** 2 + normal[2] ** 2)
    rest_x, rest_y, rest_z = (
        d1[1] * d2[2] - d1[2] * d2[1],
        d1[2] * d2[0] - d1[0] * d2[2],
        d1[0] * d2[1] - d1[1] * d2[0],
    )
    rest = math.sqrt(rest_x**2 + rest_y**2 + rest_z**2)
    # |c| − |c0| = (2 c0·δ + δ·δ)/(|c| + |c0|) with δ = δd1 × d2 + current d1 × δd2: no digits lost
    cross(change[0], d2, work)
    dx, dy, dz = work[0], work[1], work[2]
    cross(current[0], change[1], work)
    dx, dy, dz = dx + work[0], dy + work[1], dz + work[2]
    growth = 2.0 * (rest_x * dx + rest_y * dy + rest_z * dz) + dx * dx + dy * dy + dz * dz
    strain = growth / (size + rest) / rest
    for q in range(3):
        normal[q] /= size
    cross(current[1], normal, gradient[0])
    cross(normal, current[0], gradient[1])
    for q in range(3):
        gradient[0, q] *= 0.5
        gradient[1, q] *= 0.5
    return strain, 0.5 * rest, size


@njit(cache=True)
def scatter(nodes: np.ndarray, c: int, pair: np.ndarray, force: np.ndarray) -> None:
    """Add forces (2, 3) on the two diagonals of cell c to its masses."""
    p = nodes.shape[2]
    for q in range(3):
        for s in range(p):
            force[nodes[c, 0, s], q] -= pair[0, q] / p
            force[nodes[c, 2, s], q] += pair[0, q] / p
            force[nodes[c, 1, s], q] -= pair[1, q] / p
            force[nodes[c, 3, s], q] += pair[1, q] / p


@njit(cache=True)
def stresses(u: np.ndarray, nodes: np.ndarray, diagonals: np.ndarray, stiffness: np.ndarray) -> np.ndarray:
    """Stress k (a/a0 − 1) of every cell, (c,) [N/m]."""
    change, current, gradient = np.empty((2, 3)), np.empty((2, 3)), np.empty((2, 3))
    normal, work = np.empty(3), np.empty(3)
    out = np.empty(len(nodes))
    for c in range(len(nodes)):
        strain, _, _ = measure(u, nodes, diagonals, c, change, current, normal, gradient, work)
        out[c] = stiffness[c] * strain
    return out


@njit(cache=True)
def area_rate(v: np.ndarray, nodes: np.ndarray, c: int, change: np.ndarray, gradient: np.ndarray) -> float:
    """∇a·v of cell c [m² per unit of v's time], ∇a as `measure` left it; change takes v's diagonals."""
    diagonal_changes(v, nodes, c, change)
    grown = 0.0
    for q in range(3):
        grown += gradient[0, q] * change[0, q] + gradient[1, q] * change[1, q]
    return grown


@njit(cache=True)
def rates(
    u: np.ndarray, v: np.ndarray, nodes: np.ndarray, diagonals: np.ndarray, stiffness: np.ndarray
) -> np.ndarray:
    """Rates k ȧ/a0 of the stresses as the masses move with v (n, 3), (c,) [N/m per unit of v's time]."""
    change, current, gradient = np.empty((2, 3)), np.empty((2, 3)), np.empty((2, 3))
    normal, work = np.empty(3), np.empty(3)
    out = np.empty(len(nodes))
    for c in range(len(nodes)):
        _, area, _ = measure(u, nodes, diagonals, c, change, current, normal, gradient, work)
        out[c] = stiffness[c] * area_rate(v, nodes, c, change, gradient) / area
    return out


@njit(cache=True)
def extrapolated(
    u: np.ndarray, v: np.ndarray, nodes: np.ndarray, diagonals: np.ndarray, stiffness: np.ndarray
) -> np.ndarray:
    """Stresses that the linearisation at u predicts after a step v (n, 3) [m], (c,) [N/m]."""
    change, current, gradient = np.empty((2, 3)), np.empty((2, 3)), np.empty((2, 3))
    normal, work = np.empty(3), np.empty(3)
    out = np.empty(len(nodes))
    for c in range(len(nodes)):
        strain, area, _ = measure(u, nodes, diagonals, c, change, current, normal, gradient, work)
        out[c] = stiffness[c] * (strain + area_rate(v, nodes, c, change, gradient) / area)
    return out


@njit(cache=True)
def add_forces(
    u: np.ndarray, nodes: np.ndarray, diagonals: np.ndarray, stiffness: np.ndarray, force: np.ndarray
) -> float:
    """Add the internal force to `force` (n, 3) [N]; returns the energy [J]."""
    change, current, gradient = np.empty((2, 3)), np.empty((2, 3)), np.empty((2, 3))
    normal, work = np.empty(3), np.empty(3)
    energy = 0.0
    for c in range(len(nodes)):
        strain, area, _ = measure(u, nodes, diagonals, c, change, current, normal, gradient, work)
        stress = stiffness[c] * strain
        energy += 0.5 * stress * strain * area
        for q in range(3):
            gradient[0, q] *= stress
            gradient[1, q] *= stress
        scatter(nodes, c, gradient, force)
    return energy


@njit(cache=True)
def _products(d: np.ndarray) -> tuple[float, float, float]:
    """g11, g12, g22 of two vectors (2, 3)."""
    g11 = d[0, 0] * d[0, 0] + d[0, 1] * d[0, 1] + d[0, 2] * d[0, 2]
    g12 = d[0, 0] * d[1, 0] + d[0, 1] * d[1, 1] + d[0, 2] * d[1, 2]
    g22 = d[1, 0] * d[1, 0] + d[1, 1] * d[1, 1] + d[1, 2] * d[1, 2]
    return g11, g12, g22


@njit(cache=True)
def add_average_forces(
    start: np.ndarray,
    end: np.ndarray,
    nodes: np.ndarray,
    diagonals: np.ndarray,
    stiffness: np.ndarray,
    force: np.ndarray,
) -> None:
    """Add the force over a step from `start` to `end` (n, 3) [m] whose work is the energy stored in it:

    τ̄ (ḡ22 d̄1 − ḡ12 d̄2, ḡ11 d̄2 − ḡ12 d̄1)/(|c0| + |c1|),   τ̄ = k ((a0 + a1)/2a_rest − 1)

    with g_ij = d_i·d_j, bars for means and |c| = 2 a: |c|² = g11 g22 − g12² is quadratic in g, and g in d, so
    that the mean values give the differences exactly. Derived here, after Simo and Tarnow (1992).
    """
    first, second, pair = np.empty((2, 3)), np.empty((2, 3)), np.empty((2, 3))
    for c in range(len(nodes)):
        diagonal_changes(start, nodes, c, first)
        diagonal_changes(end, nodes, c, second)
        for d in range(2):
            for q in range(3):
                first[d, q] += diagonals[c, d, q]
                second[d, q] += diagonals[c, d, q]
        a11, a12, a22 = _products(first)
        b11, b12, b22 = _products(second)
        r11, r12, r22 = _products(diagonals[c])
        size = math.sqrt(a11 * a22 - a12 * a12) + math.sqrt(b11 * b22 - b12 * b12)
        rest = math.sqrt(r11 * r22 - r12 * r12)
        g11, g12, g22 = 0.5 * (a11 + b11), 0.5 * (a12 + b12), 0.5 * (a22 + b22)
        stress = stiffness[c] * (0.5 * size / rest - 1.0) / size
        for q in range(3):
            d1, d2 = 0.5 * (first[0, q] + second[0, q]), 0.5 * (first[1, q] + second[1, q])
            pair[0, q] = stress * (g22 * d1 - g12 * d2)
            pair[1, q] = stress * (g11 * d2 - g12 * d1)
        scatter(nodes, c, pair, force)


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
    """Add (k/a0) ∇a ∇aᵀ + τ ∇²a of every cell to the 3×3 blocks; in δd1 and δd2 the latter is τ/2|c| times

    |d2|² I − d2 d2ᵀ − 4 g1 g1ᵀ,   d1 d2ᵀ − (d1·d2) I − 4 g1 g2ᵀ + |c| N,   |d1|² I − d1 d1ᵀ − 4 g2 g2ᵀ

    with g = ∇a and aᵀ N b = n·(a × b).
    """
    change, current, gradient = np.empty((2, 3)), np.empty((2, 3)), np.empty((2, 3))
    normal, work = np.empty(3), np.empty(3)
    hessian = np.empty((4, 9))  # of (d1, d1), (d1, d2), (d2, d1), (d2, d2)
    for c in range(len(nodes)):
        _, area, size = measure(u, nodes, diagonals, c, change, current, normal, gradient, work)
        _of_diagonals(stiffness[c] / area, stress[c] / size, size, current, normal, gradient, hessian)
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
    change, current, gradient = np.empty((2, 3)), np.empty((2, 3)), np.empty((2, 3))
    normal, work = np.empty(3), np.empty(3)
    hessian = np.empty((4, 9))
    for c in range(len(nodes)):
        strain, area, size = measure(u, nodes, diagonals, c, change, current, normal, gradient, work)
        turning = share * stiffness[c] * strain / size
        _of_diagonals(stiffness[c] / area, turning, size, current, normal, gradient, hessian)
        add_blocks(hessian, nodes.shape[2], slots[c], blocks)


@njit(cache=True)
def _of_diagonals(
    material: float,
    turning: float,
    size: float,
    current: np.ndarray,
    normal: np.ndarray,
    gradient: np.ndarray,
    hessian: np.ndarray,
) -> None:
    """The tangent in the diagonals, from k/a0 and τ/|c|."""
    turning *= 0.5
    outer = material - 4.0 * turning
    g11, g12, g22 = _products(current)
    for q in range(3):
        for r in range(3):
            at, d1, d2 = 3 * q + r, current[0, q], current[1, q]
            g1, g2 = outer * gradient[0, q], outer * gradient[1, q]
            hessian[0, at] = g1 * gradient[0, r] - turning * d2 * current[1, r]
            hessian[1, at] = g1 * gradient[1, r] + turning * d1 * current[1, r]
            hessian[3, at] = g2 * gradient[1, r] - turning * d1 * current[0, r]
    for q in range(3):
        hessian[0, 4 * q] += turning * g22
        hessian[1, 4 * q] -= turning * g12
        hessian[3, 4 * q] += turning * g11
        ahead, behind, along = (q + 1) % 3, (q + 2) % 3, turning * size * normal[q]
        hessian[1, 3 * ahead + behind] += along
        hessian[1, 3 * behind + ahead] -= along
    for q in range(3):
        for r in range(3):
            hessian[2, 3 * r + q] = hessian[1, 3 * q + r]


@njit(cache=True)
def add_blocks(hessian: np.ndarray, p: int, slots: np.ndarray, blocks: np.ndarray) -> None:
    """Add a tangent in a cell's diagonals, (4, 9) of (d1, d1), (d1, d2), (d2, d1), (d2, d2), to the blocks of
    its corners, each the mean of p masses."""
    flat, share = blocks.reshape(-1, 9), 1.0 / (p * p)
    for corner in range(4):
        for other in range(4):
            part = hessian[2 * (corner % 2) + other % 2]
            sign = share if (corner < 2) == (other < 2) else -share
            for s in range(p):
                for t in range(p):
                    block = flat[np.uint64(slots[corner * p + s, other * p + t])]
                    for e in range(9):
                        block[e] += sign * part[e]
