"""Area and strain springs and their dampers by tiles: the forces of `lumped.springs.areas` and `strains`.

Both are functions of a cell's mean sides a and b alone, d1 = a + b and d2 = b − a its diagonals: its area is
|c| with c = a × b, its strains are products of a and b. With n = c/|c|,

    ∂|c|/∂a = b × n,   ∂|c|/∂b = n × a,   |c|˙ = n·(ȧ × b + a × ḃ).

Rows of a tile: changes of a and b (0 to 5) and their velocities (6 to 11) in, forces on a and b (12 to 17)
out. Rows of rest data: a, b, |c| (0 to 6), k/|c| and c/|c| of the area (7, 8), 1/a², 1/b², 1/ab (9 to 11),
and k ab and c ab of the three strains (12 to 14, 15 to 17). A place without a cell is a unit square without
stiffness.
"""

from __future__ import annotations

import math

import numpy as np
from numba import njit

from lumped.springs.tiles import OPTIONS, ROWS

(R0, R1, R2, R3, R4, R5, R6, R7, R8, R9, R10, R11, R12, R13, R14, R15, R16, R17) = ROWS[:18]
DATA = 18  # rows of rest data
HALF, TINY = 0.5, 1e-36


@njit(**OPTIONS)
def gather_sides(
    x: np.ndarray, c0: int, c1: int, c2: int, c3: int, row: int, count: int, tile: np.ndarray
) -> None:
    """One component of a and of b from the corners', into rows `row` and three below."""
    half, below = x.dtype.type(HALF), row + R3
    for i in range(count):
        first, second = x[c2 + i] - x[c0 + i], x[c3 + i] - x[c1 + i]
        tile[row + i] = half * (first - second)
        tile[below + i] = half * (first + second)


@njit(**OPTIONS)
def spread_sides(
    tile: np.ndarray, row: int, c0: int, c1: int, c2: int, c3: int, count: int, force: np.ndarray
) -> None:
    """Add one component of the forces on a and b, rows `row` and three below, to the corners'."""
    half, below = tile.dtype.type(HALF), row + R3
    for i in range(count):
        a, b = tile[row + i], tile[below + i]
        tile[row + i] = half * (a + b)
        tile[below + i] = half * (a - b)
    for i in range(count):
        force[c0 + i] -= tile[row + i]
    for i in range(count):
        force[c2 + i] += tile[row + i]
    for i in range(count):
        force[c1 + i] += tile[below + i]
    for i in range(count):
        force[c3 + i] -= tile[below + i]


@njit(**OPTIONS)
def area_forces(
    rest: np.ndarray, t: int, tile: np.ndarray, count: int, elastic: bool, damped: bool
) -> tuple[float, float]:
    """Forces on the sides, of the springs if elastic and of the dampers if damped, in place of what stood
    there; energy, and power taken."""
    energy, power = rest.dtype.type(0.0), rest.dtype.type(0.0)
    one, tiny = rest.dtype.type(1.0), rest.dtype.type(TINY)
    for i in range(count):
        ax, ay, az = rest[t + i], rest[t + R1 + i], rest[t + R2 + i]
        bx, by, bz = rest[t + R3 + i], rest[t + R4 + i], rest[t + R5 + i]
        ux, uy, uz = tile[i], tile[R1 + i], tile[R2 + i]
        wx, wy, wz = tile[R3 + i], tile[R4 + i], tile[R5 + i]
        ox, oy, oz = ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx  # c at rest
        gx, gy, gz = uy * bz - uz * by, uz * bx - ux * bz, ux * by - uy * bx  # δa × b at rest
        ax, ay, az = ax + ux, ay + uy, az + uz
        gx, gy, gz = gx + (ay * wz - az * wy), gy + (az * wx - ax * wz), gz + (ax * wy - ay * wx)
        bx, by, bz = bx + wx, by + wy, bz + wz
        cx, cy, cz = ox + gx, oy + gy, oz + gz
        size = math.sqrt(cx * cx + cy * cy + cz * cz + tiny)
        both = size + rest[t + R6 + i]
        inverse = one / (both * size)
        turn = both * inverse
        nx, ny, nz = cx * turn, cy * turn, cz * turn
        stress = rest.dtype.type(0.0)
        if elastic:
            along = ox * gx + oy * gy + oz * gz
            gained = along + along + (gx * gx + gy * gy + gz * gz)  # |c|² less that at rest, no digits lost
            growth = gained * inverse * size
            stress = rest[t + R7 + i] * growth
            energy += stress * growth
        if damped:
            vx, vy, vz = tile[R6 + i], tile[R7 + i], tile[R8 + i]
            qx, qy, qz = tile[R9 + i], tile[R10 + i], tile[R11 + i]
            rate = nx * (vy * bz - vz * by + ay * qz - az * qy)
            rate += ny * (vz * bx - vx * bz + az * qx - ax * qz)
            rate += nz * (vx * by - vy * bx + ax * qy - ay * qx)
            resisting = rest[t + R8 + i] * rate
            power += resisting * rate
            stress += resisting
        nx, ny, nz = stress * nx, stress * ny, stress * nz
        tile[R12 + i], tile[R13 + i], tile[R14 + i] = by * nz - bz * ny, bz * nx - bx * nz, bx * ny - by * nx
        tile[R15 + i], tile[R16 + i], tile[R17 + i] = ny * az - nz * ay, nz * ax - nx * az, nx * ay - ny * ax
    return 0.5 * energy, 1.0 * power


@njit(**OPTIONS)
def add_strain_forces(
    rest: np.ndarray, t: int, tile: np.ndarray, count: int, elastic: bool, damped: bool
) -> tuple[float, float]:
    """Add to the forces on the sides, those of the springs if elastic and of the dampers if damped; energy,
    and power taken."""
    energy, power = rest.dtype.type(0.0), rest.dtype.type(0.0)
    half = rest.dtype.type(HALF)
    for i in range(count):
        ax, ay, az = rest[t + i], rest[t + R1 + i], rest[t + R2 + i]
        bx, by, bz = rest[t + R3 + i], rest[t + R4 + i], rest[t + R5 + i]
        ux, uy, uz = tile[i], tile[R1 + i], tile[R2 + i]
        wx, wy, wz = tile[R3 + i], tile[R4 + i], tile[R5 + i]
        by_a, by_b, by_ab = rest[t + R9 + i], rest[t + R10 + i], rest[t + R11 + i]
        shear = ux * bx + uy * by + uz * bz
        first = (ax * ux + ay * uy + az * uz) + half * (ux * ux + uy * uy + uz * uz)
        second = (bx * wx + by * wy + bz * wz) + half * (wx * wx + wy * wy + wz * wz)
        ax, ay, az = ax + ux, ay + uy, az + uz
        bx, by, bz = bx + wx, by + wy, bz + wz
        t1 = t2 = t3 = rest.dtype.type(0.0)
        if elastic:
            shear = (shear + (ax * wx + ay * wy + az * wz)) * by_ab  # a·b is zero at rest: no digits lost
            first, second = first * by_a, second * by_b
            t1, t2, t3 = rest[t + R12 + i] * first, rest[t + R13 + i] * second, rest[t + R14 + i] * shear
            energy += t1 * first + t2 * second + t3 * shear
        if damped:
            vx, vy, vz = tile[R6 + i], tile[R7 + i], tile[R8 + i]
            qx, qy, qz = tile[R9 + i], tile[R10 + i], tile[R11 + i]
            r1 = (ax * vx + ay * vy + az * vz) * by_a
            r2 = (bx * qx + by * qy + bz * qz) * by_b
            r3 = (bx * vx + by * vy + bz * vz + ax * qx + ay * qy + az * qz) * by_ab
            s1, s2, s3 = rest[t + R15 + i] * r1, rest[t + R16 + i] * r2, rest[t + R17 + i] * r3
            power += s1 * r1 + s2 * r2 + s3 * r3
            t1, t2, t3 = t1 + s1, t2 + s2, t3 + s3
        t1, t2, t3 = t1 * by_a, t2 * by_b, t3 * by_ab
        tile[R12 + i] += t1 * ax + t3 * bx
        tile[R13 + i] += t1 * ay + t3 * by
        tile[R14 + i] += t1 * az + t3 * bz
        tile[R15 + i] += t2 * bx + t3 * ax
        tile[R16 + i] += t2 * by + t3 * ay
        tile[R17 + i] += t2 * bz + t3 * az
    return 0.5 * energy, 1.0 * power
