"""Links and their dampers by tiles: the forces of `lumped.springs.links`, `directional` and `link_dampers`.

With r = d0 + du, the relative position, and L the rest length, a link pulls with k (|r| − L)/|r| r, and its
damper with c (r·dv)/|r|² r. Rows of a tile: du and dv in, the force in place of du out. Rows of rest data:
d0, L, c, k; of the per-direction law three k. A place without a link has no stiffness, and TINY keeps it
finite.
"""

from __future__ import annotations

import math

import numpy as np
from numba import njit

from lumped.springs.tiles import OPTIONS, ROWS

R0, R1, R2, R3, R4, R5, R6, R7 = ROWS[:8]
DATA = 8  # rows of rest data
TINY = 1e-36  # m²


@njit(**OPTIONS)
def link_forces(
    rest: np.ndarray, t: int, tile: np.ndarray, count: int, elastic: bool, damped: bool
) -> tuple[float, float]:
    """Forces of the springs if elastic, and of the dampers if damped; energy, and power taken."""
    energy, power = rest.dtype.type(0.0), rest.dtype.type(0.0)
    one, tiny = rest.dtype.type(1.0), rest.dtype.type(TINY)
    for i in range(count):
        ox, oy, oz = rest[t + i], rest[t + R1 + i], rest[t + R2 + i]
        dx, dy, dz = tile[i], tile[R1 + i], tile[R2 + i]
        rx, ry, rz = ox + dx, oy + dy, oz + dz
        square = rx * rx + ry * ry + rz * rz + tiny
        pull = rest.dtype.type(0.0)
        if elastic:
            along = ox * dx + oy * dy + oz * dz
            gained = along + along + (dx * dx + dy * dy + dz * dz)  # r² − L², no digits lost
            length = math.sqrt(square)
            both = length + rest[t + R3 + i]
            inverse = one / (both * length)
            strain = gained * inverse
            pull = rest[t + R5 + i] * strain
            energy += pull * strain * square
            turn = both * inverse
            by_square = turn * turn
        else:
            by_square = one / square
        if damped:
            rate = rx * tile[R3 + i] + ry * tile[R4 + i] + rz * tile[R5 + i]
            resisting = rest[t + R4 + i] * rate * by_square
            power += resisting * rate
            pull += resisting
        tile[i], tile[R1 + i], tile[R2 + i] = pull * rx, pull * ry, pull * rz
    return 0.5 * energy, 1.0 * power


@njit(**OPTIONS)
def add_directional(rest: np.ndarray, t: int, tile: np.ndarray, count: int) -> None:
    """Forces of the per-direction law, which has no energy."""
    tiny = rest.dtype.type(TINY)
    for i in range(count):
        ox, oy, oz = rest[t + i], rest[t + R1 + i], rest[t + R2 + i]
        dx, dy, dz = tile[i], tile[R1 + i], tile[R2 + i]
        along = ox * dx + oy * dy + oz * dz
        gained = along + along + (dx * dx + dy * dy + dz * dz)
        dx, dy, dz = dx + ox, dy + oy, dz + oz
        length = math.sqrt(dx * dx + dy * dy + dz * dz + tiny)
        strain = gained / ((length + rest[t + R3 + i]) * length)
        tile[i] = rest[t + R5 + i] * strain * dx
        tile[R1 + i] = rest[t + R6 + i] * strain * dy
        tile[R2 + i] = rest[t + R7 + i] * strain * dz
