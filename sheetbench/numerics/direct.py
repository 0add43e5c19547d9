"""Sparse direct solution of A x = b: analyse a pattern once, factorise many times, know the inertia.

A symmetric matrix has factors L S Lᵀ by fronts where those of its pattern are known (`multifrontal`). What
has none by fronts, as may be far from definite, goes to rslab's L D Lᵀ with Bunch–Kaufman pivots. Unsymmetric
ones are solved with the factors of their symmetric part where that is definite and close, else by L U of
SciPy. Solutions are refined, their residuals checked.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property, partial
from math import isfinite
from typing import Any

import numpy as np
import rslab
import scipy.sparse as sp
from scipy.sparse.linalg import LinearOperator, cg, splu

from sheetbench.numerics.banded import BACKWARD_ERROR
from sheetbench.numerics.fronts import Fronts
from sheetbench.numerics.multifrontal import signed_factors
from sheetbench.numerics.saddle_point import ROUNDED, minimal_residual
from sheetbench.numerics.stability import nearest_to_zero, negative_real, odd_below_zero

Matrix = Any  # by rows or, where it is symmetric or so by pattern, by columns
Solve = Callable[[np.ndarray], np.ndarray]
Count = Callable[[], None]

# backward error of a positive definite matrix's factors, which need no pivots (Higham 2002, 10.1)
CHOLESKY = 1e-14
SOLVED = 1e-14  # of a Newton step that is not refined: the next one is its refinement
ITERATION_ACCURACY = 1e-4  # residual over the right-hand side: Newton's corrections gain few digits more
ITERATIONS = 20  # each costs a solution with the factors


class SingularMatrixError(ArithmeticError):
    """The matrix has no usable factors, or they do not solve the system."""


@dataclass(eq=False)
class Factor:
    """One factorisation. given: the matrix, or what makes it; solve_unrefined: x with A x = b as the factors
    have it, neither refined nor checked; negative, zero: how many eigenvalues of a symmetric matrix are below
    zero and zero, −1 of an unsymmetric one; backward_error: what that of unrefined solutions is known to be
    below; more: called once a further factorisation that is made of the matrix."""

    given: Matrix | Callable[[], Matrix]
    solve_unrefined: Solve
    negative: int = -1
    zero: int = 0
    backward_error: float = np.inf
    more: Count = lambda: None

    @cached_property
    def matrix(self) -> Matrix:
        """The matrix, both triangles."""
        return self.given() if callable(self.given) else self.given

    def negative_real(self) -> int | None:
        """Real eigenvalues below zero of an unsymmetric matrix (`stability`), among those nearest to zero;
        None if they are not found, or the determinant's sign tells that there are others."""
        found = nearest_to_zero(self.matrix, self.solve_unrefined)
        if found is None:
            return None
        count = negative_real(found)
        if len(found) == self.matrix.shape[0]:
            return count
        self.more()
        return count if odd_below_zero(self.matrix) == bool(count % 2) else None

    def solve(self, b: np.ndarray, enough: float = 0.0) -> np.ndarray:
        """x (n,) with A x = b, corrected (`saddle_point`) unless its backward error is known to be `enough`.
        Raises SingularMatrixError if the residual stays large."""
        if self.backward_error <= enough:
            x = self.solve_unrefined(b)
            if isfinite(x @ x):
                return x
        return checked(*minimal_residual(self.matrix, self.solve_unrefined, b, max(enough, ROUNDED)))


@dataclass(eq=False)
class SymmetricPartFactor(Factor):
    """Factors of an unsymmetric matrix's symmetric part, which is positive definite: no eigenvalue has a
    negative real part. whole: makes those of the matrix, where corrected solutions are not good enough."""

    whole: Callable[[], Factor] = field(kw_only=True)
    _whole: Factor | None = field(default=None, init=False)

    def negative_real(self) -> int:
        """Zero."""
        return 0

    def solve(self, b: np.ndarray, enough: float = 0.0) -> np.ndarray:
        """Solve A x = b for x (n,), corrected. Raises SingularMatrixError if the residual stays large."""
        if self._whole is None:
            x, miss = minimal_residual(self.matrix, self.solve_unrefined, b, max(enough, ROUNDED))
            if miss <= BACKWARD_ERROR:
                return x
            self.more()
            self._whole = self.whole()
        return self._whole.solve(b, enough)


def checked(x: np.ndarray, miss: float) -> np.ndarray:
    """x, unless its residual relative to the matrix and the vectors is large."""
    if not miss <= BACKWARD_ERROR:  # also catches nan
        raise SingularMatrixError(f"residual {miss:.1e} after refinement: singular to working precision")
    return x


class DirectSolver:
    """Factorises matrices of one sparsity pattern, with sorted indices; the analysis is done once.

    symmetric: the matrices are symmetric (both triangles stored), and the factors tell the inertia; fronts:
    gives those of the pattern, where they are known.
    """

    def __init__(self, symmetric: bool = True, fronts: Callable[[], Fronts] | None = None):
        self.symmetric, self._fronts = symmetric, fronts
        self._analysis: Any = None
        self._transposed: np.ndarray | None = None

    def factor(self, matrix: Matrix, more: Count = lambda: None) -> Factor:
        """Factors of a matrix (n, n) that has the pattern of the first one given; more: called once a further
        factorisation that these, or what is asked of them later, take.

        Raises SingularMatrixError on a zero pivot or an entry that is not finite.
        """
        if self._fronts is not None:
            data = matrix.data if self.symmetric else self._symmetric_part(matrix)
            if found := signed_factors(data, self._fronts()):
                solve, negative = found
                if self.symmetric:
                    error = np.inf if negative else CHOLESKY
                    return Factor(matrix, solve, negative, backward_error=error)
                if negative == 0:
                    whole = partial(self._by_library, matrix, more)
                    return SymmetricPartFactor(matrix, solve, more=more, whole=whole)
                more()
        return self._by_library(matrix, more)  # whose pivots may do

    def iterated(self, matrix: Matrix, near: Factor, rows: np.ndarray) -> None:
        """None: factors of its own cost little beside a matrix of elements."""

    def _symmetric_part(self, matrix: Matrix) -> np.ndarray:
        """The data of (A + Aᵀ)/2, whose pattern is that of A."""
        if self._transposed is None:
            places = sp.csc_array((np.arange(len(matrix.data)), matrix.indices, matrix.indptr), matrix.shape)
            self._transposed = places.T.tocsc().data
        return np.asarray(0.5 * (matrix.data + matrix.data[self._transposed]))

    def _by_library(self, matrix: Matrix, more: Count) -> Factor:
        if not np.isfinite(matrix.data).all():
            raise SingularMatrixError("an entry of the matrix is not finite")
        # the rows of a symmetric matrix are its columns
        columns = sp.csc_array(matrix.T if self.symmetric and matrix.format == "csr" else matrix)
        try:
            if not self.symmetric:
                return Factor(matrix, splu(columns).solve, more=more)
            self._analysis = self._analysis or rslab.analyze(columns, path="ldlt")
            factors = self._analysis.factor(columns)
            _, negative, zero = factors.inertia
            return Factor(matrix, factors.solve, negative, zero, more=more)
        except RuntimeError as error:
            raise SingularMatrixError(str(error)) from None


def iterated(matrix: sp.csc_array, near: Factor, b: np.ndarray) -> np.ndarray | None:
    """x with A x = b to ITERATION_ACCURACY by conjugate gradients with the factors of a matrix close by
    (Hestenes and Stiefel 1952); None where the factors are those of an indefinite matrix or too far off."""
    if near.negative != 0:
        return None
    n = len(b)
    preconditioner = LinearOperator((n, n), matvec=near.solve_unrefined, dtype=float)
    x, failed = cg(matrix, b, rtol=ITERATION_ACCURACY, maxiter=ITERATIONS, M=preconditioner)
    return None if failed or not np.isfinite(x).all() else x
