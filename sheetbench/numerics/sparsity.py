"""Element matrices into a compressed sparse matrix whose pattern is found once.

Every entry of every element matrix has a slot in the matrix's data. Held unknowns carry the number −1 and
are left out.
"""

from __future__ import annotations

from copy import copy
from functools import cached_property
from itertools import pairwise

import numpy as np
from scipy.sparse import csr_matrix

from sheetbench.numerics.fronts import CoupledCells, Fronts, fronts_of
from sheetbench.numerics.kept import kept
from sheetbench.numerics.typed import njit


class Pattern:
    """Of one kind of element or of several.

    unknowns: for every kind (m, k), the number of each element's unknowns in 0 … size − 1, or −1 where held;
    places: of all elements in the plane (M, 2), which the order of elimination goes by. slots: for every kind
    (m, k, k), where in the data an entry goes, −1 where it is left out.
    """

    def __init__(self, *unknowns: np.ndarray, size: int, places: np.ndarray | None = None):
        self.size = size
        self._unknowns, self._places = unknowns, places
        widths = np.concatenate([np.full(len(number), number.shape[1]) for number in unknowns])
        starts = np.concatenate([[0], np.cumsum(widths)])
        entries = np.concatenate([number.ravel() for number in unknowns]).astype(np.int64)
        touching = np.argsort(entries, kind="stable")[np.count_nonzero(entries < 0) :]
        element = np.repeat(np.arange(len(widths)), widths)[touching]
        ends = np.searchsorted(entries[touching], np.arange(size + 1))
        having = csr_matrix((np.ones(len(element), bool), element, ends), shape=(size, len(widths)))
        matrix = having @ having.T
        matrix.sort_indices()
        self._columns, self._starts = matrix.indices.astype(np.int32), matrix.indptr.astype(np.int32)
        blocks = np.concatenate([[0], np.cumsum(widths**2)])
        slots = _slots(self._columns, self._starts, entries, starts, touching, element, ends, blocks)
        kinds = pairwise(np.cumsum([0, *(number.size * number.shape[1] for number in unknowns)]))
        parts = zip(unknowns, kinds, strict=True)
        self.slots = [
            slots[first:last].reshape(*number.shape, number.shape[1]) for number, (first, last) in parts
        ]
        self._diagonal = np.flatnonzero(self._columns == np.repeat(np.arange(size), np.diff(self._starts)))

    @cached_property
    def fronts(self) -> Fronts:
        """Where everything goes in Cholesky factors."""
        assert self._places is not None
        return fronts_of(self._columns, self._starts, CoupledCells(self.cells, self._places))

    @property
    def cells(self) -> np.ndarray:
        """The unknowns of all elements (M, k), −1 where one has fewer or holds them."""
        out = np.full((sum(map(len, self._unknowns)), max(u.shape[1] for u in self._unknowns)), -1)
        first = 0
        for number in self._unknowns:
            out[first : first + len(number), : number.shape[1]] = number
            first += len(number)
        return out

    def matrix(self, *blocks: np.ndarray, diagonal: np.ndarray | None = None) -> csr_matrix:
        """Sum of element matrices (m, k, k) by kind, kinds left out being zero, and of a diagonal (size,)."""
        data = self.zeros(diagonal)
        for slots, block in zip(self.slots, blocks, strict=False):
            add_blocks(data, slots, block)
        return self.with_data(data)

    def zeros(self, diagonal: np.ndarray | None = None) -> np.ndarray:
        """The data of a zero matrix, or of one with a diagonal (size,), for blocks to be added to."""
        data = np.zeros(len(self._columns))
        if diagonal is not None:
            data[self._diagonal] = diagonal
        return data

    def with_data(self, data: np.ndarray) -> csr_matrix:
        """The matrix (size, size) with this data."""
        matrix = copy(self._empty)  # SciPy would look at the indices again
        matrix.data = data
        return matrix

    @cached_property
    def _empty(self) -> csr_matrix:
        shape = (self.size, self.size)
        data = np.broadcast_to(0.0, len(self._columns))
        matrix = csr_matrix((data, self._columns, self._starts), shape=shape)
        matrix.has_canonical_format = True
        return matrix


@kept(last=8, most=1 << 20)
def pattern_of(places: np.ndarray, *unknowns: np.ndarray, size: int) -> Pattern:
    """The pattern of elements at these places; of small ones the last few are kept."""
    return Pattern(*unknowns, size=size, places=places)


@njit(cache=True)
def _slots(
    columns: np.ndarray,
    rows: np.ndarray,
    entries: np.ndarray,
    starts: np.ndarray,
    touching: np.ndarray,
    element: np.ndarray,
    ends: np.ndarray,
    blocks: np.ndarray,
) -> np.ndarray:
    """Place in the data of every entry of all element matrices, −1 where it is left out.

    columns, rows: of the matrix; entries: of all elements one after the other, from starts (M + 1,) on;
    touching: places in `entries` of the unknowns in order, in element, from ends (size + 1,) on; blocks: the
    starts of the elements' matrices (M + 1,).
    """
    out = np.full(blocks[-1], -1, np.int32)
    place = np.empty(len(rows), np.int32)
    for row in range(len(rows) - 1):
        for at in range(rows[row], rows[row + 1]):
            place[columns[at]] = at
        for t in range(ends[row], ends[row + 1]):
            e = element[t]
            begin, width = starts[e], starts[e + 1] - starts[e]
            first = blocks[e] + (touching[t] - begin) * width
            for j in range(width):
                if entries[begin + j] >= 0:
                    out[first + j] = place[entries[begin + j]]
    return out


@njit(cache=True)
def add_blocks(data: np.ndarray, slots: np.ndarray, blocks: np.ndarray) -> None:
    """Add element matrices (m, k, k) to a matrix's data at their slots, −1 for none."""
    places, values = slots.ravel(), blocks.ravel()
    for i in range(len(places)):
        if places[i] >= 0:
            data[places[i]] += values[i]
