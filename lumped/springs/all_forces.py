"""The forces of all springs and dampers of a lattice in one compiled pass, arrays in and arrays out.

`add_forces` takes displacements and velocities (n, 3) as everyone has them; `add_at_places` is for whoever
keeps them in the order of a `Packing`, flat. The forces are those of the families
(`lumped.springs.families`), to rounding.
"""

from __future__ import annotations

import numpy as np

from lumped.springs import packing as kinds
from lumped.springs import tiles
from lumped.springs.cell_laws import AreaAndStrains
from lumped.springs.packing import Packing, Scratch
from lumped.springs.tiles import LANES, NUMBA_FALSE, NUMBA_TRUE, OPTIONS, R6, R11
from sheetbench.numerics.typed import njit

CELLS, FACES = np.uint64(kinds.CELLS), np.uint64(kinds.FACES)
UINT_ONE = np.uint64(1)


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
    order, size = packing.order, packing.size
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
    """Add internal and damping forces as `add_forces` does, u, v and force flat at the places of a packing.
    The mid-surface's places of u are written to."""
    if packing.mid:
        average(packing, u)
    return _pass(u, v, NUMBA_TRUE, elastic, damped, NUMBA_TRUE, packing, force, tile)


@njit(**OPTIONS)
def add_damping_again(
    u: np.ndarray, v: np.ndarray, packing: Packing, force: np.ndarray, tile: np.ndarray
) -> float:
    """Add the damping force at velocity v once more, at the displacement u of the last pass, whose shapes
    are taken if the packing keeps them; the power taken [W]. The mid-surface's places of v are written to."""
    return _pass(u, v, not packing.keeping, NUMBA_FALSE, NUMBA_TRUE, NUMBA_TRUE, packing, force, tile)[1]


@njit(**OPTIONS)
def power_again(v: np.ndarray, packing: Packing, scratch: Scratch) -> float:
    """Return the power [W] that dampers take at velocity v (n, 3) [m/s], at the displacement of the last
    `add_forces`."""
    for q in range(3):
        past = np.uint64(q) * packing.size
        for p in range(len(packing.order)):
            scratch.v[past + np.uint64(p)] = v[packing.order[p], q]
    fresh, (at, speed, force, tile) = not packing.keeping, scratch
    return _pass(at, speed, fresh, NUMBA_FALSE, NUMBA_TRUE, NUMBA_FALSE, packing, force, tile)[1]


@njit(**OPTIONS)
def _pass(
    u: np.ndarray,
    v: np.ndarray,
    fresh: bool,
    elastic: bool,
    damped: bool,
    pushed: bool,
    packing: Packing,
    force: np.ndarray,
    tile: np.ndarray,
) -> tuple[float, float]:
    """Energy and power of a pass that finds shapes (fresh) or takes those that were kept; forces are added if
    they are pushed."""
    if packing.mid:
        if damped:
            average(packing, v)
        clear(packing, force)
    size, rest, share = packing.size, packing.rest, 1.0 if elastic else 0.0
    energy = power = 0.0
    for r in range(len(packing.runs)):
        run = packing.runs[r]
        kind, blocks, t, a, b, at = run[0], run[1], run[2], run[3], run[4], run[7]
        if kind < CELLS:
            if fresh:
                energy += tiles.stretch_links(u, share, rest, t, a, b, size, blocks, tile, at)
            else:
                tile[: blocks * LANES] = 0.0
            if damped:
                power += tiles.resist_links(v, rest, t, a, b, size, blocks, tile, at)
            if pushed:
                tiles.pull_ends(-1.0, a, size, blocks, tile, at, force)
                tiles.pull_ends(1.0, b, size, blocks, tile, at, force)
            continue
        c, d = run[5], run[6]
        if fresh:
            tiles.gather_sides(u, a, b, c, d, size, blocks, tile)
            if kind == CELLS:
                energy += tiles.stretch_cells(
                    AreaAndStrains(rest), u, (a, b, c, d), size, share, t, blocks, tile, at
                )
            elif kind == FACES:
                energy += tiles.stretch_cells(packing.face, u, (a, b, c, d), size, share, t, blocks, tile, at)
            else:
                energy += tiles.stretch_cells(packing.law, u, (a, b, c, d), size, share, t, blocks, tile, at)
                tiles.push_warp(packing.law, (a, b, c, d), size, blocks, tile, force)
        else:
            tile[R6 : R11 + blocks * LANES] = 0.0
        if damped:
            tiles.gather_sides(v, a, b, c, d, size, blocks, tile)
            power += tiles.resist_cells(rest, t, blocks, tile, at)
        if pushed:
            tiles.push_corner(-0.5, -0.5, a, size, blocks, tile, force)
            tiles.push_corner(0.5, -0.5, b, size, blocks, tile, force)
            tiles.push_corner(0.5, 0.5, c, size, blocks, tile, force)
            tiles.push_corner(-0.5, 0.5, d, size, blocks, tile, force)
    if packing.mid and pushed:
        share_out(packing, force)
    return energy, power


@njit(**OPTIONS)
def average(packing: Packing, x: np.ndarray) -> None:
    """Put the layers' mean in the mid-surface's places."""
    plane, mid = packing.plane, packing.layers * packing.plane
    part = 1.0 / packing.layers
    for q in range(3):
        first = np.uint64(q) * packing.size
        for i in range(plane):
            x[first + mid + i] = x[first + i]
        for k in range(UINT_ONE, packing.layers):
            for i in range(plane):
                x[first + mid + i] += x[first + k * plane + i]
        for i in range(plane):
            x[first + mid + i] *= part


@njit(**OPTIONS)
def clear(packing: Packing, force: np.ndarray) -> None:
    """No force on the mid-surface."""
    plane, mid = packing.plane, packing.layers * packing.plane
    for q in range(3):
        first = np.uint64(q) * packing.size + mid
        for i in range(plane):
            force[first + i] = 0.0


@njit(**OPTIONS)
def share_out(packing: Packing, force: np.ndarray) -> None:
    """Give the force on the mid-surface to the layers, equally."""
    plane, mid = packing.plane, packing.layers * packing.plane
    part = 1.0 / packing.layers
    for q in range(3):
        first = np.uint64(q) * packing.size
        for k in range(packing.layers):
            for i in range(plane):
                force[first + k * plane + i] += part * force[first + mid + i]
