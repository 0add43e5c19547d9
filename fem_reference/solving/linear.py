"""Sparse direct solution of A x = b: analyse a pattern once, factorise many times, know the inertia.

Where the fronts of the pattern are known and the matrix is positive definite, it has Cholesky
factors (see `multifrontal`). rslab does the rest: L D Lᵀ with Bunch–Kaufman pivots where A is symmetric
(Sylvester's law: D has A's inertia), L U where it is not. SciPy's SuperLU does where rslab is missing; its U
is D Lᵀ without row exchanges and tells the inertia too. Solutions are refined, their residuals checked.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple, Protocol

import numpy as np
from scipy.sparse import csc_matrix, csr_matrix
from scipy.sparse.linalg import splu

from fem_reference.solving.fronts import Fronts
from fem_reference.solving.multifrontal import Cholesky, NotPositiveDefinite

rslab: Any
try:
    import rslab
except ImportError:
    rslab = None

BACKWARD_ERROR = 1e-8  # ‖A x − b‖ relative to ‖A‖‖x‖ + ‖b‖ (max norms) beyond which a solve has failed


class SingularMatrix(ArithmeticError):
    """The matrix could not be factorised, or its factors do not solve the system."""


class Inertia(NamedTuple):
    """Numbers of positive, negative and zero eigenvalues of a symmetric matrix."""

    positive: int
    negative: int
    zero: int


class Factors(Protocol):
    """What solves with a matrix."""

    def solve(self, b: np.ndarray, /) -> np.ndarray:
        """x (n,) with A x = b."""
        ...


class Factor:
    """The factors of one matrix."""

    def __init__(self, matrix: csr_matrix, factors: Factors, inertia: Inertia | None):
        self.matrix = matrix
        self.inertia = inertia
        self._factors = factors
        self._largest = _largest(matrix)

    def solve(self, b: np.ndarray, enough: float = 0.0) -> np.ndarray:
        """x (n,) with A x = b, refined once where its backward error exceeds `enough`. Raises SingularMatrix
        if the residual stays large."""
        x = self._factors.solve(b)
        left, error = self._backward(x, b)
        if not error <= enough:  # also catches nan
            x = x + self._factors.solve(left)
            left, error = self._backward(x, b)
        if not error <= BACKWARD_ERROR:
            gap = np.abs(left).max()
            raise SingularMatrix(f"residual {gap:.1e} after refinement: singular to working precision")
        return x

    def _backward(self, x: np.ndarray, b: np.ndarray) -> tuple[np.ndarray, float]:
        """b − A x (n,), and how large it is relative to ‖A‖‖x‖ + ‖b‖."""
        left = b - self.matrix @ x
        size = self._largest * np.abs(x).max(initial=0.0) + np.abs(b).max(initial=0.0)
        gap = np.abs(left).max(initial=0.0)
        return left, float(gap / size) if gap else 0.0


class DirectSolver:
    """Factorises matrices of one sparsity pattern; the symbolic analysis is done once.

    symmetric: the matrices are symmetric (both triangles stored) and the factors tell the inertia; fronts:
    gives those of the pattern, where they are to have Cholesky factors.
    """

    def __init__(
        self,
        symmetric: bool = True,
        use_rslab: bool = True,
        fronts: Callable[[], Fronts] | None = None,
    ):
        self.symmetric = symmetric
        self._fronts = fronts if symmetric else None
        self._analysis: Any = None
        self._use_rslab = use_rslab and rslab is not None

    def factor(self, matrix: csr_matrix) -> Factor:
        """Factors of a matrix (n, n) that has the pattern of the first one given.

        Raises SingularMatrix on a zero pivot or an entry that is not finite.
        """
        if self._fronts is not None:
            try:
                return Factor(matrix, Cholesky(matrix.data, self._fronts()), Inertia(matrix.shape[0], 0, 0))
            except NotPositiveDefinite:
                pass  # its inertia is to be told, or an entry is not finite
        if not np.isfinite(_largest(matrix)):
            raise SingularMatrix("an entry of the matrix is not finite")
        columns = _columns(matrix, self.symmetric)
        try:
            if self._use_rslab:
                return self._with_rslab(matrix, columns)
            return _with_superlu(matrix, columns, self.symmetric)
        except RuntimeError as error:
            raise SingularMatrix(str(error)) from None

    def _with_rslab(self, matrix: csr_matrix, columns: csc_matrix) -> Factor:
        if self._analysis is None:
            self._analysis = rslab.analyze(columns, path="ldlt" if self.symmetric else "lu")
        factors = self._analysis.factor(columns)
        return Factor(matrix, factors, Inertia(*factors.inertia) if self.symmetric else None)


def _largest(matrix: csr_matrix) -> float:
    """Of the entries' magnitudes; nan or infinite where one is."""
    return float(max(matrix.data.max(initial=0.0), -matrix.data.min(initial=0.0)))


def solve_free(matrix: csr_matrix, force: np.ndarray, u: np.ndarray, free: np.ndarray) -> np.ndarray:
    """K u = f solved for the free unknowns (k,) of u (n,), the others as they are. Raises SingularMatrix."""
    out = u.copy()
    out[free] = 0.0
    out[free] = DirectSolver().factor(matrix[free][:, free]).solve((force - matrix @ out)[free])
    return out


def _with_superlu(matrix: csr_matrix, columns: csc_matrix, symmetric: bool) -> Factor:
    if not symmetric:
        return Factor(matrix, splu(columns), None)
    largest = np.abs(matrix).max(axis=1).toarray().ravel()
    scale = 1.0 / np.sqrt(np.maximum(largest, np.finfo(float).tiny))
    scaled = (columns.multiply(scale[:, None]).multiply(scale[None, :])).tocsc()
    factors = splu(scaled, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True})
    inertia = None
    if np.array_equal(factors.perm_r, factors.perm_c):
        pivots = factors.U.diagonal()
        inertia = Inertia(*(int(np.sum(sign)) for sign in (pivots > 0, pivots < 0, pivots == 0)))
    return Factor(matrix, _Scaled(factors, scale), inertia)


class _Scaled:
    """Factors of S A S, solving with A."""

    def __init__(self, factors: Factors, scale: np.ndarray):
        self._factors, self._scale = factors, scale

    def solve(self, b: np.ndarray) -> np.ndarray:
        return self._scale * self._factors.solve(self._scale * b)


def _columns(matrix: csr_matrix, symmetric: bool) -> csc_matrix:
    """The matrix by columns; the rows of a symmetric one are its columns."""
    if not symmetric:
        return matrix.tocsc()
    columns = csc_matrix((matrix.data, matrix.indices, matrix.indptr), shape=matrix.shape)
    columns.has_canonical_format = matrix.has_canonical_format
    return columns
