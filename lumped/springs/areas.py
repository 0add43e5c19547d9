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
def _cross(a, b, out):
    out[0] = a[1] * b[2] - a[2] * b[1]
    out[1] = a[2] * b[0] - a[0] * b[2]
    out[2] = a[0] * b[1] - a[1] * b[0]


@njit(cache=True)
def _diagonals(u, nodes, c, change):
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
def _geometry(u, nodes, diagonals, c, change, current, normal, gradient, work):
    """Relative area change, rest area, |c|; fills normal (3,) and gradient (2, 3) = ∂a/∂d1, ∂a/∂d2."""
    _diagonals(u, nodes, c, change)
    d1, d2 = diagonals[c, 0], diagonals[c, 1]
    for q in range(3):
        current[0, q] = d1[q] + change[0, q]
        current[1, q] = d2[q] + change[1, q]
    _cross(current[0], current[1], normal)
    size = math.sqrt(normal[0] ** 2 + normal[1] ** 2 + normal[2] ** 2)
    rest_x, rest_y, rest_z = (
        d1[1] * d2[2] - d1[2] * d2[1],
        d1[2] * d2[0] - d1[0] * d2[2],
        d1[0] * d2[1] - d1[1] * d2[0],
    )
    rest = math.sqrt(rest_x**2 + rest_y**2 + rest_z**2)
    # |c| − |c0| = (2 c0·δ + δ·δ)/(|c| + |c0|) with δ = δd1 × d2 + current d1 × δd2: no digits lost
    _cross(change[0], d2, work)
    dx, dy, dz = work[0], work[1], work[2]
    _cross(current[0], change[1], work)
    dx, dy, dz = dx + work[0], dy + work[1], dz + work[2]
    growth = 2.0 * (rest_x * dx + rest_y * dy + rest_z * dz) + dx * dx + dy * dy + dz * dz
    strain = growth / (size + rest) / rest
    for q in range(3):
        normal[q] /= size
    _cross(current[1], normal, gradient[0])
    _cross(normal, current[0], gradient[1])
    for q in range(3):
        gradient[0, q] *= 0.5
        gradient[1, q] *= 0.5
    return strain, 0.5 * rest, size


@njit(cache=True)
def stresses(u: np.ndarray, nodes, diagonals, stiffness) -> np.ndarray:
    """Stress k (a/a0 − 1) of every cell, (c,) [N/m]."""
    change, current, gradient = np.empty((2, 3)), np.empty((2, 3)), np.empty((2, 3))
    normal, work = np.empty(3), np.empty(3)
    out = np.empty(len(nodes))
    for c in range(len(nodes)):
        strain, _, _ = _geometry(u, nodes, diagonals, c, change, current, normal, gradient, work)
        out[c] = stiffness[c] * strain
    return out


@njit(cache=True)
def extrapolated_stresses(u, step, nodes, diagonals, stiffness) -> np.ndarray:
    """Stresses that the linearisation at u predicts after `step` (n, 3) [m]; (c,) [N/m]."""
    change, current, gradient = np.empty((2, 3)), np.empty((2, 3)), np.empty((2, 3))
    normal, work = np.empty(3), np.empty(3)
    out = np.empty(len(nodes))
    for c in range(len(nodes)):
        strain, area, _ = _geometry(u, nodes, diagonals, c, change, current, normal, gradient, work)
        _diagonals(step, nodes, c, change)
        growth = 0.0
        for q in range(3):
            growth += gradient[0, q] * change[0, q] + gradient[1, q] * change[1, q]
        out[c] = stiffness[c] * (strain + growth / area)
    return out


@njit(cache=True)
def add_forces(u, nodes, diagonals, stiffness, force) -> float:
    """Add the internal force to `force` (n, 3) [N]; returns the energy [J]."""
    change, current, gradient = np.empty((2, 3)), np.empty((2, 3)), np.empty((2, 3))
    normal, work = np.empty(3), np.empty(3)
    p = nodes.shape[2]
    energy = 0.0
    for c in range(len(nodes)):
        strain, area, _ = _geometry(u, nodes, diagonals, c, change, current, normal, gradient, work)
        stress = stiffness[c] * strain
        energy += 0.5 * stress * strain * area
        for q in range(3):
            first, second = stress * gradient[0, q] / p, stress * gradient[1, q] / p
            for s in range(p):
                force[nodes[c, 0, s], q] -= first
                force[nodes[c, 2, s], q] += first
                force[nodes[c, 1, s], q] -= second
                force[nodes[c, 3, s], q] += second
    return energy


@njit(cache=True)
def add_tangent(u, nodes, diagonals, stiffness, stress, slots, blocks) -> None:
    """Add (k/a0) ∇a ∇aᵀ + τ ∇²a of every cell to the 3×3 blocks."""
    change, current, gradient = np.empty((2, 3)), np.empty((2, 3)), np.empty((2, 3))
    normal, work = np.empty(3), np.empty(3)
    p = nodes.shape[2]
    hessian = np.empty((2, 3, 2, 3))  # in (δd1, δd2)
    spin = np.empty((2, 3, 3))  # δc = spin[0] δd1 + spin[1] δd2
    for c in range(len(nodes)):
        _, area, size = _geometry(u, nodes, diagonals, c, change, current, normal, gradient, work)
        for q in range(3):
            for r in range(3):
                spin[0, q, r] = spin[1, q, r] = 0.0
        for d, sign in ((0, 1.0), (1, -1.0)):  # −[d2]× and [d1]×
            v = current[1 - d]
            spin[d, 0, 1], spin[d, 0, 2] = sign * v[2], -sign * v[1]
            spin[d, 1, 0], spin[d, 1, 2] = -sign * v[2], sign * v[0]
            spin[d, 2, 0], spin[d, 2, 1] = sign * v[1], -sign * v[0]
        material, geometric = stiffness[c] / area, 0.5 * stress[c]
        for d in range(2):
            for q in range(3):
                for e in range(2):
                    for r in range(3):
                        turn = 0.0
                        for s in range(3):
                            turn += spin[d, s, q] * spin[e, s, r]
                        # spin[d]ᵀ n = 2 gradient[d], since ∂a/∂d = ½ spin[d]ᵀ n
                        turn -= 4.0 * gradient[d, q] * gradient[e, r]
                        hessian[d, q, e, r] = (
                            material * gradient[d, q] * gradient[e, r] + geometric * turn / size
                        )
        # n·(δd1 × δd2) couples the diagonals by −[n]×
        hessian[0, 0, 1, 1] += geometric * normal[2]
        hessian[0, 1, 1, 0] -= geometric * normal[2]
        hessian[0, 1, 1, 2] += geometric * normal[0]
        hessian[0, 2, 1, 1] -= geometric * normal[0]
        hessian[0, 2, 1, 0] += geometric * normal[1]
        hessian[0, 0, 1, 2] -= geometric * normal[1]
        for q in range(3):
            for r in range(3):
                hessian[1, r, 0, q] = hessian[0, q, 1, r]
        for corner in range(4):
            d, sign = corner % 2, -1.0 if corner < 2 else 1.0
            for other in range(4):
                e, scale = other % 2, sign * (-1.0 if other < 2 else 1.0) / (p * p)
                for s in range(p):
                    for t in range(p):
                        slot = slots[c, corner * p + s, other * p + t]
                        for q in range(3):
                            for r in range(3):
                                blocks[slot, q, r] += scale * hessian[d, q, e, r]
