"""Area and strain springs and their dampers by tiles: the forces of `lumped.springs.areas` and `strains`.

Both are functions of a cell's mean sides a and b alone, d1 = a + b and d2 = b − a its diagonals: its area is
|c| with c = a × b, its strains are products of a and b. With n = c/|c|,

    ∂|c|/∂a = b × n,   ∂|c|/∂b = n × a.

Rows of a tile: changes of a and b, or their velocities (0 to 5), and the forces on a and b (6 to 11). Rows of
rest data: a, b, |c| (0 to 6), k/|c| and c/|c| of the area (7, 8), 1/a², 1/b², 1/ab (9 to 11), and k ab and c
ab of the three strains (12 to 14, 15 to 17). Kept of every cell: both derivatives, and where there are strain
springs a and b. A place without a cell is a unit square without stiffness.
"""

from __future__ import annotations

import math

import numpy as np
from numba import njit

from lumped.springs.memory import FORCE_X, FORCE_Y, FORCE_Z, GIVEN, KEPT, ROW, load, store
from lumped.springs.tiles import LANES, OPTIONS, ROWS

(R0, R1, R2, R3, R4, R5, R6, R7, R8, R9, R10, R11, R12, R13, R14, R15, R16, R17) = ROWS[:18]
DATA, USED = 18, 12  # rows of rest data, and of a tile
AREA_SHAPE, STRAIN_SHAPE = 6, 6  # rows of what is kept
HALF, TINY = 0.5, 1e-36


@njit(**OPTIONS)
def gather_sides(
    x: np.ndarray, c0: int, c1: int, c2: int, c3: int, size: int, blocks: int, tile: np.ndarray
) -> None:
    """a and b from the corners' x, into the first rows."""
    half, past = x.dtype.type(HALF), size + size
    for i in range(blocks * LANES):
        fx = load(GIVEN, x, c2 + i) - load(GIVEN, x, c0 + i)
        sx = load(GIVEN, x, c3 + i) - load(GIVEN, x, c1 + i)
        fy = load(GIVEN, x, c2 + size + i) - load(GIVEN, x, c0 + size + i)
        sy = load(GIVEN, x, c3 + size + i) - load(GIVEN, x, c1 + size + i)
        fz = load(GIVEN, x, c2 + past + i) - load(GIVEN, x, c0 + past + i)
        sz = load(GIVEN, x, c3 + past + i) - load(GIVEN, x, c1 + past + i)
        store(ROW, tile, R0 + i, half * (fx - sx))
        store(ROW, tile, R1 + i, half * (fy - sy))
        store(ROW, tile, R2 + i, half * (fz - sz))
        store(ROW, tile, R3 + i, half * (fx + sx))
        store(ROW, tile, R4 + i, half * (fy + sy))
        store(ROW, tile, R5 + i, half * (fz + sz))


@njit(**OPTIONS)
def push_corner(
    on_a: float, on_b: float, corner: int, size: int, blocks: int, tile: np.ndarray, force: np.ndarray
) -> None:
    """Add on_a and on_b (±½) of the forces on the sides to those on one corner."""
    y, z = corner + size, corner + size + size
    p, q = tile.dtype.type(on_a), tile.dtype.type(on_b)
    for i in range(blocks * LANES):
        x_ = p * load(ROW, tile, R6 + i) + q * load(ROW, tile, R9 + i)
        y_ = p * load(ROW, tile, R7 + i) + q * load(ROW, tile, R10 + i)
        z_ = p * load(ROW, tile, R8 + i) + q * load(ROW, tile, R11 + i)
        store(FORCE_X, force, corner + i, load(FORCE_X, force, corner + i) + x_)
        store(FORCE_Y, force, y + i, load(FORCE_Y, force, y + i) + y_)
        store(FORCE_Z, force, z + i, load(FORCE_Z, force, z + i) + z_)


@njit(**OPTIONS)
def stretch_areas(share: float, rest: np.ndarray, t: int, blocks: int, tile: np.ndarray, at: int) -> float:
    """Keep the derivatives, and put this share of the springs' forces in the rows of forces; the energy."""
    energy = rest.dtype.type(0.0)
    one, tiny, part = rest.dtype.type(1.0), rest.dtype.type(TINY), rest.dtype.type(share)
    for i in range(blocks * LANES):
        ax, ay, az = load(GIVEN, rest, t + i), load(GIVEN, rest, t + R1 + i), load(GIVEN, rest, t + R2 + i)
        bx, by, bz = (
            load(GIVEN, rest, t + R3 + i),
            load(GIVEN, rest, t + R4 + i),
            load(GIVEN, rest, t + R5 + i),
        )
        ux, uy, uz = load(ROW, tile, R0 + i), load(ROW, tile, R1 + i), load(ROW, tile, R2 + i)
        wx, wy, wz = load(ROW, tile, R3 + i), load(ROW, tile, R4 + i), load(ROW, tile, R5 + i)
        ox, oy, oz = ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx  # c at rest
        gx, gy, gz = uy * bz - uz * by, uz * bx - ux * bz, ux * by - uy * bx  # δa × b at rest
        ax, ay, az = ax + ux, ay + uy, az + uz
        gx, gy, gz = gx + (ay * wz - az * wy), gy + (az * wx - ax * wz), gz + (ax * wy - ay * wx)
        bx, by, bz = bx + wx, by + wy, bz + wz
        cx, cy, cz = ox + gx, oy + gy, oz + gz
        size = math.sqrt(cx * cx + cy * cy + cz * cz + tiny)
        both = size + load(GIVEN, rest, t + R6 + i)
        inverse = one / (both * size)
        turn = both * inverse
        nx, ny, nz = cx * turn, cy * turn, cz * turn
        along = ox * gx + oy * gy + oz * gz
        gained = along + along + (gx * gx + gy * gy + gz * gz)  # |c|² less that at rest, no digits lost
        growth = gained * (inverse * size)
        stress = part * load(GIVEN, rest, t + R7 + i) * growth
        energy += stress * growth
        px, py, pz = by * nz - bz * ny, bz * nx - bx * nz, bx * ny - by * nx
        qx, qy, qz = ny * az - nz * ay, nz * ax - nx * az, nx * ay - ny * ax
        store(KEPT, tile, at + i, px)
        store(KEPT, tile, at + R1 + i, py)
        store(KEPT, tile, at + R2 + i, pz)
        store(KEPT, tile, at + R3 + i, qx)
        store(KEPT, tile, at + R4 + i, qy)
        store(KEPT, tile, at + R5 + i, qz)
        store(ROW, tile, R6 + i, stress * px)
        store(ROW, tile, R7 + i, stress * py)
        store(ROW, tile, R8 + i, stress * pz)
        store(ROW, tile, R9 + i, stress * qx)
        store(ROW, tile, R10 + i, stress * qy)
        store(ROW, tile, R11 + i, stress * qz)
    return 0.5 * energy


@njit(**OPTIONS)
def resist_areas(rest: np.ndarray, t: int, blocks: int, tile: np.ndarray, at: int) -> float:
    """Add the forces of the dampers to the rows of forces; the power taken."""
    power = rest.dtype.type(0.0)
    for i in range(blocks * LANES):
        px, py, pz = load(KEPT, tile, at + i), load(KEPT, tile, at + R1 + i), load(KEPT, tile, at + R2 + i)
        qx, qy, qz = (
            load(KEPT, tile, at + R3 + i),
            load(KEPT, tile, at + R4 + i),
            load(KEPT, tile, at + R5 + i),
        )
        rate = px * load(ROW, tile, R0 + i) + py * load(ROW, tile, R1 + i) + pz * load(ROW, tile, R2 + i)
        rate += qx * load(ROW, tile, R3 + i) + qy * load(ROW, tile, R4 + i) + qz * load(ROW, tile, R5 + i)
        resisting = load(GIVEN, rest, t + R8 + i) * rate
        power += resisting * rate
        store(ROW, tile, R6 + i, load(ROW, tile, R6 + i) + resisting * px)
        store(ROW, tile, R7 + i, load(ROW, tile, R7 + i) + resisting * py)
        store(ROW, tile, R8 + i, load(ROW, tile, R8 + i) + resisting * pz)
        store(ROW, tile, R9 + i, load(ROW, tile, R9 + i) + resisting * qx)
        store(ROW, tile, R10 + i, load(ROW, tile, R10 + i) + resisting * qy)
        store(ROW, tile, R11 + i, load(ROW, tile, R11 + i) + resisting * qz)
    return 1.0 * power


@njit(**OPTIONS)
def stretch_strains(share: float, rest: np.ndarray, t: int, blocks: int, tile: np.ndarray, at: int) -> float:
    """Keep the sides, and add this share of the springs' forces to the rows of forces; the energy."""
    energy = rest.dtype.type(0.0)
    half, part = rest.dtype.type(HALF), rest.dtype.type(share)
    for i in range(blocks * LANES):
        ax, ay, az = load(GIVEN, rest, t + i), load(GIVEN, rest, t + R1 + i), load(GIVEN, rest, t + R2 + i)
        bx, by, bz = (
            load(GIVEN, rest, t + R3 + i),
            load(GIVEN, rest, t + R4 + i),
            load(GIVEN, rest, t + R5 + i),
        )
        ux, uy, uz = load(ROW, tile, R0 + i), load(ROW, tile, R1 + i), load(ROW, tile, R2 + i)
        wx, wy, wz = load(ROW, tile, R3 + i), load(ROW, tile, R4 + i), load(ROW, tile, R5 + i)
        by_a, by_b, by_ab = (
            load(GIVEN, rest, t + R9 + i),
            load(GIVEN, rest, t + R10 + i),
            load(GIVEN, rest, t + R11 + i),
        )
        shear = ux * bx + uy * by + uz * bz
        first = by_a * ((ax * ux + ay * uy + az * uz) + half * (ux * ux + uy * uy + uz * uz))
        second = by_b * ((bx * wx + by * wy + bz * wz) + half * (wx * wx + wy * wy + wz * wz))
        ax, ay, az = ax + ux, ay + uy, az + uz
        bx, by, bz = bx + wx, by + wy, bz + wz
        shear = (shear + (ax * wx + ay * wy + az * wz)) * by_ab  # a·b is zero at rest: no digits lost
        t1 = part * load(GIVEN, rest, t + R12 + i) * first
        t2 = part * load(GIVEN, rest, t + R13 + i) * second
        t3 = part * load(GIVEN, rest, t + R14 + i) * shear
        energy += t1 * first + t2 * second + t3 * shear
        t1, t2, t3 = t1 * by_a, t2 * by_b, t3 * by_ab
        store(KEPT, tile, at + i, ax)
        store(KEPT, tile, at + R1 + i, ay)
        store(KEPT, tile, at + R2 + i, az)
        store(KEPT, tile, at + R3 + i, bx)
        store(KEPT, tile, at + R4 + i, by)
        store(KEPT, tile, at + R5 + i, bz)
        store(ROW, tile, R6 + i, load(ROW, tile, R6 + i) + (t1 * ax + t3 * bx))
        store(ROW, tile, R7 + i, load(ROW, tile, R7 + i) + (t1 * ay + t3 * by))
        store(ROW, tile, R8 + i, load(ROW, tile, R8 + i) + (t1 * az + t3 * bz))
        store(ROW, tile, R9 + i, load(ROW, tile, R9 + i) + (t2 * bx + t3 * ax))
        store(ROW, tile, R10 + i, load(ROW, tile, R10 + i) + (t2 * by + t3 * ay))
        store(ROW, tile, R11 + i, load(ROW, tile, R11 + i) + (t2 * bz + t3 * az))
    return 0.5 * energy


@njit(**OPTIONS)
def resist_strains(rest: np.ndarray, t: int, blocks: int, tile: np.ndarray, at: int) -> float:
    """Add the forces of the dampers to the rows of forces; the power taken."""
    power = rest.dtype.type(0.0)
    for i in range(blocks * LANES):
        ax, ay, az = load(KEPT, tile, at + i), load(KEPT, tile, at + R1 + i), load(KEPT, tile, at + R2 + i)
        bx, by, bz = (
            load(KEPT, tile, at + R3 + i),
            load(KEPT, tile, at + R4 + i),
            load(KEPT, tile, at + R5 + i),
        )
        vx, vy, vz = load(ROW, tile, R0 + i), load(ROW, tile, R1 + i), load(ROW, tile, R2 + i)
        qx, qy, qz = load(ROW, tile, R3 + i), load(ROW, tile, R4 + i), load(ROW, tile, R5 + i)
        by_a, by_b, by_ab = (
            load(GIVEN, rest, t + R9 + i),
            load(GIVEN, rest, t + R10 + i),
            load(GIVEN, rest, t + R11 + i),
        )
        r1 = (ax * vx + ay * vy + az * vz) * by_a
        r2 = (bx * qx + by * qy + bz * qz) * by_b
        r3 = (bx * vx + by * vy + bz * vz + ax * qx + ay * qy + az * qz) * by_ab
        s1 = load(GIVEN, rest, t + R15 + i) * r1
        s2 = load(GIVEN, rest, t + R16 + i) * r2
        s3 = load(GIVEN, rest, t + R17 + i) * r3
        power += s1 * r1 + s2 * r2 + s3 * r3
        s1, s2, s3 = s1 * by_a, s2 * by_b, s3 * by_ab
        store(ROW, tile, R6 + i, load(ROW, tile, R6 + i) + (s1 * ax + s3 * bx))
        store(ROW, tile, R7 + i, load(ROW, tile, R7 + i) + (s1 * ay + s3 * by))
        store(ROW, tile, R8 + i, load(ROW, tile, R8 + i) + (s1 * az + s3 * bz))
        store(ROW, tile, R9 + i, load(ROW, tile, R9 + i) + (s2 * bx + s3 * ax))
        store(ROW, tile, R10 + i, load(ROW, tile, R10 + i) + (s2 * by + s3 * ay))
        store(ROW, tile, R11 + i, load(ROW, tile, R11 + i) + (s2 * bz + s3 * az))
    return 1.0 * power
