"""The springs and dampers of a lattice as flat arrays: runs of springs, and what each spring is at rest.

Masses are numbered plane by plane, y then x within, and after the layers comes their mean, the mid-surface,
whose cells act on all layers alike. Springs then fall into runs with the same distances between their masses,
cut where a tile is full, at the same places of every line of masses: so runs that are alike, most of an even
grid's, share their rest data, which stay in the fastest memory. From the end of a line to the next a run goes
on over springs without stiffness.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np

from lumped.lattice import Lattice
from lumped.springs import cell_tiles, link_tiles
from lumped.springs.families import Cells, DirectionalLinks, Links
from lumped.springs.family import Dampers, Family
from lumped.springs.tiles import LANES, STRIDE, WIDTH

LINKS, DIRECTIONAL, CELLS = range(3)
BLOCK = int(LANES)
KEPT = 2**18  # numbers of all shapes at most: from beyond the caches they come slower than they are found
BRIDGED = 4  # places at most from one spring of a run to the next
ROWS = {LINKS: link_tiles.DATA, DIRECTIONAL: link_tiles.DATA, CELLS: cell_tiles.DATA}
GEOMETRY = {LINKS: (0, 1, 2, 3), DIRECTIONAL: (0, 1, 2, 3), CELLS: tuple(range(10))}
NOTHING = {  # rest data where there is no spring: a link or a cell of side 1 [m]
    LINKS: (1.0, 0.0, 0.0, 1.0),
    DIRECTIONAL: (1.0, 0.0, 0.0, 1.0),
    CELLS: (1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 1.0, 1.0, 0.0, 1.0),
}


class Packing(NamedTuple):
    """order: (n,) mass at each place; layers, plane: how many planes, and of how many masses; size: places
    of a component, with some to spare after the mid-surface's for blocks that are not full; mid: whether
    there are cells on the mid-surface; damped: whether there are dampers; runs: (r, 8), of each what it is,
    its blocks of springs, where its rest data begin, its first four (or two) masses, and where in a tile its
    shapes are kept; rest: rest data, flat; keeping: whether shapes are kept for dampers, those of each run in
    a place of its own; length: of a tile with what is kept."""

    order: np.ndarray
    layers: np.uint64
    plane: np.uint64
    size: np.uint64
    mid: bool
    damped: bool
    runs: np.ndarray
    rest: np.ndarray
    keeping: bool
    length: int


class Scratch(NamedTuple):
    """Where forces are computed: displacement, velocity and force of every place, flat, and a tile."""

    u: np.ndarray
    v: np.ndarray
    force: np.ndarray
    tile: np.ndarray


def scratch(packing: Packing) -> Scratch:
    """Room for whoever asks for forces."""
    kind, size = packing.rest.dtype, 3 * int(packing.size)
    tile = np.zeros(packing.length, kind)
    return Scratch(np.zeros(size, kind), np.zeros(size, kind), np.zeros(size, kind), tile)


def pack(
    lattice: Lattice, springs: Sequence[Family], dampers: Sequence[Dampers], single: bool = False
) -> Packing:
    """Springs and dampers of a lattice. single: rest data, and with them all forces, in single precision."""
    planes = np.moveaxis(lattice.columns(), 2, 0)
    layers, plane, width = len(planes), planes[0].size, lattice.grid[0]
    place = np.empty(layers * plane, dtype=int)
    place[planes.ravel()] = np.arange(layers * plane)
    mid = False
    found: dict[int, list[tuple[np.ndarray, np.ndarray]]] = {LINKS: [], DIRECTIONAL: [], CELLS: []}
    for family, damped in [*((s, False) for s in springs), *((d.family, True) for d in dampers)]:
        nodes = place[family.nodes]
        if nodes.ndim == 3:
            mean = nodes.shape[2] > 1
            mid = mid or mean
            nodes = nodes[:, :, 0] % plane + layers * plane if mean else nodes[:, :, 0]
        kind, data = _data(family, damped)
        found[kind].append((nodes, data))
    runs, rest, used = [], [np.empty(0)], 0
    for kind, parts in found.items():
        if not sum(len(nodes) for nodes, _ in parts):
            continue
        nodes, data = _merged(kind, *(np.concatenate(part) for part in zip(*parts, strict=True)))
        tables: dict[bytes, int] = {}
        for of_run, table in _runs(kind, nodes, data, width, plane):
            key = table.tobytes()
            if key not in tables:
                tables[key] = used
                rest.append(table.ravel())
                used += table.size
            of_run[2] = tables[key]
            runs.append(of_run)
    table = np.array(runs, dtype=np.uint64).reshape(-1, 8)
    table = table[np.argsort(table[:, 3] % plane, kind="stable")]  # masses stay in the fastest memory
    keeping, length = _place_shapes(table, bool(dampers))
    return Packing(
        planes.ravel(),
        np.uint64(layers),
        np.uint64(plane),
        np.uint64(_in_blocks((layers + 1) * plane + BLOCK - 1) * BLOCK),
        mid,
        bool(dampers),
        table,
        np.concatenate(rest).astype(np.float32 if single else float),
        keeping,
        length,
    )


def _in_blocks(count: int) -> int:
    return -(-count // BLOCK)


def _place_shapes(runs: np.ndarray, damped: bool) -> tuple[bool, int]:
    """Set where the shapes of each run (r, 8) are kept, all in one place where none are asked for again, or
    there are too many; whether each has its own, and a tile's length."""
    rows = np.where(runs[:, 0] == CELLS, cell_tiles.SHAPE, link_tiles.SHAPE)
    before = np.append(0, np.cumsum(rows)).astype(int)
    keeping = damped and STRIDE * int(before[-1]) <= KEPT
    runs[:, 7] = STRIDE * (cell_tiles.USED + before[:-1] * keeping)
    return keeping, STRIDE * (cell_tiles.USED + int(before[-1] if keeping else rows.max(initial=0)))


def _data(family: Family, damped: bool) -> tuple[int, np.ndarray]:
    """What the springs of a family are, and their rest data, (m, rows)."""
    k = family.stiffness
    if isinstance(family, Links):
        data = np.zeros((len(family), link_tiles.DATA))
        data[:, :3], data[:, 3] = family.offset, family.rest_length
        if isinstance(family, DirectionalLinks):
            data[:, 5:8] = k
            return DIRECTIONAL, data
        data[:, 4 if damped else 5] = k
        return LINKS, data
    assert isinstance(family, Cells)
    data = np.zeros((len(family), cell_tiles.DATA))
    a, b = data[:, :3], data[:, 3:6] = family.sides[:, 0], family.sides[:, 1]
    data[:, 6], data[:, 7], data[:, 8] = (a * a).sum(axis=1), (b * b).sum(axis=1), (a * b).sum(axis=1)
    data[:, 9] = family.area
    data[:, slice(14, 18) if damped else slice(10, 14)] = family.constants
    return CELLS, data


def _merged(kind: int, nodes: np.ndarray, data: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Springs (m, corners) and their data, those of the same masses in one; by distances, then in order."""
    apart = nodes[:, 1:] - nodes[:, :1]
    order = np.lexsort((nodes[:, 0], *apart.T))
    nodes, data = nodes[order], data[order]
    fresh = np.flatnonzero(np.append(True, (nodes[1:] != nodes[:-1]).any(axis=1)))
    merged = np.add.reduceat(data, fresh, axis=0)
    geometry = list(GEOMETRY[kind])
    merged[:, geometry] = data[fresh][:, geometry]
    return nodes[fresh], merged


def _runs(
    kind: int, nodes: np.ndarray, data: np.ndarray, width: int, plane: int
) -> Iterator[tuple[list[int], np.ndarray]]:
    """Runs, where their rest data begin left out, and their rest data (rows, STRIDE)."""
    first = nodes[:, 0]
    apart = nodes - first[:, None]
    lines, columns = max(1, WIDTH // width), -(-width // -(-width // WIDTH))
    within = first % plane
    tile = (
        first // plane,
        within // width // lines,
        within % width // columns if width > WIDTH else 0 * first,
    )
    parted = (apart[1:] != apart[:-1]).any(axis=1) | (np.diff(first) > BRIDGED)
    for part in tile:
        parted |= np.diff(part) != 0
    begins = np.append(0, np.flatnonzero(parted) + 1)
    ends = np.append(begins[1:], len(first))
    for begin, end in zip(begins.tolist(), ends.tolist(), strict=True):
        table = np.zeros((ROWS[kind], STRIDE))
        table[list(GEOMETRY[kind])] = np.array(NOTHING[kind])[:, None]
        table[:, first[begin:end] - first[begin]] = data[begin:end].T
        corners = nodes[begin].tolist() + [0] * (4 - nodes.shape[1])
        yield [kind, _in_blocks(int(first[end - 1] - first[begin]) + 1), 0, *corners, 0], table
