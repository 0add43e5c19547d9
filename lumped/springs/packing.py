"""The springs and dampers of a lattice as flat arrays: runs of springs, and tables of rest data.

Masses are numbered plane by plane, y then x within, and after the layers comes their mean, the mid-surface,
whose cells act equally on all layers. Springs then fall into runs with constant distances between their
masses, cut where a tile is full, at equal places of every line of masses: so equal runs, most of an even
grid's, share their rest data, which stay in the fastest memory. A run continues from the end of a line to the
next over springs without stiffness.
"""

import math
from collections.abc import Sequence
from itertools import pairwise, zip_longest
from typing import NamedTuple

import numpy as np

from lumped.lattice import Lattice
from lumped.pattern import PATTERN_CACHE, SHARED_UP_TO
from lumped.springs.families import NO_CELLS, Family, Links, SpringCells
from lumped.springs.law_table import AREA_AND_STRAINS, FACE, RUBBER, AreaAndStrains, Tag
from lumped.springs.tiles import CELL_DATA, CELL_SHAPE, LANES, LAW, LINK_DATA, LINK_SHAPE, STRIDE, USED, WIDTH
from sheetbench.numerics.cache import cached
from sheetbench.scenes.objects.grid import Grid

LINKS, CELLS, RUBBER_CELLS, FACES = range(4)
BLOCK = int(LANES)
CACHE_LIMIT = (
    2**18
)  # numbers of all kept shapes: computing them is faster than reading from beyond the caches
LARGEST_GAP = 4  # largest distance in places from one spring of a run to the next
OF_LAWS = {CELLS: AREA_AND_STRAINS, RUBBER_CELLS: RUBBER, FACES: FACE}
ROWS = {LINKS: LINK_DATA} | {kind: CELL_DATA[law.tag] for kind, law in OF_LAWS.items()}
ABSENT_SPRING = {  # rest data of places without a spring: a link or a cell of side 1 [m]
    LINKS: (1.0, 0.0, 0.0, 1.0),
    **dict.fromkeys(OF_LAWS, (1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 1.0, 1.0, 0.0, 1.0)),
}


class Packing(NamedTuple):
    """Springs and dampers as flat arrays. order: (n,) mass at each place; layers, plane: number of planes,
    and of masses in each; size: places of a component, with spare ones after the mid-surface's for blocks
    that are not full; mid: whether there are cells on the mid-surface; damped: whether there are dampers;
    runs: (r, 8), kind of each run, number of blocks of springs, start of its rest data, its first four (or
    two) masses, and place of its shapes in a tile; rest: rest data, flat; keeping: whether shapes are kept
    for dampers, each run's in a separate place; length: of a tile with the kept shapes; law, face: tags of
    rubber and of upright faces with the rest data, or of area and strains in a lattice without them."""

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
    law: Tag
    face: Tag


class Scratch(NamedTuple):
    """Work arrays for forces: displacement, velocity and force of every place, flat, and a tile."""

    u: np.ndarray
    v: np.ndarray
    force: np.ndarray
    tile: np.ndarray


def scratch(packing: Packing) -> Scratch:
    """Return work arrays for the forces of a packing."""
    u, v, force = np.zeros((3, 3 * int(packing.size)))
    return Scratch(u, v, force, np.zeros(packing.length))


class Topology(NamedTuple):
    """Runs of springs of one kind, without rest data. Springs and dampers between equal masses share a place.
    number: (m,) of each spring's place; run, place: (s,) run of each place and position in the run; runs: (r,
    5) number of blocks, and the first spring's masses."""

    number: np.ndarray
    run: np.ndarray
    place: np.ndarray
    runs: np.ndarray


def pack(lattice: Lattice, springs: Sequence[Family], dampers: Sequence[Family]) -> Packing:
    """Return the springs and dampers of a lattice as flat arrays."""
    nx, ny, layers = lattice.grid
    plane = nx * ny
    runs, rest, used, mid = [], [np.empty(0)], 0, False
    for both in zip_longest(springs, dampers, fillvalue=NO_CELLS):
        parts = [(family, damped) for family, damped in zip(both, (False, True), strict=True) if len(family)]
        if not parts:
            continue
        law = getattr(parts[0][0], "law", None)
        kind = next((kind for kind, of_kind in OF_LAWS.items() if of_kind is law), LINKS)
        nodes = {id(family.nodes): family.nodes for family, _ in parts}
        mid = mid or parts[0][0].nodes[0].size > 4
        topology = _topology(lattice.grid, *nodes.values())
        ends = np.cumsum([len(part) for part in nodes.values()])
        number = dict(zip(nodes, np.split(topology.number, ends), strict=False))
        rows = np.zeros((ROWS[kind], len(topology.run)))
        for family, damped in parts:
            _add_data(family, damped, number[id(family.nodes)], rows)
        begins, tables = _tables(kind, topology, rows)
        runs.append(np.column_stack([np.full(len(begins), kind), topology.runs, used + begins]))
        rest.append(tables)
        used += tables.size
    table = np.concatenate([np.empty((0, 7), int), *runs])[:, [0, 1, 6, 2, 3, 4, 5, 6]].astype(np.uint64)
    table = table[np.argsort(table[:, 3] % plane, kind="stable")]  # masses stay in the fastest memory
    keeping, length = _place_shapes(table, bool(dampers))
    data = np.concatenate(rest)
    return Packing(
        np.arange(plane * layers).reshape(-1, layers).T.ravel(),
        np.uint64(layers),
        np.uint64(plane),
        np.uint64(_in_blocks((layers + 1) * plane + BLOCK - 1) * BLOCK),
        mid,
        bool(dampers),
        table,
        data,
        keeping,
        length,
        *(
            (OF_LAWS[kind].tag if kind in table[:, 0] else AreaAndStrains)(data)
            for kind in (RUBBER_CELLS, FACES)
        ),
    )


def _in_blocks(count: int) -> int:
    return -(-count // BLOCK)


def _place_shapes(runs: np.ndarray, damped: bool) -> tuple[bool, int]:
    """Write the offset of each run's shapes into runs (r, 8), one offset for all without dampers or with too
    many shapes; return whether offsets differ, and the length of a tile."""
    rows = np.where(runs[:, 0] >= CELLS, CELL_SHAPE, LINK_SHAPE)
    before = np.append(0, np.cumsum(rows)).astype(int)
    keeping = damped and STRIDE * int(before[-1]) <= CACHE_LIMIT
    runs[:, 7] = STRIDE * (USED + before[:-1] * keeping)
    return keeping, STRIDE * (USED + int(before[-1] if keeping else rows.max(initial=0)))


def _add_data(family: Family, damped: bool, at: np.ndarray, data: np.ndarray) -> None:
    """Set the rest geometry, and add the constants, of a family's springs in rest data (rows, s) at their
    numbers (m,)."""
    if isinstance(family, Links):
        rest = (*family.offset.T, family.rest_length)
        constants = family.stiffness[None]
        first = 4 if damped else 5
    else:
        assert isinstance(family, SpringCells)
        a, b = family.sides[:, 0], family.sides[:, 1]
        rest = (*a.T, *b.T, *(np.einsum("ij,ij->i", *pair) for pair in ((a, a), (b, b), (a, b))), family.area)
        constants = family.constants.T
        first = 10 if damped else LAW
    for row, values in zip(data, rest, strict=False):
        row[at] = values
    for row, values in zip(data[first:], constants, strict=False):
        row[at] += values


@cached(last=PATTERN_CACHE, most=SHARED_UP_TO, size=lambda grid, *_: math.prod(grid))
def _topology(grid: Grid, *nodes: np.ndarray) -> Topology:
    """Return the topology of springs (m, 2) or (m, 4, p) of one kind, sorted by the distances between their
    masses, then by their first mass, and cut into runs."""
    width, _, layers = grid
    plane = grid[0] * grid[1]
    places = []  # a mass n = c layers + k of column c is at place k plane + c, a column's mean behind them
    for part in nodes:
        first = part[:, :, 0] if part.ndim == 3 else part
        layer = layers if part.ndim == 3 and part.shape[2] > 1 else first % layers
        places.append(layer * plane + first // layers)
    at = np.concatenate(places)
    total = (layers + 1) * plane
    to_first = at[:, 1:] - at[:, :1]
    distances = to_first[:, 0]
    for column in to_first.T[1:]:
        distances = distances * (2 * total + 1) + column
    order = np.lexsort((at[:, 0], distances))
    first, distances = at[order, 0], distances[order]
    distinct = np.append(True, (first[1:] != first[:-1]) | (distances[1:] != distances[:-1]))
    number = np.empty(len(order), dtype=int)
    number[order] = np.cumsum(distinct) - 1
    first, distances = first[distinct], distances[distinct]
    lines, columns = max(1, WIDTH // width), -(-width // -(-width // WIDTH))
    in_plane = first % plane
    tile = [first // plane, in_plane // width // lines, distances]
    if width > WIDTH:
        tile.append(in_plane % width // columns)
    cut = np.diff(first) > LARGEST_GAP
    for part in tile:
        cut |= part[1:] != part[:-1]
    begins = np.append(0, np.flatnonzero(cut) + 1)
    run = np.append(0, np.cumsum(cut))
    runs = np.zeros((len(begins), 5), dtype=int)
    runs[:, 0] = _in_blocks(first[np.append(begins[1:], len(first)) - 1] - first[begins] + 1)
    runs[:, 1 : 1 + at.shape[1]] = at[order[distinct][begins]]
    return Topology(number, run, first - first[begins][run], runs)


def _tables(kind: int, topology: Topology, data: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the start of each run's rest data, (r,), and the rest data, flat, in tables (rows, STRIDE), from
    the springs' rest data (rows, s); equal runs have one table."""
    absent = np.zeros((len(data), STRIDE))
    absent[: len(ABSENT_SPRING[kind])] = np.array(ABSENT_SPRING[kind])[:, None]
    begins, tables, numbers = [], list[np.ndarray](), dict[bytes, int]()
    data = np.vstack([data, topology.place]) + 0.0  # no negative zeros
    ends = np.searchsorted(topology.run, np.arange(len(topology.runs) + 1))
    for first, last in pairwise(ends.tolist()):
        run = data[:, first:last]
        begins.append(numbers.setdefault(run.tobytes(), len(numbers)))
        if begins[-1] == len(tables):
            tables.append(absent.copy())
            tables[-1][:, topology.place[first:last]] = run[:-1]
    return absent.size * np.array(begins), np.concatenate(tables).ravel()
