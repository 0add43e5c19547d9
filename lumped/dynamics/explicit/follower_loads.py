"""Loads that follow the sheet (`lumped.loads`) at the places of a `Packing`, compiled."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from lumped.pressure import WEIGHTS
from lumped.springs.all_forces import average, clear, share_out
from lumped.springs.packing import Packing
from lumped.springs.tiles import OPTIONS
from sheetbench.numerics.typed import njit


class Followers(NamedTuple):
    """positions: (3 s,) [m] of every place, the mid-surface's too; pressure: (parts, c) [Pa]; cells: (c, 4)
    corners under it, places of the mid-surface; couples: (e, 4) top and bottom mass of a column of an edge,
    and the mid-surface's places before and after it; moments: (e,) [N·m], signed as they turn; parts: (e,)
    whose history scales them."""

    positions: np.ndarray
    pressure: np.ndarray
    cells: np.ndarray
    couples: np.ndarray
    moments: np.ndarray
    parts: np.ndarray


@njit(**OPTIONS)
def add_followers(
    packing: Packing, followers: Followers, factors: np.ndarray, u: np.ndarray, load: np.ndarray
) -> None:
    """Add the loads at displacement u (3 s,) [m] to `load` (3 s,) [N], scaled by the parts' factors."""
    cells, couples = followers.cells, followers.couples
    if len(cells) == 0 and len(couples) == 0:
        return
    average(packing, u)
    clear(packing, load)
    size = np.uint64(len(u) // 3)
    x = followers.positions
    for c in range(len(cells)):
        pressure = 0.0
        for part in range(len(factors)):
            pressure += factors[part] * followers.pressure[part, c]
        for b in range(4):  # as `lumped.pressure` has it
            ax, ay, az = _apart(x, u, cells[c, b], cells[c, (b + 1) % 4], size)
            bx, by, bz = _apart(x, u, cells[c, b], cells[c, (b + 3) % 4], size)
            for a in range(4):
                p, share = cells[c, a], pressure * WEIGHTS[(b - a) % 4]
                load[p] += share * (ay * bz - az * by)
                load[p + size] += share * (az * bx - ax * bz)
                load[p + size + size] += share * (ax * by - ay * bx)
    for e in range(len(couples)):
        top, bottom, before, after = couples[e]
        ax, ay, az = _apart(x, u, before, after, size)
        bx, by, bz = _apart(x, u, bottom, top, size)
        couple = factors[followers.parts[e]] * followers.moments[e]
        couple /= np.sqrt(ax * ax + ay * ay + az * az) * (bx * bx + by * by + bz * bz)
        for p, sign in ((top, couple), (bottom, -couple)):
            load[p] += sign * (ay * bz - az * by)
            load[p + size] += sign * (az * bx - ax * bz)
            load[p + size + size] += sign * (ax * by - ay * bx)
    share_out(packing, load)
    clear(packing, load)


@njit(**OPTIONS)
def _apart(x: np.ndarray, u: np.ndarray, a: int, b: int, size: int) -> tuple[float, float, float]:
    """The vector from place a to place b."""
    return (
        x[b] + u[b] - x[a] - u[a],
        x[b + size] + u[b + size] - x[a + size] - u[a + size],
        x[b + size + size] + u[b + size + size] - x[a + size + size] - u[a + size + size],
    )
