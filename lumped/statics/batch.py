"""Load paths of many small lattices as a single compiled call that holds no lock: arrays in, arrays out.

The lattices are alike: one grid, the same supports, the same springs between the same masses. Their rest
shapes, stiffness, loads and where supports move them differ. Each path is the one of
`lumped.statics.fused_path`, with room of its own.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from numba import njit

from lumped.springs.together import CellArrays, LinkArrays, Springs
from lumped.statics import fused_path
from lumped.statics.fused import Posed, Work
from sheetbench.numerics import banded

OWN = ("dead", "placed", "link_stiffness", "positions", "areas", "size")  # of `Posed`
Cells = tuple[np.ndarray, ...]  # of the two families of `Springs` after the links


class Batch(NamedTuple):
    """b lattices alike to the first, `like`, and of each, along the first axis, what is its own: offset
    (b, m, 3), rest_length, constants (b, m) of the links, sides, area and constants of the cells, and
    `Posed`'s dead, placed, link_stiffness, positions, areas and size."""

    like: Posed
    offset: np.ndarray
    rest_length: np.ndarray
    constants: np.ndarray
    sides: Cells
    area: Cells
    of_cells: Cells
    dead: np.ndarray
    placed: np.ndarray
    link_stiffness: np.ndarray
    positions: np.ndarray
    areas: np.ndarray
    size: np.ndarray


class Paths(NamedTuple):
    """Of each lattice: load_factor (b,) that its path reached, −1 where the flat sheet's tangent is not
    positive definite; displacement u (b, n, 3) [m] there; tangents factored (b,); lines of history
    (b, LINES, 3), as many as `lines` (b,) says; and the tangent at the end, as `Work`."""

    load_factor: np.ndarray
    u: np.ndarray
    factorisations: np.ndarray
    history: np.ndarray
    lines: np.ndarray
    blocks: np.ndarray
    matrix: np.ndarray
    factors: np.ndarray


def alike(one: Posed, other: Posed) -> bool:
    """Whether two lattices can be in one batch."""
    if one.band is not other.band or one.rows is not other.rows or one.moves != other.moves:
        return False
    same = all(
        np.array_equal(a.nodes, b.nodes) for a, b in zip(_families(one), _families(other), strict=True)
    )
    return same and np.array_equal(one.held, other.held)


def batch(lattices: Sequence[Posed]) -> Batch:
    """The batch of lattices that are `alike`."""
    links = [lattice.springs.links for lattice in lattices]
    cells = list(zip(*(_families(lattice)[1:] for lattice in lattices), strict=True))
    return Batch(
        lattices[0],
        np.stack([own.offset for own in links]),
        np.stack([own.rest_length for own in links]),
        np.stack([own.constants for own in links]),
        tuple(np.stack([own.sides for own in family]) for family in cells),
        tuple(np.stack([own.area for own in family]) for family in cells),
        tuple(np.stack([own.constants for own in family]) for family in cells),
        *(np.stack([getattr(lattice, name) for lattice in lattices]) for name in OWN),
    )


def _families(lattice: Posed) -> tuple[Any, ...]:
    return tuple(lattice.springs)


@njit(cache=True, nogil=True)
def paths(given: Batch) -> Paths:
    """Every lattice's path from the flat sheet to full load, as far as it goes."""
    count, n = len(given.size), len(given.like.held)
    rows, width = banded.shape(given.like.band)
    load_factor, u = np.empty(count), np.empty((count, n, 3))
    factorisations, lines = np.empty(count, np.int64), np.empty(count, np.int64)
    history = np.empty((count, fused_path.LINES, 3))
    blocks = np.empty((count, given.like.blocks, 3, 3))
    matrix, factors = np.empty((count, rows, width)), np.empty((count, rows, width))
    for at in range(count):
        done = fused_path.followed(lattice(given, at), Work(blocks[at], matrix[at], factors[at]))
        load_factor[at] = done.load_factor if done.definite else -1.0
        u[at] = done.u
        factorisations[at], lines[at] = done.factorisations, len(done.history)
        history[at, : len(done.history)] = done.history
    return Paths(load_factor, u, factorisations, history, lines, blocks, matrix, factors)


@njit(cache=True, nogil=True)
def lattice(given: Batch, at: int) -> Posed:
    """One of the lattices."""
    like = given.like
    links, a, b = like.springs.links, like.springs.layers, like.springs.middle
    sides, area, constants = given.sides, given.area, given.of_cells
    springs = Springs(
        LinkArrays(links.nodes, given.offset[at], given.rest_length[at], given.constants[at], links.slots),
        CellArrays(a.nodes, sides[0][at], area[0][at], constants[0][at], a.slots),
        CellArrays(b.nodes, sides[1][at], area[1][at], constants[1][at], b.slots),
    )
    return Posed(
        springs, like.blocks, like.rows, like.indices, like.band, like.free, like.held, given.dead[at],
        given.placed[at], like.moves, given.link_stiffness[at], like.columns, given.positions[at],
        given.areas[at], given.size[at],
    )  # fmt: skip
