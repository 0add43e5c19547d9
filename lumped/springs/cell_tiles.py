"""Springs and dampers of cells by tiles: the forces of `lumped.springs.cells`.

Rows of a tile: changes of the mean sides a and b, or their velocities (0 to 5), and the forces on a and b (6
to 11). Rows of rest data: a, b (0 to 5), a·a, b·b, a·b (6 to 8), the area (9), and the four constants of the
springs' law (10 to 13) and of the dampers' (14 to 17). Kept of every cell: a and b, and n/A of its area
(`lumped.springs.laws`). A place without a cell is a unit square without stiffness.
"""

from __future__ import annotations

import math

import numpy as np
from numba import njit

from lumped.springs.laws import area_and_strains
from lumped.springs.memory import FORCE_X, FORCE_Y, FORCE_Z, GIVEN, KEPT, ROW, load, store
from lumped.springs.tiles import LANES, OPTIONS, ROWS

(R0, R1, R2, R3, R4, R5, R6, R7, R8, R9, R10, R11, R12, R13, R14, R15, R16, R17) = ROWS[:18]
DATA, USED, SHAPE = 18, 18, 9  # rows of rest data, of a tile with those of `membrane_tiles`, of what is kept
HALF = 0.5


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
def stretch_cells(share: float, rest: np.ndarray, t: int, blocks: int, tile: np.ndarray, at: int) -> float:
    """Keep the shapes, and put this share of the springs' forces in the rows of forces; the energy."""
    energy = rest.dtype.type(0.0)
    half, part = rest.dtype.type(HALF), rest.dtype.type(share)
    for i in range(blocks * LANES):
        ax, ay, az = load(GIVEN, rest, t + i), load(GIVEN, rest, t + R1 + i), load(GIVEN, rest, t + R2 + i)
        bx, by, bz = (
            load(GIVEN, rest, t + R3 + i),
            load(GIVEN, rest, t + R4 + i),
            load(GIVEN, rest, t + R5 + i),
        )
        g1, g2, g3 = (
            load(GIVEN, rest, t + R6 + i),
            load(GIVEN, rest, t + R7 + i),
            load(GIVEN, rest, t + R8 + i),
        )
        ux, uy, uz = load(ROW, tile, R0 + i), load(ROW, tile, R1 + i), load(ROW, tile, R2 + i)
        wx, wy, wz = load(ROW, tile, R3 + i), load(ROW, tile, R4 + i), load(ROW, tile, R5 + i)
        d1 = (ax * ux + ay * uy + az * uz) + (ax * ux + ay * uy + az * uz) + (ux * ux + uy * uy + uz * uz)
        d2 = (bx * wx + by * wy + bz * wz) + (bx * wx + by * wy + bz * wz) + (wx * wx + wy * wy + wz * wz)
        d3 = ux * bx + uy * by + uz * bz
        ax, ay, az = ax + ux, ay + uy, az + uz
        d3 += ax * wx + ay * wy + az * wz
        bx, by, bz = bx + wx, by + wy, bz + wz
        k = (
            part * load(GIVEN, rest, t + R10 + i),
            part * load(GIVEN, rest, t + R11 + i),
            part * load(GIVEN, rest, t + R12 + i),
            part * load(GIVEN, rest, t + R13 + i),
        )
        stored, _, square, (s1, s2, s3) = area_and_strains(
            half, (d1, d2, d3), (g1, g2, g3), load(GIVEN, rest, t + R9 + i), k
        )
        energy += stored
        turn = rest.dtype.type(1.0) / math.sqrt(square)
        store(KEPT, tile, at + i, ax)
        store(KEPT, tile, at + R1 + i, ay)
        store(KEPT, tile, at + R2 + i, az)
        store(KEPT, tile, at + R3 + i, bx)
        store(KEPT, tile, at + R4 + i, by)
        store(KEPT, tile, at + R5 + i, bz)
        store(KEPT, tile, at + R6 + i, turn * (g2 + d2))
        store(KEPT, tile, at + R7 + i, turn * (g1 + d1))
        store(KEPT, tile, at + R8 + i, turn * (g3 + d3))
        s1, s2 = s1 + s1, s2 + s2
        store(ROW, tile, R6 + i, s1 * ax + s3 * bx)
        store(ROW, tile, R7 + i, s1 * ay + s3 * by)
        store(ROW, tile, R8 + i, s1 * az + s3 * bz)
        store(ROW, tile, R9 + i, s2 * bx + s3 * ax)
        store(ROW, tile, R10 + i, s2 * by + s3 * ay)
        store(ROW, tile, R11 + i, s2 * bz + s3 * az)
    return 1.0 * energy


@njit(**OPTIONS)
def resist_cells(rest: np.ndarray, t: int, blocks: int, tile: np.ndarray, at: int) -> float:
    """Add the forces of the dampers to the rows of forces; the power taken."""
    power = rest.dtype.type(0.0)
    for i in range(blocks * LANES):
        ax, ay, az = load(KEPT, tile, at + i), load(KEPT, tile, at + R1 + i), load(KEPT, tile, at + R2 + i)
        bx, by, bz = (
            load(KEPT, tile, at + R3 + i),
            load(KEPT, tile, at + R4 + i),
            load(KEPT, tile, at + R5 + i),
        )
        n1, n2, n3 = (
            load(KEPT, tile, at + R6 + i),
            load(KEPT, tile, at + R7 + i),
            load(KEPT, tile, at + R8 + i),
        )
        ux, uy, uz = load(ROW, tile, R0 + i), load(ROW, tile, R1 + i), load(ROW, tile, R2 + i)
        wx, wy, wz = load(ROW, tile, R3 + i), load(ROW, tile, R4 + i), load(ROW, tile, R5 + i)
        r1, r2 = ax * ux + ay * uy + az * uz, bx * wx + by * wy + bz * wz  # half the rates
        r3 = (ax * wx + ay * wy + az * wz) + (bx * ux + by * uy + bz * uz)
        growing = n1 * r1 + n2 * r2 - n3 * r3  # Ȧ
        pull = load(GIVEN, rest, t + R14 + i) * growing
        power += pull * growing
        r1, r2 = r1 + r1, r2 + r2
        s1 = load(GIVEN, rest, t + R15 + i) * r1
        s2 = load(GIVEN, rest, t + R16 + i) * r2
        s3 = load(GIVEN, rest, t + R17 + i) * r3
        power += s1 * r1 + s2 * r2 + s3 * r3
        s1, s2, s3 = s1 + s1 + pull * n1, s2 + s2 + pull * n2, s3 - pull * n3
        store(ROW, tile, R6 + i, load(ROW, tile, R6 + i) + (s1 * ax + s3 * bx))
        store(ROW, tile, R7 + i, load(ROW, tile, R7 + i) + (s1 * ay + s3 * by))
        store(ROW, tile, R8 + i, load(ROW, tile, R8 + i) + (s1 * az + s3 * bz))
        store(ROW, tile, R9 + i, load(ROW, tile, R9 + i) + (s2 * bx + s3 * ax))
        store(ROW, tile, R10 + i, load(ROW, tile, R10 + i) + (s2 * by + s3 * ay))
        store(ROW, tile, R11 + i, load(ROW, tile, R11 + i) + (s2 * bz + s3 * az))
    return 1.0 * power
