"""The lattice's linear systems: reduction to the free unknowns, factorisation, solution, inertia.

The reduced tangent Tᵀ K T keeps one pattern, so the map from block entries to its entries is computed
once and the symbolic analysis is done once. Solvers, in the order they are tried for symmetric systems: a
banded Cholesky (small grids; fails on indefinite matrices, which then go on), a sparse L D Lᵀ with exact
inertia by MKL's PARDISO where the extra `mkl` is installed and by rslab where it is not, SciPy's SuperLU
(always there; the inertia from the signs of U's diagonal when no row was exchanged). Unsymmetric systems
go to rslab's or SciPy's L U. Each solution's residual is checked, with one step of refinement.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property, lru_cache
from typing import Any

import numpy as np
import scipy.sparse as sp
from scipy.sparse.linalg import LinearOperator, onenormest, splu

from lumped.linear import banded, pardiso
from lumped.linear.banded import BACKWARD_ERROR
from lumped.linear.reduction import Reduction, reduction
from lumped.linear.saddle_point import Saddle, minimal_residual
from lumped.pattern import KEPT, Pattern
from sheetbench.numerics.stability import nearest_to_zero, negative_real

rslab: Any
try:
    import rslab
except ImportError:  # SciPy always works
    rslab = None

BANDED_LIMIT = 2.0e7  # n × bandwidth² below which the banded Cholesky is quicker than the sparse one

REFINEMENTS = 1


class SingularMatrixError(ArithmeticError):
    """The matrix has no usable factors."""


class Factor:
    """One factorisation: solve(b) and the number of negative eigenvalues (None when it is not known)."""

    def __init__(self, matrix: sp.csc_array, solve: Callable[[np.ndarray], np.ndarray], negative: int | None):
        self._matrix, self._solve, self.negative = matrix, solve, negative

    def solve(self, b: np.ndarray) -> np.ndarray:
        """x with A x = b, refined. Raises SingularMatrixError when the residual stays large."""
        x = self._solve(b)
        for _ in range(REFINEMENTS):
            x = x + self._solve(b - self._matrix @ x)
        size = np.abs(self._matrix.data).max() * np.abs(x).max(initial=0.0) + np.abs(b).max(initial=0.0)
        miss = np.abs(b - self._matrix @ x).max(initial=0.0)
        return checked(x, miss / size if size > 0.0 else miss)

    def once(self, b: np.ndarray) -> np.ndarray:
        """x with A x = b as the factors have it, neither refined nor checked."""
        return self._solve(b)

    def condition(self) -> float:
        """Condition number ‖A‖₁ ‖A⁻¹‖₁, the latter estimated with the factors (Hager 1984, Higham 1988)."""
        n = self._matrix.shape[0]
        if n == 0:
            return 1.0

        def columns(b: np.ndarray) -> np.ndarray:
            return np.column_stack([self._solve(column) for column in b.reshape(n, -1).T])

        # of an unsymmetric matrix the solver with the transpose is missing: its symmetric part is close by
        inverse = LinearOperator(
            (n, n), matvec=lambda b: self._solve(b.ravel()), rmatvec=lambda b: self._solve(b.ravel()),
            matmat=columns, rmatmat=columns, dtype=float,
        )  # fmt: skip
        largest = float(abs(self._matrix).sum(axis=0).max())
        return largest * float(onenormest(inverse, t=min(2, n)))

    def negative_real(self) -> int | None:
        """Real eigenvalues below zero of an unsymmetric matrix (see `sheetbench.numerics.stability`); None
        where they are not found. None are sought where the symmetric part is positive definite: then no
        eigenvalue has a negative real part."""
        if _negative(sp.csc_array((self._matrix + self._matrix.T) / 2.0)) == 0:
            return 0
        found = nearest_to_zero(self._matrix, self._solve)
        return None if found is None else negative_real(found)


def checked(x: np.ndarray, miss: float) -> np.ndarray:
    """x, unless its residual relative to the matrix and the vectors is large."""
    if not miss <= BACKWARD_ERROR:  # also catches nan
        raise SingularMatrixError(f"residual {miss:.1e} after refinement")
    return x


class BandedFactor(Factor):
    """Cholesky factors in a band: of a positive definite matrix."""

    def __init__(self, band: banded.Band, matrix: np.ndarray, factors: np.ndarray):
        self._band, self._stored, self._factors = band, matrix, factors
        self.negative = 0

    @cached_property
    def _matrix(self) -> sp.csc_array:
        return banded.sparse(self._stored, self._band)

    def _solve(self, b: np.ndarray) -> np.ndarray:
        return self._substituted(b, 0)[0]

    def solve(self, b: np.ndarray) -> np.ndarray:
        """x with A x = b, refined. Raises SingularMatrixError when the residual stays large."""
        return checked(*self._substituted(b, REFINEMENTS))

    def _substituted(self, b: np.ndarray, refinements: int) -> tuple[np.ndarray, float]:
        order, width = self._band.order, self._band.width
        return banded.solve(self._stored, self._factors, width, order, b, refinements)


class SaddleFactor(Factor):
    """Factors of a matrix close by one with constraints' multipliers (`lumped.linear.saddle_point`)."""

    def solve(self, b: np.ndarray) -> np.ndarray:
        """x with A x = b to rounding. Raises SingularMatrixError when the residual stays large."""
        return checked(*minimal_residual(self._matrix, self._solve, b))


class SparseFactor(Factor):
    """Sparse factors of a matrix that is made of its blocks (b, 3, 3) only once it is asked for: while large
    factors are made there is no memory to spare."""

    def __init__(self, reduction: Reduction, blocks: np.ndarray, factors: Any):
        self._reduction, self._blocks, self._solve = reduction, blocks, factors.solve
        self.negative = factors.inertia[1]

    @cached_property
    def _matrix(self) -> sp.csc_array:
        matrix = self._reduction.matrix(self._blocks)
        del self._blocks
        return matrix


class ReducedSystem:
    """Tᵀ K T over a fixed pattern, from the blocks of K to factors.

    transform: (3n, m) sparse; symmetric: factors as L D Lᵀ and tells the inertia; multipliers: (m,) bool, the
    unknowns that are constraints' multipliers (see `lumped.linear.saddle_point`).
    """

    def __init__(
        self,
        pattern: Pattern,
        transform: sp.csr_array,
        symmetric: bool,
        multipliers: np.ndarray | None = None,
    ):
        self.symmetric = symmetric
        self.unknowns = transform.shape[1]
        self._transform = transform
        self._pattern = pattern
        self._analysis: Any = None
        self.band: banded.Band | None = None
        self._multipliers = multipliers if multipliers is not None and multipliers.any() else None
        if symmetric and self._multipliers is None and self.unknowns < BANDED_LIMIT / banded.PANEL**2:
            found = self._reduction
            rows, columns = found.rows, found.columns()
            order, width = banded.ordered(rows, columns, self.unknowns)
            if banded.cost(self.unknowns, width) < BANDED_LIMIT:
                entries = found.entries()
                rows, columns = np.repeat(rows, entries), np.repeat(columns, entries)
                weight = found.weight if len(found.weight) else np.ones(len(rows))
                self.band = banded.band_of(found.source, rows, columns, weight, order, width)

    @cached_property
    def _reduction(self) -> Reduction:
        return reduction(self._pattern, self._transform)

    @cached_property
    def _saddle(self) -> Saddle | None:
        if self._multipliers is None:
            return None
        return Saddle(self._reduction.rows, self._reduction.columns(), self._multipliers)

    def matrix(self, blocks: np.ndarray) -> sp.csc_array:
        """The reduced matrix (m, m) of blocks (b, 3, 3), both triangles."""
        return self._reduction.matrix(blocks)

    def apply(self, blocks: np.ndarray, u: np.ndarray) -> np.ndarray:
        """K u for a displacement (n, 3): force (n, 3)."""
        full = sp.bsr_array((blocks, self._pattern.indices, self._pattern.indptr))
        product: np.ndarray = full @ u.ravel()
        return product.reshape(u.shape)

    def factor(self, blocks: np.ndarray) -> Factor:
        """Factors of Tᵀ K T. Raises SingularMatrixError when there are none."""
        if self.band is not None:
            stored = banded.stored(blocks, self.band)
            factors = stored.copy()
            if banded.factor(factors, self.unknowns, self.band.width):
                return BandedFactor(self.band, stored, factors)
        with_pardiso = pardiso.library() is not None
        if self.symmetric and self._multipliers is None and rslab is not None and not with_pardiso:
            return self._ldlt(blocks)
        matrix = _finite(self.matrix(blocks))
        sparse = rslab is not None or (self.symmetric and with_pardiso)
        if self._saddle is not None and self.symmetric and sparse:
            return self._quasi_definite(self._saddle, matrix)
        try:
            if not sparse:
                return _superlu(matrix, self.symmetric and self._saddle is None)
            if self._analysis is None:
                self._analysis = _analysis(matrix, self.symmetric)
            factors = self._analysis.factor(matrix)
            return Factor(matrix, factors.solve, factors.inertia[1] if self.symmetric else None)
        except RuntimeError as error:
            raise SingularMatrixError(str(error)) from None

    def _ldlt(self, blocks: np.ndarray) -> Factor:
        """Factors by rslab, which is given the lower triangle and nothing that it would copy."""
        found, matrix = self._reduction, _finite(self.matrix(blocks))
        try:
            if self._analysis is None:
                self._analysis = _analysis(matrix, symmetric=True)
            lower = matrix.data[found.rows >= found.columns()]
            del matrix
            factors = self._analysis.factor(lower)
        except RuntimeError as error:
            raise SingularMatrixError(str(error)) from None
        return SparseFactor(found, blocks, factors)

    def _quasi_definite(self, saddle: Saddle, matrix: sp.csc_array) -> Factor:
        close_by, augmented = saddle.quasi_definite(matrix)
        try:
            if self._analysis is None:
                self._analysis = _analysis(close_by, symmetric=True)
            factors = self._analysis.factor(close_by)
        except RuntimeError as error:
            raise SingularMatrixError(str(error)) from None
        return SaddleFactor(matrix, lambda b: factors.solve(augmented(b)), factors.inertia[1])


def _finite(matrix: sp.csc_array) -> sp.csc_array:
    """A matrix whose entries are all finite. Raises SingularMatrixError."""
    if not np.isfinite(matrix.data).all():
        raise SingularMatrixError("an entry is not finite")
    return matrix


def reduced(pattern: Pattern, transform: sp.csr_array, symmetric: bool) -> ReducedSystem:
    """The system of unknowns without multipliers; the same one again where a pattern that is kept is reduced
    the same way."""
    if pattern.size > KEPT:
        return ReducedSystem(pattern, transform, symmetric)
    pointers, columns = (part.astype(np.int32).tobytes() for part in (transform.indptr, transform.indices))
    return _kept(pattern, transform.shape, pointers, columns, transform.data.tobytes(), symmetric)


@lru_cache(maxsize=16)
def _kept(
    pattern: Pattern, shape: tuple[int, int], pointers: bytes, columns: bytes, values: bytes, symmetric: bool
) -> ReducedSystem:
    parts = np.frombuffer(values), np.frombuffer(columns, np.int32), np.frombuffer(pointers, np.int32)
    return ReducedSystem(pattern, sp.csr_array(parts, shape=shape), symmetric)


def _analysis(matrix: sp.csc_array, symmetric: bool) -> Any:
    """What factorises matrices of this one's pattern and tells the inertia of symmetric ones."""
    if symmetric and pardiso.library() is not None:
        return pardiso.Analysis(matrix)
    return rslab.analyze(matrix, path="ldlt" if symmetric else "lu")


def _negative(matrix: sp.csc_array) -> int | None:
    """Negative eigenvalues of a symmetric matrix; None where its factors do not tell, or there are none."""
    try:
        if rslab is None:
            return _superlu(matrix, symmetric=True).negative
        return int(rslab.ldlt(matrix).inertia[1])
    except RuntimeError:
        return None


def _superlu(matrix: sp.csc_array, symmetric: bool) -> Factor:
    if not symmetric:
        return Factor(matrix, splu(matrix).solve, None)
    scale = 1.0 / np.sqrt(np.abs(matrix.diagonal()) + np.finfo(float).tiny)
    scaled = sp.csc_array(sp.diags_array(scale) @ matrix @ sp.diags_array(scale))
    factors = splu(scaled, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True})
    exchanged = not np.array_equal(factors.perm_r, factors.perm_c)
    negative = None if exchanged else int(np.sum(factors.U.diagonal() < 0.0))
    return Factor(matrix, lambda b: scale * factors.solve(scale * b), negative)
