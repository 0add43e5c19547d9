"""The forces of all springs and dampers of a lattice in one compiled pass, arrays in and arrays out.

`add_forces` takes displacements and velocities (n, 3) as everyone has them; `add_at_places` is for whoever
keeps them in the order of a `Packing`, flat. The forces are those of the families (`lumped.springs.family`),
to rounding.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from lumped.springs import packing as kinds
from lumped.springs.cell_tiles import add_strain_forces, area_forces, gather_sides, spread_sides
from lumped.springs.link_tiles import add_directional, link_forces
from lumped.springs.packing import Packing, Scratch
from lumped.springs.tiles import OPTIONS, ROWS, difference, spread

DIRECTIONAL, CELLS = np.uint64(kinds.DIRECTIONAL), np.uint64(kinds.CELLS)
NONE, ONE = np.uint64(0), np.uint64(1)
R0, R1, R2, R3, R4, R5, R6, R7, R8 = ROWS[:9]
R12, R13, R14, R15, R16, R17 = ROWS[12:18]


@njit(**OPTIONS)
def add_forces(
    u: np.ndarray,
    v: np.ndarray,
    elastic: bool,
    damped: bool,
    packing: Packing,
    scratch: Scratch,
    force: np.ndarray,
) -> tuple[float, float]:
    """Add the internal force at displacement u (n, 3) [m] and the damping force at velocity v (n, 3) [m/s],
    or one of them, to `force` (n, 3) [N]; the energy [J] and the power taken [W]. Rows after those of the
    masses are left alone."""
    order, size = packing.order, (packing.layers + ONE) * packing.plane
    for q in range(3):
        past = np.uint64(q) * size
        for p in range(len(order)):
            scratch.u[past + np.uint64(p)] = u[order[p], q]
        if damped:
            for p in range(len(order)):
                scratch.v[past + np.uint64(p)] = v[order[p], q]
    scratch.force[:] = 0.0
    found = add_at_places(scratch.u, scratch.v, elastic, damped, packing, scratch.force, scratch.tile)
    for q in range(3):
        past = np.uint64(q) * size
        for p in range(len(order)):
            force[order[p], q] += scratch.force[past + np.uint64(p)]
    return found


@njit(**OPTIONS)
def add_at_places(
    u: np.ndarray,
    v: np.ndarray,
    elastic: bool,
    damped: bool,
    packing: Packing,
    force: np.ndarray,
    tile: np.ndarray,
) -> tuple[float, float]:
    """The same with u, v and force at the places of a packing, flat. The mid-surface's are written to."""
    if packing.mid:
        average(packing, u)
        if damped:
            average(packing, v)
        clear(packing, force)
    size = (packing.layers + ONE) * packing.plane
    past = size + size
    energy = power = 0.0
    for r in range(len(packing.runs)):
        run = packing.runs[r]
        kind, count, t, a, b = run[0], run[1], run[2], run[3], run[4]
        if kind != CELLS:
            difference(u, a, b, R0, count, tile)
            difference(u, a + size, b + size, R1, count, tile)
            difference(u, a + past, b + past, R2, count, tile)
            if kind == DIRECTIONAL:
                if not elastic:
                    continue
                add_directional(packing.rest, t, tile, count)
            else:
                if damped:
                    difference(v, a, b, R3, count, tile)
                    difference(v, a + size, b + size, R4, count, tile)
                    difference(v, a + past, b + past, R5, count, tile)
                stored, taken = link_forces(packing.rest, t, tile, count, elastic, damped)
                energy += stored
                power += taken
            spread(tile, R0, a, b, count, force)
            spread(tile, R1, a + size, b + size, count, force)
            spread(tile, R2, a + past, b + past, count, force)
            continue
        c, d = run[5], run[6]
        gather_sides(u, a, b, c, d, R0, count, tile)
        gather_sides(u, a + size, b + size, c + size, d + size, R1, count, tile)
        gather_sides(u, a + past, b + past, c + past, d + past, R2, count, tile)
        if damped:
            gather_sides(v, a, b, c, d, R6, count, tile)
            gather_sides(v, a + size, b + size, c + size, d + size, R7, count, tile)
            gather_sides(v, a + past, b + past, c + past, d + past, R8, count, tile)
        if run[7] != NONE:
            stored, taken = area_forces(packing.rest, t, tile, count, elastic, damped)
            energy += stored
            power += taken
        else:
            tile[R12 : R17 + count] = 0.0
        if run[8] != NONE:
            stored, taken = add_strain_forces(packing.rest, t, tile, count, elastic, damped)
            energy += stored
            power += taken
        spread_sides(tile, R12, a, b, c, d, count, force)
        spread_sides(tile, R13, a + size, b + size, c + size, d + size, count, force)
        spread_sides(tile, R14, a + past, b + past, c + past, d + past, count, force)
    if packing.mid:
        share(packing, force)
    return energy, power


@njit(**OPTIONS)
def average(packing: Packing, x: np.ndarray) -> None:
    """Put the layers' mean in the mid-surface's places."""
    plane, mid = packing.plane, packing.layers * packing.plane
    part = x.dtype.type(1.0) / x.dtype.type(packing.layers)
    for q in range(3):
        first = np.uint64(q) * (mid + plane)
        for i in range(plane):
            x[first + mid + i] = x[first + i]
        for k in range(ONE, packing.layers):
            for i in range(plane):
                x[first + mid + i] += x[first + k * plane + i]
        for i in range(plane):
            x[first + mid + i] *= part


@njit(**OPTIONS)
def clear(packing: Packing, force: np.ndarray) -> None:
    """No force on the mid-surface."""
    plane, mid = packing.plane, packing.layers * packing.plane
    for q in range(3):
        first = np.uint64(q) * (mid + plane) + mid
        for i in range(plane):
            force[first + i] = 0.0


@njit(**OPTIONS)
def share(packing: Packing, force: np.ndarray) -> None:
    """Give the force on the mid-surface to the layers, equally."""
    plane, mid = packing.plane, packing.layers * packing.plane
    part = force.dtype.type(1.0) / force.dtype.type(packing.layers)
    for q in range(3):
        first = np.uint64(q) * (mid + plane)
        for k in range(packing.layers):
            for i in range(plane):
                force[first + k * plane + i] += part * force[first + mid + i]
