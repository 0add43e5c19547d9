"""Tᵀ K T of a matrix K in 3×3 blocks: where every entry of K goes, found once for a pattern.

The reduced matrix has sorted rows by columns (CSC). Entry e of the map adds weight[e] times entry source[e]
of the blocks, laid out one after the other, to the nonzero k with starts[k] ≤ e < starts[k + 1]. Where all
weights are one, as without hinges and actuators, none are kept, nor starts where every nonzero has one entry.
"""

from __future__ import annotations

from typing import NamedTuple, Protocol

import numpy as np
import scipy.sparse as sp

from sheetbench.numerics.fronts import CoupledCells
from sheetbench.numerics.typed import njit


class BlockPattern(Protocol):
    """Blocks (b,) of a symmetric pattern over n nodes, as in BSR: rows, indices (b,), indptr (n + 1,). cells:
    sets of nodes in the plane such that each block has both its nodes in one of them, if there are such."""

    size: int
    rows: np.ndarray
    indices: np.ndarray
    indptr: np.ndarray
    cells: CoupledCells | None


class Reduction(NamedTuple):
    """pointers (m + 1,), rows (nonzeros,) of the matrix; starts (nonzeros + 1,), source, weight: the map."""

    pointers: np.ndarray
    rows: np.ndarray
    starts: np.ndarray
    source: np.ndarray
    weight: np.ndarray

    def columns(self) -> np.ndarray:
        """Column of every nonzero."""
        return np.repeat(np.arange(len(self.pointers) - 1), np.diff(self.pointers))

    def entries(self) -> np.ndarray:
        """How many entries every nonzero has."""
        return np.diff(self.starts) if len(self.starts) else np.ones(len(self.rows), int)

    def matrix(self, blocks: np.ndarray) -> sp.csc_array:
        """The reduced matrix (m, m) of blocks (b, 3, 3)."""
        size = len(self.pointers) - 1
        data = _gathered(blocks.ravel(), self.starts, self.source, self.weight)
        return sp.csc_array((data, self.rows, self.pointers), shape=(size, size))


def reduction(pattern: BlockPattern, transform: sp.csr_array) -> Reduction:
    """Of a pattern and T (3n, m)."""
    by_column = np.argsort(pattern.indices, kind="stable").astype(np.int32)
    block_pointers = np.searchsorted(pattern.indices[by_column], np.arange(pattern.size + 1))
    block_rows = pattern.rows[by_column].astype(np.int32)
    columns = transform.tocsc()
    across = (transform.indptr, transform.indices, transform.data)
    down = (columns.indptr, columns.indices, columns.data)
    arrays = (block_pointers, by_column, block_rows, *across, *down)
    of_node = np.diff(transform.indptr[::3]).astype(np.int64)
    count = int(of_node[pattern.rows] @ of_node[pattern.indices])
    pointers, rows, starts, source, weight, nonzeros = _reduction(*arrays, count)
    starts = starts[: nonzeros + 1].copy()
    if (transform.data == 1.0).all():
        weight = np.empty(0)
        if nonzeros == count:
            starts = np.empty(0, np.int32)
    return Reduction(pointers, rows[:nonzeros].copy(), starts, source, weight)


@njit(cache=True)
def _reduction(
    block_pointers: np.ndarray,
    by_column: np.ndarray,
    block_rows: np.ndarray,
    t_pointers: np.ndarray,
    t_columns: np.ndarray,
    t_values: np.ndarray,
    c_pointers: np.ndarray,
    c_rows: np.ndarray,
    c_values: np.ndarray,
    count: int,
) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray, np.ndarray, int]:
    """The map: its entries by columns, then by rows, then by columns again, which have their rows sorted."""
    size, filled, nonzeros = len(c_pointers) - 1, 0, 0
    given, target, weighed = np.empty(count, np.int32), np.empty(count, np.int32), np.empty(count)
    ends, of_row = np.empty(size + 1, np.int32), np.zeros(size + 1, np.int32)
    for column in range(size):
        ends[column] = filled
        for at in range(c_pointers[column], c_pointers[column + 1]):
            block, axis = c_rows[at] // 3, c_rows[at] % 3
            for b in range(block_pointers[block], block_pointers[block + 1]):
                for q in range(3):
                    row = 3 * block_rows[b] + q
                    for e in range(t_pointers[row], t_pointers[row + 1]):
                        given[filled], target[filled] = 9 * by_column[b] + 3 * q + axis, t_columns[e]
                        weighed[filled] = t_values[e] * c_values[at]
                        of_row[t_columns[e] + 1] += 1
                        filled += 1
    ends[size] = filled
    for row in range(size):
        of_row[row + 1] += of_row[row]
    by_row, columns = np.empty(count, np.int32), np.empty(count, np.int32)
    for column in range(size):
        for e in range(ends[column], ends[column + 1]):
            place = of_row[target[e]]
            by_row[place], columns[place] = e, column
            of_row[target[e]] += 1
    source, weight, to = np.empty(count, np.int32), np.empty(count), np.empty(count, np.int32)
    at_end = ends.copy()
    for place in range(count):
        e, column = by_row[place], columns[place]
        k = at_end[column]
        source[k], weight[k], to[k] = given[e], weighed[e], target[e]
        at_end[column] += 1
    pointers, rows = np.zeros(size + 1, np.int32), np.empty(count, np.int32)
    starts = np.empty(count + 1, np.int32)
    for column in range(size):
        for e in range(ends[column], ends[column + 1]):
            if e == ends[column] or to[e] != to[e - 1]:
                rows[nonzeros], starts[nonzeros] = to[e], e
                nonzeros += 1
        pointers[column + 1] = nonzeros
    starts[nonzeros] = filled
    return pointers, rows, starts, source, weight, nonzeros


@njit(cache=True, nogil=True)
def _gathered(entries: np.ndarray, starts: np.ndarray, source: np.ndarray, weight: np.ndarray) -> np.ndarray:
    """The nonzeros of the reduced matrix."""
    if not len(starts):
        return entries[source]
    out = np.zeros(len(starts) - 1)
    for k in range(len(out)):
        for e in range(starts[k], starts[k + 1]):
            out[k] += (weight[e] if len(weight) else 1.0) * entries[source[e]]
    return out
