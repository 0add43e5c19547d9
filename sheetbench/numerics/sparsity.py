"""Assembly of element matrices into a compressed sparse matrix whose pattern is computed once.

Every entry of every element matrix has a slot in the matrix's data. Held unknowns carry the number −1 and
are left out.
"""

from __future__ import annotations

from copy import copy
from functools import cached_property

import numpy as np
from scipy.sparse import csr_matrix

from sheetbench.numerics.aliasing import empty
from sheetbench.numerics.cache import cached
from sheetbench.numerics.fronts import CoupledCells, Fronts, fronts_of
from sheetbench.numerics.options import njit


class Pattern:
    """Sparsity pattern of one kind of element or of several.

    unknowns: for every kind (m, k), the numbers of each element's unknowns in 0 … size − 1, −1 if held.
    places: of all elements in the plane (M, 2), for the order of elimination. cells: the unknowns of all
    elements (M, widest k), padded with −1. slots: for every kind (m, k, k), the place of an entry in the
    data, −1 if it is left out.
    """

    def __init__(self, *unknowns: np.ndarray, size: int, places: np.ndarray | None = None):
        self.size, self._places = size, places
        widths = [number.shape[1] for number in unknowns]
        room = [((0, 0), (0, max(widths) - width)) for width in widths]
        padded = [np.pad(u, r, constant_values=-1) for u, r in zip(unknowns, room, strict=True)]
        self.cells = np.concatenate(padded).astype(np.int64)
        entries, widest = self.cells.ravel(), max(widths)
        touching = np.argsort(entries, kind="stable")[np.count_nonzero(entries < 0) :]
        ends = np.searchsorted(entries[touching], np.arange(size + 1))
        one = np.ones(len(touching), bool)
        having = csr_matrix((one, touching // widest, ends), shape=(size, len(self.cells)))
        matrix = having @ having.T
        matrix.sort_indices()
        self._columns, self._starts = matrix.indices.astype(np.int32), matrix.indptr.astype(np.int32)
        slots = _slots(self._columns, self._starts, self.cells, touching, ends)
        kinds = np.split(slots, np.cumsum([len(number) for number in unknowns])[:-1])
        own = zip(kinds, widths, strict=True)
        self.slots = [np.ascontiguousarray(kind[:, :width, :width]) for kind, width in own]
        self._diagonal = np.flatnonzero(self._columns == np.repeat(np.arange(size), np.diff(self._starts)))

    @cached_property
    def fronts(self) -> Fronts:
        """Return the fronts of the matrix."""
        assert self._places is not None
        return fronts_of(self._columns, self._starts, CoupledCells(self.cells, self._places))

    def matrix(self, *blocks: np.ndarray, diagonal: np.ndarray | None = None) -> csr_matrix:
        """Return the sum of element matrices (m, k, k) of the first kinds, and of a diagonal (size,)."""
        data = self.zeros(diagonal)
        for slots, block in zip(self.slots, blocks, strict=False):
            add_blocks(data, slots, block)
        return self.with_data(data)

    def zeros(self, diagonal: np.ndarray | None = None) -> np.ndarray:
        """Return the data of a zero matrix, or of a diagonal (size,), to which blocks can be added."""
        data = np.zeros(len(self._columns))
        if diagonal is not None:
            data[self._diagonal] = diagonal
        return data

    def with_data(self, data: np.ndarray) -> csr_matrix:
        """Return the matrix (size, size) with given data."""
        matrix = copy(self._empty)  # SciPy would check the indices again
        matrix.data = data
        return matrix

    @cached_property
    def _empty(self) -> csr_matrix:
        shape = (self.size, self.size)
        data = np.broadcast_to(0.0, len(self._columns))
        matrix = csr_matrix((data, self._columns, self._starts), shape=shape)
        matrix.has_canonical_format = True
        return matrix


@cached(last=8, most=1 << 20)
def pattern_of(places: np.ndarray, *unknowns: np.ndarray, size: int) -> Pattern:
    """Return the pattern of elements at places; the last few small patterns are cached."""
    return Pattern(*unknowns, size=size, places=places)


@njit
def _slots(
    columns: np.ndarray, rows: np.ndarray, cells: np.ndarray, touching: np.ndarray, ends: np.ndarray
) -> np.ndarray:
    """Return the place in the data of every entry of all element matrices (M, k, k), −1 if it is left out.

    columns, rows: of the matrix. touching: flat places in `cells` (M, k) of the unknowns in order, from ends
    (size + 1,) on.
    """
    m, k = cells.shape
    out, place = empty((m, k, k), np.int32), empty(len(rows), np.int32)
    out[:] = -1
    for row in range(len(rows) - 1):
        for at in range(rows[row], rows[row + 1]):
            place[columns[at]] = at
        for t in range(ends[row], ends[row + 1]):
            cell, i = touching[t] // k, touching[t] % k
            for j in range(k):
                if cells[cell, j] >= 0:
                    out[cell, i, j] = place[cells[cell, j]]
    return out


@njit
def add_blocks(data: np.ndarray, slots: np.ndarray, blocks: np.ndarray) -> None:
    """Add element matrices (m, k, k) to a matrix's data at their slots, −1 for none."""
    places, values = slots.ravel(), blocks.ravel()
    for i in range(len(places)):
        if places[i] >= 0:
            data[places[i]] += values[i]
