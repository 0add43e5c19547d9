"""Neo-Hookean cells by tiles: the forces of `lumped.springs.membranes`, their dampers' in `cell_tiles`.

Rows of a tile beside those of `cell_tiles`: q (12 to 14) and the force on q (15 to 17). Rest data: k₄, k₆, k₇
and k₈ of `laws.neo_hookean` where others have their springs' constants (10 to 13), and k₅, k₉ (18, 19).

Only the passes of lattices that have such cells are compiled with these loops: `law` in a packing is a number
there, and None elsewhere.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numba import njit, types
from numba.extending import overload

from lumped.springs.laws import neo_hookean
from lumped.springs.memory import FORCE_X, FORCE_Y, FORCE_Z, GIVEN, KEPT, ROW, load, store
from lumped.springs.tiles import LANES, OPTIONS, ROWS

DATA, HALF = 20, 0.5
Places = tuple[int, int, int, int]


@njit(**OPTIONS)
def stretch_membranes(
    x: np.ndarray, corners: Places, size: int, share: float, rest: np.ndarray, t: int, blocks: int,
    tile: np.ndarray, at: int,
) -> float:  # fmt: skip
    """Keep the shapes, and put this share of the forces in their rows; the energy. The changes of the sides
    are in the tile, x and the corners' places give q."""
    energy = rest.dtype.type(0.0)
    half, part, none = rest.dtype.type(HALF), rest.dtype.type(share), rest.dtype.type(0.0)
    r = ROWS
    c0, c1, c2, c3 = corners
    for i in range(blocks * LANES):
        a0 = load(GIVEN, rest, t + i), load(GIVEN, rest, t + r[1] + i), load(GIVEN, rest, t + r[2] + i)
        b0 = load(GIVEN, rest, t + r[3] + i), load(GIVEN, rest, t + r[4] + i), load(GIVEN, rest, t + r[5] + i)
        g = load(GIVEN, rest, t + r[6] + i), load(GIVEN, rest, t + r[7] + i), load(GIVEN, rest, t + r[8] + i)
        u = load(ROW, tile, r[0] + i), load(ROW, tile, r[1] + i), load(ROW, tile, r[2] + i)
        w = load(ROW, tile, r[3] + i), load(ROW, tile, r[4] + i), load(ROW, tile, r[5] + i)
        y, z = size, size + size
        q = (
            load(GIVEN, x, c0 + i) - load(GIVEN, x, c1 + i) + load(GIVEN, x, c2 + i) - load(GIVEN, x, c3 + i),
            load(GIVEN, x, c0 + y + i) - load(GIVEN, x, c1 + y + i)
            + (load(GIVEN, x, c2 + y + i) - load(GIVEN, x, c3 + y + i)),
            load(GIVEN, x, c0 + z + i) - load(GIVEN, x, c1 + z + i)
            + (load(GIVEN, x, c2 + z + i) - load(GIVEN, x, c3 + z + i)),
        )  # fmt: skip
        a, b = (a0[0] + u[0], a0[1] + u[1], a0[2] + u[2]), (b0[0] + w[0], b0[1] + w[1], b0[2] + w[2])
        d1 = (a0[0] + a[0]) * u[0] + (a0[1] + a[1]) * u[1] + (a0[2] + a[2]) * u[2]
        d2 = (b0[0] + b[0]) * w[0] + (b0[1] + b[1]) * w[1] + (b0[2] + b[2]) * w[2]
        d3 = u[0] * b0[0] + u[1] * b0[1] + u[2] * b0[2] + (a[0] * w[0] + a[1] * w[1] + a[2] * w[2])
        d = d1, d2, d3, q[0] * q[0] + q[1] * q[1] + q[2] * q[2]
        k = (
            none, none, none, none, part * load(GIVEN, rest, t + r[10] + i), load(GIVEN, rest, t + r[18] + i),
            part * load(GIVEN, rest, t + r[11] + i), part * load(GIVEN, rest, t + r[12] + i),
            part * load(GIVEN, rest, t + r[13] + i), part * load(GIVEN, rest, t + r[19] + i),
        )  # fmt: skip
        stored, _, _, _, _, s = neo_hookean(half, d, g, load(GIVEN, rest, t + r[9] + i), k)
        energy += stored
        n1, n2, n3 = g[1] + d2, g[0] + d1, g[2] + d3
        turn = rest.dtype.type(1.0) / math.sqrt(n1 * n2 - n3 * n3)
        store(KEPT, tile, at + r[6] + i, rest.dtype.type(turn * n1))
        store(KEPT, tile, at + r[7] + i, rest.dtype.type(turn * n2))
        store(KEPT, tile, at + r[8] + i, rest.dtype.type(turn * n3))
        for e in range(3):
            store(KEPT, tile, at + r[e] + i, a[e])
            store(KEPT, tile, at + r[3 + e] + i, b[e])
            store(ROW, tile, r[6 + e] + i, rest.dtype.type((s[0] + s[0]) * a[e] + s[2] * b[e]))
            store(ROW, tile, r[9 + e] + i, rest.dtype.type((s[1] + s[1]) * b[e] + s[2] * a[e]))
            store(ROW, tile, r[15 + e] + i, rest.dtype.type((s[3] + s[3]) * q[e]))
    return 1.0 * energy


@njit(**OPTIONS)
def push_warp(corners: Places, size: int, blocks: int, tile: np.ndarray, force: np.ndarray) -> None:
    """Add the forces on q to those on the corners."""
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


@njit(**OPTIONS)
def _stretch(
    x: np.ndarray, corners: Places, size: int, share: float, rest: np.ndarray, t: int, blocks: int,
    tile: np.ndarray, at: int, force: np.ndarray,
) -> float:  # fmt: skip
    energy = stretch_membranes(x, corners, size, share, rest, t, blocks, tile, at)
    push_warp(corners, size, blocks, tile, force)
    return energy


def stretch_others(
    law: int | None, x: np.ndarray, corners: Places, size: Any, share: float, rest: np.ndarray, t: int,
    blocks: int, tile: np.ndarray, at: int, force: np.ndarray,
) -> float:  # fmt: skip
    """`stretch_membranes`, and the forces on q to the corners; nothing where there are no such cells."""
    return 0.0 if law is None else _stretch(x, corners, size, share, rest, t, blocks, tile, at, force)


@overload(stretch_others, strict=False)
def _stretch_others(
    law: Any, x: Any, corners: Any, size: Any, share: Any, rest: Any, t: Any, blocks: Any, tile: Any, at: Any,
    force: Any,
) -> Any:  # fmt: skip
    if isinstance(law, types.NoneType):
        return lambda law, x, corners, size, share, rest, t, blocks, tile, at, force: 0.0

    def stretch(law, x, corners, size, share, rest, t, blocks, tile, at, force):  # type: ignore[no-untyped-def]
        return _stretch(x, corners, size, share, rest, t, blocks, tile, at, force)

    return stretch
