"""Runs of springs at constant distances between their masses, a tile at a time, which compilers vectorise.

With the masses numbered plane by plane (`lumped.springs.packing`), springs of one direction join mass a + i
to mass a + i + d for i = 0, 1, …: no list of masses is looked at. A tile holds up to WIDTH springs, a
quantity of all of them a row. A spring's shape, which is what takes divisions and roots, is found once for a
displacement and kept behind the rows; dampers are asked for any number of velocities after that. Forces go to
the first ends and to the second ones in loops of their own, since in one the ends of neighbours meet. Sums
may be reassociated and products fused with them, in an order that only the code settles, not the threads; no
assumption is made about numbers that overflow.

Vectors are flat, component by component: x, y and z of every mass in turn. Indices are unsigned, since a
signed one might count from the end, which a vector cannot.

Links. With r = d0 + du, the relative position, n = r/|r| and L the rest length, a link pulls with
k (|r| − L) n, and its damper with c (n·dv) n. Rows of rest data: d0, L, c, k; of the per-direction law three
k. Kept of every link: n; the pull is a row of the tile. A place without a link has no stiffness, and TINY
keeps it finite.

Cells. Rows of a tile: changes of the mean sides a and b, or their velocities (0 to 5), and the forces on a
and b (6 to 11), of a law of s those on q (15 to 17). Rows of rest data: a, b (0 to 5), a·a, b·b, a·b (6 to
8), the area (9), and four constants of the springs' law (10 to 13) and of the dampers' (14 to 17); of rubber
those are k₄ to k₇, and k₈ to k₁₂ are in more rows (18 to 22); with fibres more rows have what couples
strains, of springs (18 to 20) and of dampers (21 to 23); of faces the first is k₄. Kept of every cell:
a and b, and n/A of its area (`lumped.springs.laws`). A place without a cell is a unit square without
stiffness.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numba import njit
from numba.extending import overload

from lumped.springs.cell_laws import AreaAndStrains, Coupled, Face, Rubber, Tag, measures, respond
from lumped.springs.laws import Constants
from sheetbench.numerics.memory import load, store

WIDTH = 128
LANES = np.uint64(8)  # springs of a run come in blocks of so many, as wide as the widest vectors
NUMBA_TRUE: Any = np.True_  # for Python's own numba compiles a kernel once for each
NUMBA_FALSE: Any = np.False_
STRIDE = WIDTH + 8  # of rows; a power of two would put them all in the same few places of a cache
ROWS = tuple(np.uint64(row * STRIDE) for row in range(24))
# kinds of memory that never overlap (`numerics.memory`): what is only read (rest data, displacements,
# velocities), what springs keep of their shape, rows of a tile, and the three components of forces
GIVEN, KEPT, ROW, FORCE_X, FORCE_Y, FORCE_Z = range(6)
OPTIONS: dict[str, Any] = {
    "cache": True,
    "error_model": "numpy",
    "fastmath": {"contract", "reassoc", "arcp", "nsz"},
}
(R0, R1, R2, R3, R4, R5, R6, R7, R8, R9, R10, R11, R12, R13, R14, R15, R16, R17) = ROWS[:18]
LINK_DATA, LINK_SHAPE = 8, 3  # rows of rest data, and of what is kept
CELL_DATA, CELL_SHAPE = {AreaAndStrains: 18, Coupled: 24, Rubber: 23, Face: 18}, 9
USED = 18  # rows of a tile
TINY = 1e-36  # m²
HALF = 0.5
Places = tuple[int, int, int, int]


@njit(**OPTIONS)
def stretch_links(
    u: np.ndarray,
    share: float,
    rest: np.ndarray,
    t: int,
    a: int,
    b: int,
    size: int,
    blocks: int,
    tile: np.ndarray,
    at: int,
) -> float:
    """Keep the directions at displacement u, and put this share of the springs' pulls in the first row; the
    energy."""
    energy = rest.dtype.type(0.0)
    one, tiny, part = rest.dtype.type(1.0), rest.dtype.type(TINY), rest.dtype.type(share)
    a1, b1, a2, b2 = a + size, b + size, a + size + size, b + size + size
    for i in range(blocks * LANES):
        ox, oy, oz = load(GIVEN, rest, t + i), load(GIVEN, rest, t + R1 + i), load(GIVEN, rest, t + R2 + i)
        dx = load(GIVEN, u, b + i) - load(GIVEN, u, a + i)
        dy = load(GIVEN, u, b1 + i) - load(GIVEN, u, a1 + i)
        dz = load(GIVEN, u, b2 + i) - load(GIVEN, u, a2 + i)
        rx, ry, rz = ox + dx, oy + dy, oz + dz
        along = ox * dx + oy * dy + oz * dz
        gained = along + along + (dx * dx + dy * dy + dz * dz)  # r² − L², no digits lost
        length = math.sqrt(rx * rx + ry * ry + rz * rz + tiny)
        both = length + load(GIVEN, rest, t + R3 + i)
        inverse = one / (both * length)
        turn, elongation = both * inverse, gained * (length * inverse)
        pull = part * load(GIVEN, rest, t + R5 + i) * elongation
        energy += pull * elongation
        store(ROW, tile, R0 + i, pull)
        store(KEPT, tile, at + i, rx * turn)
        store(KEPT, tile, at + R1 + i, ry * turn)
        store(KEPT, tile, at + R2 + i, rz * turn)
    return 0.5 * energy


@njit(**OPTIONS)
def resist_links(
    v: np.ndarray, rest: np.ndarray, t: int, a: int, b: int, size: int, blocks: int, tile: np.ndarray, at: int
) -> float:
    """Add the pulls of the dampers at velocity v to the first row; the power taken."""
    power = rest.dtype.type(0.0)
    a1, b1, a2, b2 = a + size, b + size, a + size + size, b + size + size
    for i in range(blocks * LANES):
        rate = load(KEPT, tile, at + i) * (load(GIVEN, v, b + i) - load(GIVEN, v, a + i))
        rate += load(KEPT, tile, at + R1 + i) * (load(GIVEN, v, b1 + i) - load(GIVEN, v, a1 + i))
        rate += load(KEPT, tile, at + R2 + i) * (load(GIVEN, v, b2 + i) - load(GIVEN, v, a2 + i))
        resisting = load(GIVEN, rest, t + R4 + i) * rate
        power += resisting * rate
        store(ROW, tile, R0 + i, load(ROW, tile, R0 + i) + resisting)
    return 1.0 * power


@njit(**OPTIONS)
def stretch_directional(
    u: np.ndarray, rest: np.ndarray, t: int, a: int, b: int, size: int, blocks: int, tile: np.ndarray, at: int
) -> None:
    """The per-direction law, which has no energy: its force where others keep n, to be pulled with 1."""
    one, tiny = rest.dtype.type(1.0), rest.dtype.type(TINY)
    a1, b1, a2, b2 = a + size, b + size, a + size + size, b + size + size
    for i in range(blocks * LANES):
        ox, oy, oz = load(GIVEN, rest, t + i), load(GIVEN, rest, t + R1 + i), load(GIVEN, rest, t + R2 + i)
        dx = load(GIVEN, u, b + i) - load(GIVEN, u, a + i)
        dy = load(GIVEN, u, b1 + i) - load(GIVEN, u, a1 + i)
        dz = load(GIVEN, u, b2 + i) - load(GIVEN, u, a2 + i)
        along = ox * dx + oy * dy + oz * dz
        gained = along + along + (dx * dx + dy * dy + dz * dz)
        dx, dy, dz = dx + ox, dy + oy, dz + oz
        length = math.sqrt(dx * dx + dy * dy + dz * dz + tiny)
        strain = gained / ((length + load(GIVEN, rest, t + R3 + i)) * length)
        store(ROW, tile, R0 + i, one)
        store(KEPT, tile, at + i, load(GIVEN, rest, t + R5 + i) * strain * dx)
        store(KEPT, tile, at + R1 + i, load(GIVEN, rest, t + R6 + i) * strain * dy)
        store(KEPT, tile, at + R2 + i, load(GIVEN, rest, t + R7 + i) * strain * dz)


@njit(**OPTIONS)
def pull_ends(
    sign: float, end: int, size: int, blocks: int, tile: np.ndarray, at: int, force: np.ndarray
) -> None:
    """Add the pulls, times 1 or −1, to the forces on one end of the links."""
    y, z, way = end + size, end + size + size, tile.dtype.type(sign)
    for i in range(blocks * LANES):
        pull = way * load(ROW, tile, R0 + i)
        store(FORCE_X, force, end + i, load(FORCE_X, force, end + i) + pull * load(KEPT, tile, at + i))
        store(FORCE_Y, force, y + i, load(FORCE_Y, force, y + i) + pull * load(KEPT, tile, at + R1 + i))
        store(FORCE_Z, force, z + i, load(FORCE_Z, force, z + i) + pull * load(KEPT, tile, at + R2 + i))


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
            Coupled: lambda law, rest, t, i: _seven(rest, t, i),
            Face: lambda law, rest, t, i: _face(rest, t, i),
            Rubber: lambda law, rest, t, i: _rubber(rest, t, i)}[law.instance_class]  # fmt: skip


@njit(**OPTIONS)
def _four(rest: np.ndarray, t: int, i: int) -> Constants:
    return (
        load(GIVEN, rest, t + R10 + i), load(GIVEN, rest, t + R11 + i), load(GIVEN, rest, t + R12 + i),
        load(GIVEN, rest, t + R13 + i),
    )  # fmt: skip


@njit(**OPTIONS)
def _seven(rest: np.ndarray, t: int, i: int) -> Constants:
    r = ROWS
    return (
        load(GIVEN, rest, t + R10 + i), load(GIVEN, rest, t + R11 + i), load(GIVEN, rest, t + R12 + i),
        load(GIVEN, rest, t + R13 + i), load(GIVEN, rest, t + r[18] + i), load(GIVEN, rest, t + r[19] + i),
        load(GIVEN, rest, t + r[20] + i),
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


@njit(**OPTIONS)
def resist_couplings(rest: np.ndarray, t: int, blocks: int, tile: np.ndarray, at: int) -> float:
    """Add the forces of dampers that couple strains to the rows of forces; the power taken."""
    r, power = ROWS, rest.dtype.type(0.0)
    for i in range(blocks * LANES):
        r1 = r2 = r3 = rest.dtype.type(0.0)  # half the rates of a·a and b·b, that of a·b
        for e in range(3):
            a, b = load(KEPT, tile, at + r[e] + i), load(KEPT, tile, at + r[3 + e] + i)
            u, w = load(ROW, tile, r[e] + i), load(ROW, tile, r[3 + e] + i)
            r1, r2, r3 = r1 + a * u, r2 + b * w, r3 + (a * w + b * u)
        r1, r2 = r1 + r1, r2 + r2
        x, y = load(GIVEN, rest, t + r[21] + i), load(GIVEN, rest, t + r[22] + i)
        z = load(GIVEN, rest, t + r[23] + i)
        s1, s2, s3 = x * r2 + y * r3, x * r1 + z * r3, y * r1 + z * r2
        power += s1 * r1 + s2 * r2 + s3 * r3
        for e in range(3):
            a, b = load(KEPT, tile, at + r[e] + i), load(KEPT, tile, at + r[3 + e] + i)
            on_a, on_b = (s1 + s1) * a + s3 * b, (s2 + s2) * b + s3 * a
            store(ROW, tile, r[6 + e] + i, load(ROW, tile, r[6 + e] + i) + on_a)
            store(ROW, tile, r[9 + e] + i, load(ROW, tile, r[9 + e] + i) + on_b)
    return 1.0 * power
