"""Links and their dampers by tiles: the forces of `lumped.springs.links` and `directional`.

With r = d0 + du, the relative position, n = r/|r| and L the rest length, a link pulls with k (|r| − L) n, and
its damper with c (n·dv) n. Rows of rest data: d0, L, c, k; of the per-direction law three k. Kept of every
link: n; the pull is a row of the tile. A place without a link has no stiffness, and TINY keeps it finite.
"""

from __future__ import annotations

import math

import numpy as np
from numba import njit

from lumped.springs.tiles import FORCE_X, FORCE_Y, FORCE_Z, GIVEN, KEPT, LANES, OPTIONS, ROW, ROWS
from sheetbench.numerics.memory import load, store

R0, R1, R2, R3, R4, R5, R6, R7 = ROWS[:8]
DATA, SHAPE = 8, 3  # rows of rest data, and of what is kept
TINY = 1e-36  # m²


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
