"""Tᵀ K T, the matrix of free unknowns of a matrix K in 3×3 blocks, from the blocks to factors.

Its pattern is constant, so that the map from block entries to its entries and the symbolic analysis are
computed once. The matrix has sorted rows by columns (CSC). Entry e of the map adds weight[e] times entry
source[e] of the flat blocks to the nonzero k with starts[k] ≤ e < starts[k + 1]. If all weights are one, as
without hinges and actuators, they are not stored, nor are starts if every nonzero has one entry. Small
positive definite systems have banded Cholesky factors; others go to `direct`. For constraints' multipliers
among the unknowns see `saddle_point`.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property, partial
from typing import NamedTuple, Protocol

import numpy as np
import scipy.sparse as sp

from sheetbench.numerics import banded
from sheetbench.numerics.aliasing import empty, zeros
from sheetbench.numerics.cache import cached
from sheetbench.numerics.direct import CHOLESKY, Count, DirectSolver, Factor, SingularMatrixError
from sheetbench.numerics.fronts import CoupledCells, Fronts, fronts_of
from sheetbench.numerics.options import njit
from sheetbench.numerics.saddle_point import Saddle

BANDED_LIMIT = 2.0e7  # multiplications, n × bandwidth², below which bands are quicker than fronts


class BlockPattern(Protocol):
    """Blocks (b,) of a symmetric pattern over n nodes, as in BSR: rows, indices (b,), indptr (n + 1,). cells:
    sets of nodes in the plane, one for each block that contains both its nodes, or None."""

    size: int
    rows: np.ndarray
    indices: np.ndarray
    indptr: np.ndarray
    cells: CoupledCells | None


class Reduction(NamedTuple):
    """Reduced matrix (pointers (m + 1,), rows) and map to it (starts (nonzeros + 1,), source, weight)."""

    pointers: np.ndarray
    rows: np.ndarray
    starts: np.ndarray
    source: np.ndarray
    weight: np.ndarray

    def columns(self) -> np.ndarray:
        """Return the column of every nonzero."""
        return np.repeat(np.arange(len(self.pointers) - 1), np.diff(self.pointers))

    def entries(self) -> np.ndarray:
        """Return the number of the map's entries for every nonzero."""
        return np.diff(self.starts) if len(self.starts) else np.ones(len(self.rows), int)

    def matrix(self, blocks: np.ndarray) -> sp.csc_array:
        """Return the reduced matrix (m, m) of blocks (b, 3, 3)."""
        size = len(self.pointers) - 1
        data = _gather(blocks.ravel(), self.starts, self.source, self.weight)
        return sp.csc_array((data, self.rows, self.pointers), shape=(size, size))


def banded_factor(band: banded.Band, factors: np.ndarray, matrix: Callable[[], sp.csc_array]) -> Factor:
    """Return banded Cholesky factors as a Factor; matrix: makes the matrix when it is needed."""
    solve = partial(banded.solve_unrefined, factors, band.width, band.order)
    return Factor(matrix, solve, 0, backward_error=CHOLESKY)


class ReducedSystem:
    """Tᵀ K T over a fixed pattern, from the blocks of K to factors.

    transform: (3n, m) sparse. symmetric: whether K is symmetric; the factors then have the inertia.
    multipliers: (m,) bool, the unknowns that are constraints' multipliers.
    """

    def __init__(
        self,
        pattern: BlockPattern,
        transform: sp.csr_array,
        symmetric: bool,
        multipliers: np.ndarray | None = None,
    ):
        self.symmetric, self.unknowns = symmetric, transform.shape[1]
        self._transform, self._pattern = transform, pattern
        self._solver = DirectSolver(symmetric, None if pattern.cells is None else lambda: self._fronts)
        constrained = multipliers is not None and multipliers.any()
        self._multipliers = multipliers if symmetric and constrained else None

    @cached_property
    def _reduction(self) -> Reduction:
        return reduction(self._pattern, self._transform)

    @cached_property
    def band(self) -> banded.Band | None:
        """Return the band of a small symmetric system without multipliers, None for others."""
        if not self.symmetric or self._multipliers is not None:
            return None
        reduced = self._reduction
        order, width = banded.ordered(reduced.rows, reduced.columns(), self.unknowns)
        if self.unknowns * (width + 1.0) ** 2 >= BANDED_LIMIT:
            return None
        entries = reduced.entries()
        rows, columns = np.repeat(reduced.rows, entries), np.repeat(reduced.columns(), entries)
        weight = reduced.weight if len(reduced.weight) else np.ones(len(rows))
        return banded.band_of(reduced.source, rows, columns, weight, order, width)

    @cached_property
    def _fronts(self) -> Fronts:
        cells, transform = self._pattern.cells, self._transform
        assert cells is not None
        # a component that is no unknown itself depends on unknowns of its own cells
        components = np.flatnonzero(np.diff(transform.indptr) == 1)
        entries = transform.indptr[components]
        own = transform.data[entries] == 1.0
        number = np.full(3 * self._pattern.size, -1)
        number[components[own]] = transform.indices[entries[own]]
        of_cells = number.reshape(-1, 3)[cells.unknowns].reshape(len(cells.unknowns), -1)
        reduced = self._reduction
        return fronts_of(reduced.rows, reduced.pointers, CoupledCells(of_cells, cells.places))

    @cached_property
    def _saddle(self) -> Saddle | None:
        if self._multipliers is None:
            return None
        return Saddle(self._reduction.rows, self._reduction.columns(), self._multipliers)

    def matrix(self, blocks: np.ndarray) -> sp.csc_array:
        """Return the reduced matrix (m, m) of blocks (b, 3, 3), both triangles."""
        return self._reduction.matrix(blocks)

    def apply(self, blocks: np.ndarray, u: np.ndarray) -> np.ndarray:
        """Return the force K u (n, 3) of a displacement (n, 3)."""
        full = sp.bsr_array((blocks, self._pattern.indices, self._pattern.indptr))
        product: np.ndarray = full @ u.ravel()
        return product.reshape(u.shape)

    def factor(self, blocks: np.ndarray, more: Count = lambda: None) -> Factor:
        """Return the factors of Tᵀ K T; more: as in `DirectSolver.factor`. Raises SingularMatrixError."""
        if self.band is not None:
            factors, definite = banded.factored(blocks, self.band)
            if definite:
                return banded_factor(self.band, factors, partial(self.matrix, blocks))
        matrix = self.matrix(blocks)
        if self._saddle is None:
            return self._solver.factor(matrix, more)
        if not np.isfinite(matrix.data).all():
            raise SingularMatrixError("an entry of the matrix is not finite")
        close_by, augmented = self._saddle.quasi_definite(matrix)
        near = self._solver.factor(close_by)
        return Factor(matrix, lambda b: near.solve_unrefined(augmented(b)), near.negative, near.zero)


def reduced(pattern: BlockPattern, transform: sp.csr_array, symmetric: bool) -> ReducedSystem:
    """Return the system of unknowns without multipliers, a small one from a cache of recent systems."""
    pointers, columns = (part.astype(np.int32) for part in (transform.indptr, transform.indices))
    return _reduced(pattern, transform.shape, pointers, columns, transform.data, symmetric)


@cached(last=16, most=150_000)
def _reduced(
    pattern: BlockPattern,
    shape: tuple[int, int],
    pointers: np.ndarray,
    columns: np.ndarray,
    values: np.ndarray,
    symmetric: bool,
) -> ReducedSystem:
    return ReducedSystem(pattern, sp.csr_array((values, columns, pointers), shape=shape), symmetric)


def reduction(pattern: BlockPattern, transform: sp.csr_array) -> Reduction:
    """Return the map of a pattern reduced by T (3n, m)."""
    by_column = np.argsort(pattern.indices, kind="stable").astype(np.int32)
    block_pointers = np.searchsorted(pattern.indices[by_column], np.arange(pattern.size + 1))
    columns, size = transform.tocsc(), transform.shape[1]
    across = (transform.indptr, transform.indices, transform.data)
    down = (columns.indptr, columns.indices, columns.data)
    blocks = (block_pointers, by_column, pattern.rows[by_column].astype(np.int32))
    of_node = np.diff(transform.indptr[::3]).astype(np.int64)
    count = int(of_node[pattern.rows] @ of_node[pattern.indices])
    source, row, weight, ends = _entries(*blocks, *across, *down, count)
    # by rows, then by columns again: each column's entries by their rows
    every = sp.csc_array((np.arange(count, dtype=np.int32), row, ends), shape=(size, size)).tocsr().tocsc()
    again = np.append(False, every.indices[1:] == every.indices[:-1])
    again[every.indptr[:-1][np.diff(every.indptr) > 0]] = False
    first = np.flatnonzero(~again)
    plain = bool((transform.data == 1.0).all())
    starts = np.empty(0) if plain and len(first) == count else np.append(first, count)
    return Reduction(
        np.searchsorted(first, every.indptr).astype(np.int32),
        every.indices[first],
        starts.astype(np.int32),
        source[every.data],
        np.empty(0) if plain else weight[every.data],
    )


@njit
def _entries(
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
) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Return the map's entries by columns of the matrix: source, row, weight, and the columns' starts."""
    source, to, weight = empty(count, np.int32), empty(count, np.int32), empty(count)
    ends, filled = zeros(len(c_pointers), np.int32), 0
    for column in range(len(c_pointers) - 1):
        for at in range(c_pointers[column], c_pointers[column + 1]):
            block, axis = c_rows[at] // 3, c_rows[at] % 3
            for b in range(block_pointers[block], block_pointers[block + 1]):
                for q in range(3):
                    row = 3 * block_rows[b] + q
                    for e in range(t_pointers[row], t_pointers[row + 1]):
                        source[filled], to[filled] = 9 * by_column[b] + 3 * q + axis, t_columns[e]
                        weight[filled] = t_values[e] * c_values[at]
                        filled += 1
        ends[column + 1] = filled
    return source, to, weight, ends


@njit
def _gather(entries: np.ndarray, starts: np.ndarray, source: np.ndarray, weight: np.ndarray) -> np.ndarray:
    """Return the nonzeros of the reduced matrix."""
    if not len(starts):
        return entries[source]
    out = zeros(len(starts) - 1)
    for k in range(len(out)):
        for e in range(starts[k], starts[k + 1]):
            out[k] += (weight[e] if len(weight) else 1.0) * entries[source[e]]
    return out
