"""Links: energy, tension, force and tangent of linear springs between masses, as compiled loops.

A link of rest vector d0, rest length L, stiffness k and relative displacement du stores ½ k e², with
the elongation e = r − L written as (2 d0·du + du·du)/(r + L), which loses no digits when du is small.
Tension N = k e; force ± N n on its ends; tangent k n nᵀ + (N/r)(I − n nᵀ). The tangent takes N as an
argument of its own so that a solver may put in the extrapolated tension of Magisano, Leonetti and
Garcea (2017) or its positive part. The average force over a step depends on positions through scalar products
only, which conserves momentum, and its quotient cannot vanish below.

Arrays: displacement (n, 3) [m]; nodes (m, 2); offset (m, 3) [m]; rest_length (m,) [m]; stiffness (m,) [N/m];
tension (m,) [N]; slots (m, 4) block numbers aa, ab, ba, bb; blocks (b, 3, 3) [N/m], added to.
"""

from __future__ import annotations

import math

import numpy as np
from numba import njit


@njit(cache=True, inline="always")
def stretch(
    u: np.ndarray, nodes: np.ndarray, offset: np.ndarray, rest_length: np.ndarray, m: int
) -> tuple[float, float, float, float, float]:
    """Elongation, current length and unit vector of link m."""
    a, b = nodes[m, 0], nodes[m, 1]
    dx, dy, dz = u[b, 0] - u[a, 0], u[b, 1] - u[a, 1], u[b, 2] - u[a, 2]
    rx, ry, rz = offset[m, 0] + dx, offset[m, 1] + dy, offset[m, 2] + dz
    length = math.sqrt(rx * rx + ry * ry + rz * rz)
    along = offset[m, 0] * dx + offset[m, 1] * dy + offset[m, 2] * dz
    # not 2.0 * along: the literal would turn single precision into double
    elongation = (along + along + dx * dx + dy * dy + dz * dz) / (length + rest_length[m])
    return elongation, length, rx / length, ry / length, rz / length


@njit(cache=True)
def stresses(
    u: np.ndarray, nodes: np.ndarray, offset: np.ndarray, rest_length: np.ndarray, stiffness: np.ndarray
) -> np.ndarray:
    """Tension of every link, (m,) [N]."""
    out = np.empty(len(nodes))
    for m in range(len(nodes)):
        out[m] = stiffness[m] * stretch(u, nodes, offset, rest_length, m)[0]
    return out


@njit(cache=True)
def along(v: np.ndarray, a: int, b: int, nx: float, ny: float, nz: float) -> float:
    """n·(v_b − v_a), how fast b leaves a along the unit vector n."""
    return nx * (v[b, 0] - v[a, 0]) + ny * (v[b, 1] - v[a, 1]) + nz * (v[b, 2] - v[a, 2])


@njit(cache=True)
def rates(
    u: np.ndarray,
    v: np.ndarray,
    nodes: np.ndarray,
    offset: np.ndarray,
    rest_length: np.ndarray,
    stiffness: np.ndarray,
) -> np.ndarray:
    """Rates k n·v of the tensions as the ends move with v (n, 3), (m,) [N per unit of v's time]."""
    out = np.empty(len(nodes))
    for m in range(len(nodes)):
        a, b = nodes[m, 0], nodes[m, 1]
        _, _, nx, ny, nz = stretch(u, nodes, offset, rest_length, m)
        out[m] = stiffness[m] * along(v, a, b, nx, ny, nz)
    return out


@njit(cache=True)
def extrapolated(
    u: np.ndarray,
    v: np.ndarray,
    nodes: np.ndarray,
    offset: np.ndarray,
    rest_length: np.ndarray,
    stiffness: np.ndarray,
) -> np.ndarray:
    """Tensions that the linearisation at u predicts after a step v (n, 3) [m], (m,) [N]."""
    out = np.empty(len(nodes))
    for m in range(len(nodes)):
        a, b = nodes[m, 0], nodes[m, 1]
        elongation, _, nx, ny, nz = stretch(u, nodes, offset, rest_length, m)
        out[m] = stiffness[m] * (elongation + along(v, a, b, nx, ny, nz))
    return out


@njit(cache=True)
def add_forces(
    u: np.ndarray,
    nodes: np.ndarray,
    offset: np.ndarray,
    rest_length: np.ndarray,
    stiffness: np.ndarray,
    force: np.ndarray,
) -> float:
    """Add the internal force (gradient of the energy) to `force` (n, 3) [N]; returns the energy [J]."""
    energy = 0.0
    for m in range(len(nodes)):
        a, b = nodes[m, 0], nodes[m, 1]
        e, _, nx, ny, nz = stretch(u, nodes, offset, rest_length, m)
        tension = stiffness[m] * e
        energy += 0.5 * tension * e
        force[a, 0] -= tension * nx
        force[a, 1] -= tension * ny
        force[a, 2] -= tension * nz
        force[b, 0] += tension * nx
        force[b, 1] += tension * ny
        force[b, 2] += tension * nz
    return energy


@njit(cache=True)
def add_average_forces(
    start: np.ndarray,
    end: np.ndarray,
    nodes: np.ndarray,
    offset: np.ndarray,
    rest_length: np.ndarray,
    stiffness: np.ndarray,
    force: np.ndarray,
) -> None:
    """Add the force over a step from `start` to `end` (n, 3) [m] whose work is the energy stored in it:

    k (e0 + e1)/(l0 + l1) r̄, with r̄ the mean of relative positions, since l1² − l0² = 2 r̄·Δr and
    ½ k (e1² − e0²) = force·Δr (Simo and Tarnow 1992, Gonzalez 1996).
    """
    for m in range(len(nodes)):
        a, b = nodes[m, 0], nodes[m, 1]
        e0, l0, _, _, _ = stretch(start, nodes, offset, rest_length, m)
        e1, l1, _, _, _ = stretch(end, nodes, offset, rest_length, m)
        pull = stiffness[m] * (e0 + e1) / (l0 + l1)
        for q in range(3):
            mean = offset[m, q] + 0.5 * (start[b, q] - start[a, q] + end[b, q] - end[a, q])
            force[a, q] -= pull * mean
            force[b, q] += pull * mean


@njit(cache=True)
def add_tangent(
    u: np.ndarray,
    nodes: np.ndarray,
    offset: np.ndarray,
    rest_length: np.ndarray,
    stiffness: np.ndarray,
    tension: np.ndarray,
    slots: np.ndarray,
    blocks: np.ndarray,
) -> None:
    """Add k n nᵀ + (N/r)(I − n nᵀ) of every link to the 3×3 blocks."""
    flat = blocks.reshape(-1, 9)
    for m in range(len(nodes)):
        _, length, x, y, z = stretch(u, nodes, offset, rest_length, m)
        _add_blocks(flat, slots, m, stiffness[m], tension[m] / length, x, y, z)


@njit(cache=True)
def add_own_tangent(
    u: np.ndarray,
    nodes: np.ndarray,
    offset: np.ndarray,
    rest_length: np.ndarray,
    stiffness: np.ndarray,
    share: float,
    slots: np.ndarray,
    blocks: np.ndarray,
) -> None:
    """The same with this share of the tensions at u."""
    flat = blocks.reshape(-1, 9)
    for m in range(len(nodes)):
        elongation, length, x, y, z = stretch(u, nodes, offset, rest_length, m)
        _add_blocks(flat, slots, m, stiffness[m], share * stiffness[m] * elongation / length, x, y, z)


@njit(cache=True)
def _add_blocks(
    flat: np.ndarray, slots: np.ndarray, m: int, stiffness: float, across: float, x: float, y: float, z: float
) -> None:
    """Add the blocks of link m, of unit vector (x, y, z) and N/r across it."""
    along = stiffness - across
    xx, xy, xz = along * x * x + across, along * x * y, along * x * z
    yy, yz, zz = along * y * y + across, along * y * z, along * z * z + across
    for e in range(4):
        block = flat[np.uint64(slots[m, e])]
        sign = 1.0 if e == 0 or e == 3 else -1.0
        block[0] += sign * xx
        block[1] += sign * xy
        block[2] += sign * xz
        block[3] += sign * xy
        block[4] += sign * yy
        block[5] += sign * yz
        block[6] += sign * xz
        block[7] += sign * yz
        block[8] += sign * zz
