"""The forces of all springs and dampers of a lattice in one compiled pass; they equal the families' forces
(`lumped.springs.families`) to rounding.

`add_forces` takes arrays (n, 3); `at_places` takes flat arrays at the places of a `Packing`.
"""

from __future__ import annotations

import numpy as np

from lumped.springs import packing as kinds
from lumped.springs import tiles
from lumped.springs.law_table import AreaAndStrains
from lumped.springs.packing import Packing, Scratch
from lumped.springs.tiles import LANES, NUMBA_FALSE, NUMBA_TRUE, OPTIONS, R6, R11
from sheetbench.numerics.options import njit

CELLS, FACES, ONE, THREE = (np.uint64(number) for number in (kinds.CELLS, kinds.FACES, 1, 3))


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
    or one of them, to `force` (n, 3) [N]; return the energy [J] and the power taken [W]. Rows after the
    masses' rows are unchanged."""
    write_at_places(u, packing, scratch.u)
    if damped:
        write_at_places(v, packing, scratch.v)
    energy_and_power = at_places(NUMBA_TRUE, elastic, damped, NUMBA_TRUE, packing, scratch)
    add_from_places(scratch.force, packing, force)
    return energy_and_power


@njit(**OPTIONS)
def add_damping_from_shapes(
    v: np.ndarray, pushed: bool, packing: Packing, scratch: Scratch, force: np.ndarray
) -> float:
    """Return the power [W] of dampers at velocity v (n, 3) [m/s], at the displacement of the last
    `add_forces`, whose shapes are reused if the packing keeps them; add their force to `force` (n, 3) [N] if
    `pushed`."""
    write_at_places(v, packing, scratch.v)
    power = at_places(not packing.keeping, NUMBA_FALSE, NUMBA_TRUE, pushed, packing, scratch)[1]
    if pushed:
        add_from_places(scratch.force, packing, force)
    return power


@njit(**OPTIONS)
def at_places(
    fresh: bool, elastic: bool, damped: bool, pushed: bool, packing: Packing, at: Scratch
) -> tuple[float, float]:
    """Return the energy [J] and power [W] at the displacement and velocity stored in a packing's scratch
    arrays. fresh: compute the springs' shapes, else reuse them; pushed: write the forces too. The
    mid-surface's places are written to."""
    u, v, force, tile = at
    force[:] = 0.0
    if packing.mid:
        average(packing, u)
        if damped:
            average(packing, v)
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
        distribute_over_layers(packing, force)
    return energy, power


@njit(**OPTIONS)
def write_at_places(x: np.ndarray, packing: Packing, out: np.ndarray) -> None:
    """Write a vector (n, 3) to the places of a packing."""
    layers, plane, flat = packing.layers, packing.plane, x.reshape(-1)
    for q in range(THREE):
        for k in range(layers):
            for i in range(plane):
                out[q * packing.size + k * plane + i] = flat[THREE * (i * layers + k) + q]


@njit(**OPTIONS)
def add_from_places(x: np.ndarray, packing: Packing, out: np.ndarray) -> None:
    """Add a vector at the places of a packing to one (n, 3)."""
    layers, plane, flat = packing.layers, packing.plane, out.reshape(-1)
    for q in range(THREE):
        for k in range(layers):
            for i in range(plane):
                flat[THREE * (i * layers + k) + q] += x[q * packing.size + k * plane + i]


@njit(**OPTIONS)
def average(packing: Packing, x: np.ndarray) -> None:
    """Write the layers' mean to the mid-surface's places."""
    plane, mid = packing.plane, packing.layers * packing.plane
    for q in range(THREE):
        first = q * packing.size
        for i in range(plane):
            x[first + mid + i] = x[first + i] / packing.layers
        for k in range(ONE, packing.layers):
            for i in range(plane):
                x[first + mid + i] += x[first + k * plane + i] / packing.layers


@njit(**OPTIONS)
def distribute_over_layers(packing: Packing, force: np.ndarray) -> None:
    """Distribute the force on the mid-surface equally over the layers."""
    plane, mid = packing.plane, packing.layers * packing.plane
    for q in range(THREE):
        first = q * packing.size
        for k in range(packing.layers):
            for i in range(plane):
                force[first + k * plane + i] += force[first + mid + i] / packing.layers
        force[first + mid : first + mid + plane] = 0.0
