"""Forces of springs in vectorised loops: runs of springs with constant index distances, in tiles of WIDTH.

The masses are numbered plane by plane (`lumped.springs.packing`), so that springs of one direction join mass
a + i to mass a + i + d for i = 0, 1, … without a list of masses. A tile holds up to WIDTH springs, a row for
each quantity. A spring's shape, which needs divisions and roots, is computed once for a displacement and kept
behind the rows, for dampers at any number of velocities. Forces go to the first ends and to the second ends
in separate loops, since neighbours share ends. Sums may be reassociated and products fused with them, in an
order that depends on the code alone, not on threads; no assumption is made about numbers that overflow.

Vectors are flat, component by component: x, y and z of every mass in turn. Indices are unsigned, since a
signed one might count from the end, which a vector cannot.

Links. A link pulls with k (|r| − L) n, its damper with c (n·dv) n; r = d0 + du is the relative position,
n = r/|r| and L the rest length. Rows of rest data: d0, L, c, k. Kept of every link: n; the pull is a row of
the tile. A place without a link has no stiffness, and TINY keeps it finite.

Cells. Rows of a tile: changes of the mean sides a and b, or their velocities (0 to 5), and the forces on a
and b (6 to 11), of a law of s those on q (15 to 17). Rows of rest data: a, b (0 to 5), a·a, b·b, a·b (6 to
8), the area (9), the constants of the dampers' area and strains (10 to 16) and of the springs' law (17 and
on). Kept of every cell:
a and b, and n/A of its area (`lumped.springs.laws`). A place without a cell is a unit square without
stiffness.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from lumped.springs.law_table import LAWS, Tag, constants, measures, respond
from lumped.springs.laws import times_six
from sheetbench.numerics.aliasing import load, load_each, store, store_each
from sheetbench.numerics.options import inner, njit

WIDTH = 128
LANES = np.uint64(8)  # springs of a run come in blocks of so many, as wide as the widest vectors
NUMBA_TRUE: Any = np.True_  # with Python's True and False numba would compile a kernel for each
NUMBA_FALSE: Any = np.False_
STRIDE = WIDTH + 8  # of rows; a power of two would put them all in the same few places of a cache
ROWS = tuple(np.uint64(row * STRIDE) for row in range(24))
# kinds of memory that never overlap (`numerics.aliasing`): read-only data (rest data, displacements,
# velocities), kept shapes of springs, rows of a tile, and the three components of forces
GIVEN, KEPT, ROW, FORCE_X, FORCE_Y, FORCE_Z = range(6)
OPTIONS: dict[str, Any] = {"fastmath": {"contract", "reassoc", "arcp", "nsz"}}
R0, R3, R4, R5, R6, R9, R10, R11 = (ROWS[row] for row in (0, 3, 4, 5, 6, 9, 10, 11))
LAW = 17  # row of rest data from which on the constants of a cell's law are
LINK_DATA, LINK_SHAPE = 6, 3  # rows of rest data, and of kept shapes
CELL_DATA, CELL_SHAPE = {law.tag: LAW + law.count for law in LAWS}, 9
USED = 18  # rows of a tile
TINY = 1e-36  # m²
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
    """Write the links' directions at displacement u, and `share` times their forces into the tile's first
    row; return their energy [J]."""
    energy = 0.0
    for i in range(blocks * LANES):
        ox, oy, oz = load_each(GIVEN, rest, t + i, STRIDE, 3)
        from_, to = load_each(GIVEN, u, a + i, size, 3), load_each(GIVEN, u, b + i, size, 3)
        dx, dy, dz = to[0] - from_[0], to[1] - from_[1], to[2] - from_[2]
        rx, ry, rz = ox + dx, oy + dy, oz + dz
        along = ox * dx + oy * dy + oz * dz
        gained = along + along + (dx * dx + dy * dy + dz * dz)  # r² − L², no digits lost
        length = math.sqrt(rx * rx + ry * ry + rz * rz + TINY)
        both = length + load(GIVEN, rest, t + R3 + i)
        inverse = 1.0 / (both * length)
        turn, elongation = both * inverse, gained * (length * inverse)
        pull = share * load(GIVEN, rest, t + R5 + i) * elongation
        energy += pull * elongation
        store(ROW, tile, R0 + i, pull)
        store_each(KEPT, tile, at + i, STRIDE, (rx * turn, ry * turn, rz * turn))
    return 0.5 * energy


@njit(**OPTIONS)
def resist_links(
    v: np.ndarray, rest: np.ndarray, t: int, a: int, b: int, size: int, blocks: int, tile: np.ndarray, at: int
) -> float:
    """Add the links' damper forces at velocity v to the tile's first row; return the power dissipated [W]."""
    power = 0.0
    for i in range(blocks * LANES):
        n = load_each(KEPT, tile, at + i, STRIDE, 3)
        from_, to = load_each(GIVEN, v, a + i, size, 3), load_each(GIVEN, v, b + i, size, 3)
        rate = n[0] * (to[0] - from_[0]) + n[1] * (to[1] - from_[1]) + n[2] * (to[2] - from_[2])
        resisting = load(GIVEN, rest, t + R4 + i) * rate
        power += resisting * rate
        store(ROW, tile, R0 + i, load(ROW, tile, R0 + i) + resisting)
    return power


@inner(**OPTIONS)
def push(force: np.ndarray, place: int, size: int, x: float, y: float, z: float) -> None:
    """Add a vector x, y, z to the force on the mass at a place."""
    store(FORCE_X, force, place, load(FORCE_X, force, place) + x)
    store(FORCE_Y, force, place + size, load(FORCE_Y, force, place + size) + y)
    store(FORCE_Z, force, place + size + size, load(FORCE_Z, force, place + size + size) + z)


@njit(**OPTIONS)
def pull_ends(
    sign: float, end: int, size: int, blocks: int, tile: np.ndarray, at: int, force: np.ndarray
) -> None:
    """Add the links' forces in the tile, times 1 or −1, to the forces on the masses at one end."""
    for i in range(blocks * LANES):
        pull, n = sign * load(ROW, tile, R0 + i), load_each(KEPT, tile, at + i, STRIDE, 3)
        push(force, end + i, size, pull * n[0], pull * n[1], pull * n[2])


@njit(**OPTIONS)
def gather_sides(
    x: np.ndarray, c0: int, c1: int, c2: int, c3: int, size: int, blocks: int, tile: np.ndarray
) -> None:
    """Write a and b, the mean sides from the corners' vectors x, into the tile's first rows."""
    for i in range(blocks * LANES):
        k, m = load_each(GIVEN, x, c0 + i, size, 3), load_each(GIVEN, x, c1 + i, size, 3)
        n, o = load_each(GIVEN, x, c2 + i, size, 3), load_each(GIVEN, x, c3 + i, size, 3)
        fx, fy, fz = n[0] - k[0], n[1] - k[1], n[2] - k[2]
        sx, sy, sz = o[0] - m[0], o[1] - m[1], o[2] - m[2]
        store_each(ROW, tile, R0 + i, STRIDE, (0.5 * (fx - sx), 0.5 * (fy - sy), 0.5 * (fz - sz)))
        store_each(ROW, tile, R3 + i, STRIDE, (0.5 * (fx + sx), 0.5 * (fy + sy), 0.5 * (fz + sz)))


@njit(**OPTIONS)
def push_corner(
    on_a: float, on_b: float, corner: int, size: int, blocks: int, tile: np.ndarray, force: np.ndarray
) -> None:
    """Add the tile's forces on the mean sides, times on_a and on_b (±½), to the force on one corner of the
    cells."""
    for i in range(blocks * LANES):
        a, b = load_each(ROW, tile, R6 + i, STRIDE, 3), load_each(ROW, tile, R9 + i, STRIDE, 3)
        x, y, z = on_a * a[0] + on_b * b[0], on_a * a[1] + on_b * b[1], on_a * a[2] + on_b * b[2]
        push(force, corner + i, size, x, y, z)


@njit(**OPTIONS)
def stretch_cells(
    law: Tag, x: np.ndarray, corners: Places, size: int, share: float, t: int, blocks: int, tile: np.ndarray,
    at: int,
) -> float:  # fmt: skip
    """Write the cells' shapes, and `share` times the forces on their sides into the tile; return their energy
    [J]. The changes of the sides are in the tile; x and the corners' places give q of a law that has s."""
    rest, energy = law.constants, 0.0
    for i in range(blocks * LANES):
        a0, b0 = load_each(GIVEN, rest, t + i, STRIDE, 3), load_each(GIVEN, rest, t + R3 + i, STRIDE, 3)
        g = load_each(GIVEN, rest, t + R6 + i, STRIDE, 3)
        u, w = load_each(ROW, tile, R0 + i, STRIDE, 3), load_each(ROW, tile, R3 + i, STRIDE, 3)
        a, b = (a0[0] + u[0], a0[1] + u[1], a0[2] + u[2]), (b0[0] + w[0], b0[1] + w[1], b0[2] + w[2])
        d1 = (a0[0] + a[0]) * u[0] + (a0[1] + a[1]) * u[1] + (a0[2] + a[2]) * u[2]
        d2 = (b0[0] + b[0]) * w[0] + (b0[1] + b[1]) * w[1] + (b0[2] + b[2]) * w[2]
        d3 = u[0] * b0[0] + u[1] * b0[1] + u[2] * b0[2] + (a[0] * w[0] + a[1] * w[1] + a[2] * w[2])
        d4 = 0.0
        if measures(law) == 4:
            c0, c1, c2, c3 = corners
            k0, k1 = load_each(GIVEN, x, c0 + i, size, 3), load_each(GIVEN, x, c1 + i, size, 3)
            k2, k3 = load_each(GIVEN, x, c2 + i, size, 3), load_each(GIVEN, x, c3 + i, size, 3)
            q = (
                k0[0] - k1[0] + k2[0] - k3[0],
                k0[1] - k1[1] + (k2[1] - k3[1]),
                k0[2] - k1[2] + (k2[2] - k3[2]),
            )
            d4 = q[0] * q[0] + q[1] * q[1] + q[2] * q[2]
        k, area = constants(law, t + ROWS[LAW] + i, STRIDE), load(GIVEN, rest, t + R9 + i)
        stored, _, s = respond(law, (d1, d2, d3, d4), g, area, k)
        energy += stored
        n1, n2, n3 = g[1] + d2, g[0] + d1, g[2] + d3
        turn = 1.0 / math.sqrt(n1 * n2 - n3 * n3)
        store_each(KEPT, tile, at + i, STRIDE, a)
        store_each(KEPT, tile, at + R3 + i, STRIDE, b)
        store_each(KEPT, tile, at + R6 + i, STRIDE, (turn * n1, turn * n2, turn * n3))
        s1, s2, s3 = share * (s[0] + s[0]), share * (s[1] + s[1]), share * s[2]
        for e in range(3):
            store(ROW, tile, ROWS[6 + e] + i, s1 * a[e] + s3 * b[e])
            store(ROW, tile, ROWS[9 + e] + i, s2 * b[e] + s3 * a[e])
            if measures(law) == 4:
                store(ROW, tile, ROWS[15 + e] + i, share * (s[3] + s[3]) * q[e])
    return share * energy


@njit(**OPTIONS)
def push_warp(law: Tag, corners: Places, size: int, blocks: int, tile: np.ndarray, force: np.ndarray) -> None:
    """Add the tile's forces on the warp q, if the law has the measure s, to the forces on the cells'
    corners."""
    if measures(law) < 4:
        return
    sign = 1.0
    for corner in corners:
        for i in range(blocks * LANES):
            x, y, z = load_each(ROW, tile, ROWS[15] + i, STRIDE, 3)
            push(force, corner + i, size, sign * x, sign * y, sign * z)
        sign = -sign


@njit(**OPTIONS)
def resist_cells(rest: np.ndarray, t: int, blocks: int, tile: np.ndarray, at: int) -> float:
    """Add the cells' damper forces to the tile's forces on the sides; return the power dissipated [W]."""
    power = 0.0
    for i in range(blocks * LANES):
        a, b = load_each(KEPT, tile, at + i, STRIDE, 3), load_each(KEPT, tile, at + R3 + i, STRIDE, 3)
        n1, n2, n3 = load_each(KEPT, tile, at + R6 + i, STRIDE, 3)
        u, w = load_each(ROW, tile, R0 + i, STRIDE, 3), load_each(ROW, tile, R3 + i, STRIDE, 3)
        k = load_each(GIVEN, rest, t + R10 + i, STRIDE, 7)
        r1 = a[0] * u[0] + a[1] * u[1] + a[2] * u[2]  # half the rates of a·a and b·b, the rate of a·b
        r2 = b[0] * w[0] + b[1] * w[1] + b[2] * w[2]
        r3 = (a[0] * w[0] + a[1] * w[1] + a[2] * w[2]) + (b[0] * u[0] + b[1] * u[1] + b[2] * u[2])
        growing = n1 * r1 + n2 * r2 - n3 * r3  # Ȧ
        pull = k[0] * growing
        power += pull * growing
        r1, r2 = r1 + r1, r2 + r2
        s1, s2, s3 = times_six(k[1:], (r1, r2, r3))
        power += s1 * r1 + s2 * r2 + s3 * r3
        s1, s2, s3 = s1 + s1 + pull * n1, s2 + s2 + pull * n2, s3 - pull * n3
        for e in range(3):
            on_a, on_b = s1 * a[e] + s3 * b[e], s2 * b[e] + s3 * a[e]
            store(ROW, tile, ROWS[6 + e] + i, load(ROW, tile, ROWS[6 + e] + i) + on_a)
            store(ROW, tile, ROWS[9 + e] + i, load(ROW, tile, ROWS[9 + e] + i) + on_b)
    return power
