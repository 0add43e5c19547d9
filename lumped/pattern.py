"""Block sparsity of a lattice's matrices: pairs of masses that act on each other, and their 3×3 blocks."""

import math
from functools import cached_property

import numpy as np

from sheetbench.numerics.cache import cached
from sheetbench.numerics.fronts import CoupledCells
from sheetbench.scenes.objects.grid import Grid

SHARED_UP_TO = 3000  # masses up to which data that depend on the grid alone are cached
PATTERN_CACHE = 32  # sets of masses whose block numbers a small pattern caches


class MassPattern:
    """Sorted pairs (row, column) of masses that act on each other, stored as in BSR.

    cells: the masses of every cell and its place in the grid, if only masses of one cell act on each other.
    """

    def __init__(self, size: int, rows: np.ndarray, columns: np.ndarray, cells: CoupledCells | None = None):
        keys = rows.astype(np.int64) * size + columns
        keys.sort()
        keys = keys[np.append(True, keys[1:] != keys[:-1])]  # np.unique takes ten times as long
        self.size, self._keys, self.cells = size, keys, cells
        self.rows, self.indices = keys // size, (keys % size).astype(np.int32)
        self.indptr = np.searchsorted(self.rows, np.arange(size + 1)).astype(np.int32)
        self._cache: dict[tuple[tuple[int, ...], bytes], np.ndarray] = {}

    @cached_property
    def mirror(self) -> np.ndarray:
        """Block numbers of every pair (row, column) below the diagonal and of (column, row), (k, 2)."""
        below = np.flatnonzero(self.rows > self.indices).astype(np.int32)
        return np.stack([below, self.slots(self.indices[below], self.rows[below])], axis=1)

    @cached_property
    def diagonal(self) -> np.ndarray:
        """Block number of every mass with itself, (n,)."""
        return self.slots(np.arange(self.size), np.arange(self.size))

    @property
    def blocks(self) -> int:
        """Number of blocks."""
        return len(self._keys)

    def slots(self, rows: np.ndarray, columns: np.ndarray) -> np.ndarray:
        """Return the block numbers of pairs (any shape)."""
        slots: np.ndarray = np.searchsorted(self._keys, np.asarray(rows, np.int64) * self.size + columns)
        return slots.astype(np.int32)

    def among(self, nodes: np.ndarray) -> np.ndarray:
        """Return the block numbers (m, p, p) of every pair within each row of masses (m, p); the array must
        not be written to, since a small pattern caches it for all lattices on a grid."""
        if self.size > SHARED_UP_TO:
            return self._among(nodes)
        key = nodes.shape, nodes.tobytes()
        slots = self._cache.get(key)
        if slots is None:
            if len(self._cache) == PATTERN_CACHE:
                self._cache.clear()
            slots = self._cache[key] = self._among(nodes)
        return slots

    def _among(self, nodes: np.ndarray) -> np.ndarray:
        return self.slots(nodes[:, :, None], nodes[:, None, :])


@cached(last=16, most=SHARED_UP_TO, size=lambda grid, present=None: math.prod(grid))
def of_grid(grid: Grid, present: np.ndarray | None = None) -> MassPattern:
    """Return the pattern of a lattice on a grid, without actuators and without cells that are not `present`;
    small patterns are cached."""
    nx, ny, layers = grid
    columns = np.arange(nx * ny * layers).reshape(ny, nx, layers)
    masses = cells_of(columns).reshape(-1, 4 * layers)
    number, alone = np.arange(len(masses)), np.empty(0, dtype=int)
    if present is not None:
        number = np.flatnonzero(present)
        alone, masses = np.setdiff1d(columns, masses[number]), masses[number]
    j, i = np.divmod(number, nx - 1)
    rows, others = (np.concatenate([part, alone]) for part in _pairs(masses))
    cells = CoupledCells(masses, np.stack([i, j], axis=1).astype(float))
    return MassPattern(columns.size, rows, others, cells)


def neighbours(columns: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the ordered pairs of masses that may act on each other, any two in the four columns of a cell of
    the plan; columns: (ny, nx, layers)."""
    return _pairs(cells_of(columns).reshape(-1, 4 * columns.shape[2]))


def _pairs(nodes: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    p = nodes.shape[1]
    return np.repeat(nodes, p, axis=1).ravel(), np.tile(nodes, (1, p)).ravel()


def cells_of(columns: np.ndarray) -> np.ndarray:
    """Return the four columns of masses, in turn, of every cell of the plan, (cells, 4, layers)."""
    corners = np.stack([columns[:-1, :-1], columns[:-1, 1:], columns[1:, 1:], columns[1:, :-1]], axis=2)
    return corners.reshape(-1, 4, columns.shape[2])
