"""Springs and dampers of cells by tiles: the forces of `lumped.springs.cells`.

Rows of a tile: changes of the mean sides a and b, or their velocities (0 to 5), and the forces on a and b (6
to 11), of a law of s those on q (15 to 17). Rows of rest data: a, b (0 to 5), a·a, b·b, a·b (6 to 8), the
area (9), and four constants of the springs' law (10 to 13) and of the dampers' (14 to 17); of rubber
(`lumped.springs.rubber`) those are k₄ to k₇, and k₈ to k₁₂ are in more rows (18 to 22); of faces the first is
k₄. Kept of every cell: a and b, and n/A of its area (`lumped.springs.laws`). A place without a cell is a unit
square without stiffness.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numba import njit
from numba.extending import overload

from lumped.springs.cell_laws import AreaAndStrains, Face, Rubber, Tag, measures, respond
from lumped.springs.laws import Constants
from lumped.springs.tiles import FORCE_X, FORCE_Y, FORCE_Z, GIVEN, KEPT, LANES, OPTIONS, ROW, ROWS
from sheetbench.numerics.memory import load, store

(R0, R1, R2, R3, R4, R5, R6, R7, R8, R9, R10, R11, R12, R13, R14, R15, R16, R17) = ROWS[:18]
DATA = {AreaAndStrains: 18, Rubber: 23, Face: 18}  # rows of rest data
USED, SHAPE = 18, 9  # rows of a tile, of what is kept
HALF = 0.5
Places = tuple[int, int, int, int]


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
def stretch_cells(
    law: Tag, x: np.ndarray, corners: Places, size: int, share: float, t: int, blocks: int, tile: np.ndarray,
    at: int,
) -> float:  # fmt: skip
    """Keep the shapes, and put this share of the springs' forces in the rows of forces; the energy. The
    changes of the sides are in the tile; x and the corners' places give q of a law that has s."""
    r, rest = ROWS, law.constants
    kind = rest.dtype.type
    energy, half, part = kind(0.0), kind(HALF), kind(share)
    for i in range(blocks * LANES):
        a0 = load(GIVEN, rest, t + i), load(GIVEN, rest, t + r[1] + i), load(GIVEN, rest, t + r[2] + i)
        b0 = load(GIVEN, rest, t + r[3] + i), load(GIVEN, rest, t + r[4] + i), load(GIVEN, rest, t + r[5] + i)
        g = load(GIVEN, rest, t + r[6] + i), load(GIVEN, rest, t + r[7] + i), load(GIVEN, rest, t + r[8] + i)
        u = load(ROW, tile, r[0] + i), load(ROW, tile, r[1] + i), load(ROW, tile, r[2] + i)
        w = load(ROW, tile, r[3] + i), load(ROW, tile, r[4] + i), load(ROW, tile, r[5] + i)
        a, b = (a0[0] + u[0], a0[1] + u[1], a0[2] + u[2]), (b0[0] + w[0], b0[1] + w[1], b0[2] + w[2])
        d1 = (a0[0] + a[0]) * u[0] + (a0[1] + a[1]) * u[1] + (a0[2] + a[2]) * u[2]
        d2 = (b0[0] + b[0]) * w[0] + (b0[1] + b[1]) * w[1] + (b0[2] + b[2]) * w[2]
        d3 = u[0] * b0[0] + u[1] * b0[1] + u[2] * b0[2] + (a[0] * w[0] + a[1] * w[1] + a[2] * w[2])
        d4 = kind(0.0)
        if measures(law) == 4:
            q = warp(x, corners, size, i)
            d4 = q[0] * q[0] + q[1] * q[1] + q[2] * q[2]
        k = tile_constants(law, rest, t, i)
        stored, _, s = respond(law, half, (d1, d2, d3, d4), g, load(GIVEN, rest, t + r[9] + i), k)
        energy += stored
        n1, n2, n3 = g[1] + d2, g[0] + d1, g[2] + d3
        turn = kind(1.0) / math.sqrt(n1 * n2 - n3 * n3)
        store(KEPT, tile, at + r[6] + i, kind(turn * n1))
        store(KEPT, tile, at + r[7] + i, kind(turn * n2))
        store(KEPT, tile, at + r[8] + i, kind(turn * n3))
        s1, s2, s3 = part * (s[0] + s[0]), part * (s[1] + s[1]), part * s[2]
        for e in range(3):
            store(KEPT, tile, at + r[e] + i, a[e])
            store(KEPT, tile, at + r[3 + e] + i, b[e])
            store(ROW, tile, r[6 + e] + i, kind(s1 * a[e] + s3 * b[e]))
            store(ROW, tile, r[9 + e] + i, kind(s2 * b[e] + s3 * a[e]))
            if measures(law) == 4:
                store(ROW, tile, r[15 + e] + i, kind(part * (s[3] + s[3]) * q[e]))
    return share * energy


@njit(**OPTIONS)
def warp(x: np.ndarray, corners: Places, size: int, i: int) -> tuple[float, float, float]:
    """q of the cell whose corners are i places after these."""
    c0, c1, c2, c3 = corners
    y, z = size, size + size
    return (
        load(GIVEN, x, c0 + i) - load(GIVEN, x, c1 + i) + load(GIVEN, x, c2 + i) - load(GIVEN, x, c3 + i),
        load(GIVEN, x, c0 + y + i) - load(GIVEN, x, c1 + y + i)
        + (load(GIVEN, x, c2 + y + i) - load(GIVEN, x, c3 + y + i)),
        load(GIVEN, x, c0 + z + i) - load(GIVEN, x, c1 + z + i)
        + (load(GIVEN, x, c2 + z + i) - load(GIVEN, x, c3 + z + i)),
    )  # fmt: skip


@njit(**OPTIONS)
def push_warp(law: Tag, corners: Places, size: int, blocks: int, tile: np.ndarray, force: np.ndarray) -> None:
    """Add the forces on q, of a law that has s, to those on the corners."""
    if measures(law) < 4:
        return
    sign = tile.dtype.type(1.0)
    for corner in corners:
        y, z = corner + size, corner + size + size
        for i in range(blocks * LANES):
            fx, fy, fz = (
                sign * load(ROW, tile, ROWS[15] + i),
                sign * load(ROW, tile, ROWS[16] + i),
                sign * load(ROW, tile, ROWS[17] + i),
            )
            store(FORCE_X, force, corner + i, load(FORCE_X, force, corner + i) + fx)
            store(FORCE_Y, force, y + i, load(FORCE_Y, force, y + i) + fy)
            store(FORCE_Z, force, z + i, load(FORCE_Z, force, z + i) + fz)
        sign = -sign


def tile_constants(law: Tag, rest: np.ndarray, t: int, i: int) -> Any:
    """Return the constants that a law's response takes, of cell i of the rest data at t; compiled only."""


@overload(tile_constants, strict=False)
def _tile_constants(law: Any, rest: Any, t: Any, i: Any) -> Any:
    return {AreaAndStrains: lambda law, rest, t, i: _four(rest, t, i),
            Face: lambda law, rest, t, i: _face(rest, t, i),
            Rubber: lambda law, rest, t, i: _rubber(rest, t, i)}[law.instance_class]  # fmt: skip


@njit(**OPTIONS)
def _four(rest: np.ndarray, t: int, i: int) -> Constants:
    return (
        load(GIVEN, rest, t + R10 + i), load(GIVEN, rest, t + R11 + i), load(GIVEN, rest, t + R12 + i),
        load(GIVEN, rest, t + R13 + i),
    )  # fmt: skip


@njit(**OPTIONS)
def _rubber(rest: np.ndarray, t: int, i: int) -> Constants:
    r, none = ROWS, rest.dtype.type(0.0)  # of its small strains dampers alone want the constants
    return (
        none, none, none, none,
        load(GIVEN, rest, t + R10 + i), load(GIVEN, rest, t + R11 + i), load(GIVEN, rest, t + R12 + i),
        load(GIVEN, rest, t + R13 + i), load(GIVEN, rest, t + r[18] + i), load(GIVEN, rest, t + r[19] + i),
        load(GIVEN, rest, t + r[20] + i), load(GIVEN, rest, t + r[21] + i), load(GIVEN, rest, t + r[22] + i),
    )  # fmt: skip


@njit(**OPTIONS)
def _face(rest: np.ndarray, t: int, i: int) -> Constants:
    none = rest.dtype.type(0.0)
    return none, none, none, none, load(GIVEN, rest, t + R10 + i)


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
