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

from lumped.springs.vectors import Vector, cross, dot, less, outer_sum, plus, times


@njit(cache=True, error_model="numpy")
def diagonal(u: np.ndarray, nodes: np.ndarray, c: int, corner: int) -> Vector:
    """What u changes in the diagonal of cell c that begins at a corner, in double precision."""
    share = 1.0 / nodes.shape[2]
    x = y = z = 0.0
    for s in range(nodes.shape[2]):
        a, b = np.uint64(nodes[c, corner, s]), np.uint64(nodes[c, corner + 2, s])
        x += u[b, 0] - u[a, 0]
        y += u[b, 1] - u[a, 1]
        z += u[b, 2] - u[a, 2]
    return x * share, y * share, z * share


@njit(cache=True, error_model="numpy")
def at_rest(diagonals: np.ndarray, c: int, which: int) -> Vector:
    """One of the two diagonals of cell c at rest, in double precision."""
    d = diagonals[c, which]
    return 1.0 * d[0], 1.0 * d[1], 1.0 * d[2]


@njit(cache=True, error_model="numpy")
def measure(
    u: np.ndarray, nodes: np.ndarray, diagonals: np.ndarray, c: int
) -> tuple[float, float, float, Vector, Vector, Vector]:
    """Relative area change, rest area, |c|, the diagonals d1 and d2, and the normal n."""
    change1, change2 = diagonal(u, nodes, c, 0), diagonal(u, nodes, c, 1)
    rest1, rest2 = at_rest(diagonals, c, 0), at_rest(diagonals, c, 1)
    d1, d2 = plus(rest1, change1), plus(rest2, change2)
    now, before = cross(d1, d2), cross(rest1, rest2)
    size, rest = math.sqrt(dot(now, now)), math.sqrt(dot(before, before))
    # |c| − |c0| = (2 c0·δ + δ·δ)/(|c| + |c0|) with δ = δd1 × d2 + current d1 × δd2: no digits lost
    grown = plus(cross(change1, rest2), cross(d1, change2))
    strain = (2.0 * dot(before, grown) + dot(grown, grown)) / (size + rest) / rest
    normal = now[0] / size, now[1] / size, now[2] / size
    return strain, 0.5 * rest, size, d1, d2, normal


@njit(cache=True, error_model="numpy")
def gradients(d1: Vector, d2: Vector, normal: Vector) -> tuple[Vector, Vector]:
    """∂a/∂d1 and ∂a/∂d2."""
    return times(0.5, cross(d2, normal)), times(0.5, cross(normal, d1))


@njit(cache=True, error_model="numpy")
def scatter(nodes: np.ndarray, c: int, on_d1: Vector, on_d2: Vector, force: np.ndarray) -> None:
    """Add forces on the two diagonals of cell c to its masses."""
    share = 1.0 / nodes.shape[2]
    for corner in range(2):
        x, y, z = times(share, on_d1 if corner == 0 else on_d2)
        for s in range(nodes.shape[2]):
            a, b = np.uint64(nodes[c, corner, s]), np.uint64(nodes[c, corner + 2, s])
            force[a, 0] -= x
            force[a, 1] -= y
            force[a, 2] -= z
            force[b, 0] += x
            force[b, 1] += y
            force[b, 2] += z


@njit(cache=True, error_model="numpy")
def stresses(u: np.ndarray, nodes: np.ndarray, diagonals: np.ndarray, stiffness: np.ndarray) -> np.ndarray:
    """Stress k (a/a0 − 1) of every cell, (c,) [N/m]."""
    out = np.empty(len(nodes))
    for c in range(len(nodes)):
        out[c] = stiffness[c] * measure(u, nodes, diagonals, c)[0]
    return out


@njit(cache=True, error_model="numpy")
def area_rate(v: np.ndarray, nodes: np.ndarray, c: int, g1: Vector, g2: Vector) -> float:
    """∇a·v of cell c [m² per unit of v's time], of its gradients."""
    return dot(g1, diagonal(v, nodes, c, 0)) + dot(g2, diagonal(v, nodes, c, 1))


@njit(cache=True, error_model="numpy")
def rates(
    u: np.ndarray, v: np.ndarray, nodes: np.ndarray, diagonals: np.ndarray, stiffness: np.ndarray
) -> np.ndarray:
    """Rates k ȧ/a0 of the stresses as the masses move with v (n, 3), (c,) [N/m per unit of v's time]."""
    out = np.empty(len(nodes))
    for c in range(len(nodes)):
        _, area, _, d1, d2, normal = measure(u, nodes, diagonals, c)
        g1, g2 = gradients(d1, d2, normal)
        out[c] = stiffness[c] * area_rate(v, nodes, c, g1, g2) / area
    return out


@njit(cache=True, error_model="numpy")
def extrapolated(
    u: np.ndarray, v: np.ndarray, nodes: np.ndarray, diagonals: np.ndarray, stiffness: np.ndarray
) -> np.ndarray:
    """Stresses that the linearisation at u predicts after a step v (n, 3) [m], (c,) [N/m]."""
    out = np.empty(len(nodes))
    for c in range(len(nodes)):
        strain, area, _, d1, d2, normal = measure(u, nodes, diagonals, c)
        g1, g2 = gradients(d1, d2, normal)
        out[c] = stiffness[c] * (strain + area_rate(v, nodes, c, g1, g2) / area)
    return out


@njit(cache=True, error_model="numpy")
def add_forces(
    u: np.ndarray, nodes: np.ndarray, diagonals: np.ndarray, stiffness: np.ndarray, force: np.ndarray
) -> float:
    """Add the internal force to `force` (n, 3) [N]; returns the energy [J]."""
    energy = 0.0
    for c in range(len(nodes)):
        strain, area, _, d1, d2, normal = measure(u, nodes, diagonals, c)
        g1, g2 = gradients(d1, d2, normal)
        stress = stiffness[c] * strain
        energy += 0.5 * stress * strain * area
        scatter(nodes, c, times(stress, g1), times(stress, g2), force)
    return energy


@njit(cache=True, error_model="numpy")
def _products(d1: Vector, d2: Vector) -> tuple[float, float, float]:
    """g11, g12, g22 of two vectors."""
    return dot(d1, d1), dot(d1, d2), dot(d2, d2)


@njit(cache=True, error_model="numpy")
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
    for c in range(len(nodes)):
        rest1, rest2 = at_rest(diagonals, c, 0), at_rest(diagonals, c, 1)
        a1, a2 = plus(rest1, diagonal(start, nodes, c, 0)), plus(rest2, diagonal(start, nodes, c, 1))
        b1, b2 = plus(rest1, diagonal(end, nodes, c, 0)), plus(rest2, diagonal(end, nodes, c, 1))
        a11, a12, a22 = _products(a1, a2)
        b11, b12, b22 = _products(b1, b2)
        r11, r12, r22 = _products(rest1, rest2)
        size = math.sqrt(a11 * a22 - a12 * a12) + math.sqrt(b11 * b22 - b12 * b12)
        rest = math.sqrt(r11 * r22 - r12 * r12)
        g11, g12, g22 = 0.5 * (a11 + b11), 0.5 * (a12 + b12), 0.5 * (a22 + b22)
        stress = stiffness[c] * (0.5 * size / rest - 1.0) / size
        d1, d2 = times(0.5, plus(a1, b1)), times(0.5, plus(a2, b2))
        on_d1 = times(stress, less(times(g22, d1), times(g12, d2)))
        on_d2 = times(stress, less(times(g11, d2), times(g12, d1)))
        scatter(nodes, c, on_d1, on_d2, force)


@njit(cache=True, error_model="numpy")
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
    hessian = np.empty((4, 9))  # of (d1, d1), (d1, d2), (d2, d1), (d2, d2)
    for c in range(len(nodes)):
        _, area, size, d1, d2, normal = measure(u, nodes, diagonals, c)
        _of_diagonals(stiffness[c] / area, stress[c] / size, size, d1, d2, normal, hessian)
        add_blocks(hessian, nodes.shape[2], slots[c], blocks)


@njit(cache=True, error_model="numpy")
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
    hessian = np.empty((4, 9))
    for c in range(len(nodes)):
        strain, area, size, d1, d2, normal = measure(u, nodes, diagonals, c)
        turning = share * stiffness[c] * strain / size
        _of_diagonals(stiffness[c] / area, turning, size, d1, d2, normal, hessian)
        add_blocks(hessian, nodes.shape[2], slots[c], blocks)


@njit(cache=True, error_model="numpy")
def _of_diagonals(
    material: float,
    turning: float,
    size: float,
    d1: Vector,
    d2: Vector,
    normal: Vector,
    hessian: np.ndarray,
) -> None:
    """The tangent in the diagonals, from k/a0 and τ/|c|."""
    turning *= 0.5
    along = material - 4.0 * turning
    g1, g2 = gradients(d1, d2, normal)
    g11, g12, g22 = _products(d1, d2)
    outer_sum(along, g1, g1, -turning, d2, d2, turning * g22, hessian[0])
    outer_sum(along, g1, g2, turning, d1, d2, -turning * g12, hessian[1])
    outer_sum(along, g2, g2, -turning, d1, d1, turning * g11, hessian[3])
    x, y, z = times(turning * size, normal)
    hessian[1, 5] += x
    hessian[1, 7] -= x
    hessian[1, 6] += y
    hessian[1, 2] -= y
    hessian[1, 1] += z
    hessian[1, 3] -= z
    for q in range(3):
        for r in range(3):
            hessian[2, 3 * r + q] = hessian[1, 3 * q + r]


@njit(cache=True, error_model="numpy")
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
