"""Tᵀ K T, the matrix of free unknowns of a matrix K in 3×3 blocks, from the blocks to factors.

It keeps one pattern, so the map from block entries to its entries is found once and the symbolic analysis is
done once. Small symmetric systems have banded Cholesky factors; those that are not positive definite, and
larger ones, go to `direct`. Constraints' multipliers among the unknowns: see `saddle_point`.
"""

from __future__ import annotations

from functools import cached_property
from math import isfinite

import numpy as np
import scipy.sparse as sp

from sheetbench.numerics import banded
from sheetbench.numerics.direct import (
    CHOLESKY,
    Count,
    DirectSolver,
    Factor,
    Inertia,
    SingularMatrixError,
    checked,
)
from sheetbench.numerics.fronts import CoupledCells, Fronts, fronts_of
from sheetbench.numerics.kept import kept
from sheetbench.numerics.reduction import BlockPattern, Reduction, reduction
from sheetbench.numerics.saddle_point import ROUNDED, Saddle, minimal_residual

BANDED_LIMIT = 2.0e7  # n × bandwidth² below which the banded Cholesky is quicker than the sparse one


class BandedFactor(Factor):
    """Cholesky factors in a band: of a positive definite matrix."""

    def __init__(self, band: banded.Band, blocks: np.ndarray, factors: np.ndarray):
        """blocks (b, 3, 3): of the matrix, not to be written to any more."""
        self._band, self._blocks, self.factors = band, blocks, factors
        self._backward_error = CHOLESKY
        self.inertia = Inertia(len(band.order), 0, 0)

    @cached_property
    def _stored(self) -> np.ndarray:
        stored: np.ndarray = banded.stored(self._blocks, self._band)
        return stored

    @cached_property
    def matrix(self) -> sp.csc_array:  # type: ignore[override]
        """The matrix, both triangles."""
        return banded.sparse(self._stored, self._band)

    def _solve(self, b: np.ndarray) -> np.ndarray:
        found: np.ndarray = banded.solve_unrefined(self.factors, self._band.width, self._band.order, b)
        return found

    def solve(self, b: np.ndarray, enough: float = 0.0) -> np.ndarray:
        """x with A x = b, refined once where its backward error may exceed `enough`. Raises
        SingularMatrixError when the residual stays large."""
        if enough >= self._backward_error and isfinite((x := self._solve(b)) @ x):
            return x
        return checked(*banded.solve(self._stored, self.factors, self._band.width, self._band.order, b))


class SaddleFactor(Factor):
    """Factors of a matrix close by one with constraints' multipliers."""

    def solve(self, b: np.ndarray, enough: float = 0.0) -> np.ndarray:
        """x with A x = b to rounding. Raises SingularMatrixError when the residual stays large."""
        return checked(*minimal_residual(self.matrix, self._solve, b, max(enough, ROUNDED)))


class ReducedSystem:
    """Tᵀ K T over a fixed pattern, from the blocks of K to factors.

    transform: (3n, m) sparse; symmetric: whether K is, and the factors tell the inertia; multipliers: (m,)
    bool, the unknowns that are constraints' multipliers.
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
        self.band: banded.Band | None = None
        small = symmetric and not constrained and self.unknowns < BANDED_LIMIT / banded.PANEL**2
        if small and banded.cost(self.unknowns, self._order[1]) < BANDED_LIMIT:
            self.band = self._banded()

    @cached_property
    def _reduction(self) -> Reduction:
        return reduction(self._pattern, self._transform)

    @cached_property
    def _order(self) -> tuple[np.ndarray, int]:
        found = self._reduction
        return banded.ordered(found.rows, found.columns(), self.unknowns)

    def _banded(self) -> banded.Band:
        found, entries = self._reduction, self._reduction.entries()
        rows, columns = np.repeat(found.rows, entries), np.repeat(found.columns(), entries)
        weight = found.weight if len(found.weight) else np.ones(len(rows))
        return banded.band_of(found.source, rows, columns, weight, *self._order)

    @cached_property
    def _fronts(self) -> Fronts:
        cells, transform = self._pattern.cells, self._transform
        assert cells is not None
        # what is no unknown itself depends on those of its own cells
        components = np.flatnonzero(np.diff(transform.indptr) == 1)
        entries = transform.indptr[components]
        own = transform.data[entries] == 1.0
        number = np.full(3 * self._pattern.size, -1)
        number[components[own]] = transform.indices[entries[own]]
        of_cells = number.reshape(-1, 3)[cells.unknowns].reshape(len(cells.unknowns), -1)
        found = self._reduction
        return fronts_of(found.rows, found.pointers, CoupledCells(of_cells, cells.places))

    @cached_property
    def _saddle(self) -> Saddle | None:
        if self._multipliers is None:
            return None
        return Saddle(self._reduction.rows, self._reduction.columns(), self._multipliers)

    def forget(self) -> None:
        """Drop what later factors take over from the first, as `DirectSolver.forget`."""
        self._solver.forget()

    def matrix(self, blocks: np.ndarray) -> sp.csc_array:
        """The reduced matrix (m, m) of blocks (b, 3, 3), both triangles."""
        return self._reduction.matrix(blocks)

    def apply(self, blocks: np.ndarray, u: np.ndarray) -> np.ndarray:
        """K u for a displacement (n, 3): force (n, 3)."""
        full = sp.bsr_array((blocks, self._pattern.indices, self._pattern.indptr))
        product: np.ndarray = full @ u.ravel()
        return product.reshape(u.shape)

    def factor(self, blocks: np.ndarray, more: Count = lambda: None) -> Factor:
        """Factors of Tᵀ K T; more: as of `DirectSolver.factor`. Raises SingularMatrixError where there
        are none."""
        if self.band is not None:
            factors, definite = banded.factored(blocks, self.band)
            if definite:
                return BandedFactor(self.band, blocks, factors)
        matrix = self.matrix(blocks)
        if self._saddle is None:
            return self._solver.factor(matrix, more)
        if not np.isfinite(matrix.data).all():
            raise SingularMatrixError("an entry of the matrix is not finite")
        close_by, augmented = self._saddle.quasi_definite(matrix)
        near = self._solver.factor(close_by)
        return SaddleFactor(matrix, lambda b: near.solve_unrefined(augmented(b)), near.inertia)


def reduced(pattern: BlockPattern, transform: sp.csr_array, symmetric: bool) -> ReducedSystem:
    """The system of unknowns without multipliers; a small one is the same again where a pattern is reduced in
    the same way."""
    pointers, columns = (part.astype(np.int32) for part in (transform.indptr, transform.indices))
    return _reduced(pattern, transform.shape, pointers, columns, transform.data, symmetric)


@kept(last=16, most=150_000)
def _reduced(
    pattern: BlockPattern,
    shape: tuple[int, int],
    pointers: np.ndarray,
    columns: np.ndarray,
    values: np.ndarray,
    symmetric: bool,
) -> ReducedSystem:
    return ReducedSystem(pattern, sp.csr_array((values, columns, pointers), shape=shape), symmetric)
