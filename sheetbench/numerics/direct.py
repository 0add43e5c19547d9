"""Sparse direct solution of A x = b: one analysis of a pattern, many factorisations, with the inertia.

A symmetric matrix has factors L S Lᵀ if the fronts of its pattern are known (`multifrontal`). If they fail,
for instance far from definiteness, rslab's L D Lᵀ with Bunch–Kaufman pivots is used. Unsymmetric matrices are
solved with the factors of their symmetric part if it is definite and close, else by SciPy's L U. Solutions
are refined and their residuals checked.
"""

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

Matrix = Any  # by rows or, if it is symmetric at least by pattern, by columns
Solve = Callable[[np.ndarray], np.ndarray]
Count = Callable[[], None]

# backward error of a positive definite matrix's factors, which need no pivots (Higham 2002, 10.1)
CHOLESKY = 1e-14
SOLVED = 1e-14  # backward error of a Newton step without refinement: the next step refines it
ITERATION_ACCURACY = 1e-4  # residual over the right-hand side: Newton's corrections gain few digits more
ITERATIONS = 20  # each costs a solution with the factors


class SingularMatrixError(ArithmeticError):
    """A matrix without usable factors, or with factors that do not solve the system."""


@dataclass(eq=False)
class Factor:
    """One factorisation.

    given: the matrix, or a function that makes it. solve_unrefined: solves A x = b with the factors, without
    refinement or check. negative, zero: numbers of negative and zero eigenvalues of a symmetric matrix, −1
    for an unsymmetric one. backward_error: bound for unrefined solutions. more: called for each further
    factorisation of the matrix.
    """

    given: Matrix | Callable[[], Matrix]
    solve_unrefined: Solve
    negative: int = -1
    zero: int = 0
    backward_error: float = np.inf
    more: Count = lambda: None

    @cached_property
    def matrix(self) -> Matrix:
        """Return the matrix, both triangles."""
        return self.given() if callable(self.given) else self.given

    def negative_real(self) -> int | None:
        """Return the number of negative real eigenvalues of an unsymmetric matrix (`stability`). It counts
        the eigenvalues nearest to zero. Return None if they do not converge, or the determinant's sign shows
        that there are others."""
        values = nearest_to_zero(self.matrix, self.solve_unrefined)
        if values is None:
            return None
        count = negative_real(values)
        if len(values) == self.matrix.shape[0]:
            return count
        self.more()
        return count if odd_below_zero(self.matrix) == bool(count % 2) else None

    def solve(self, b: np.ndarray, enough: float = 0.0) -> np.ndarray:
        """Solve A x = b for x (n,), with corrections (`saddle_point`) unless its backward error is `enough`.
        Raises SingularMatrixError if the residual stays large."""
        if self.backward_error <= enough:
            x = self.solve_unrefined(b)
            if isfinite(x @ x):
                return x
        return checked(*minimal_residual(self.matrix, self.solve_unrefined, b, max(enough, ROUNDED)))


@dataclass(eq=False)
class SymmetricPartFactor(Factor):
    """Factors of the symmetric part, positive definite, of an unsymmetric matrix. No eigenvalue of the matrix
    has a negative real part. full: makes the factors of the matrix itself, if corrected solutions are too
    inaccurate."""

    full: Callable[[], Factor] = field(kw_only=True)
    _full: Factor | None = field(default=None, init=False)

    def negative_real(self) -> int:
        """Return 0: no eigenvalue has a negative real part."""
        return 0

    def solve(self, b: np.ndarray, enough: float = 0.0) -> np.ndarray:
        """Solve A x = b for x (n,), corrected. Raises SingularMatrixError if the residual stays large."""
        if self._full is None:
            x, error = minimal_residual(self.matrix, self.solve_unrefined, b, max(enough, ROUNDED))
            if error <= BACKWARD_ERROR:
                return x
            self.more()
            self._full = self.full()
        return self._full.solve(b, enough)


def checked(x: np.ndarray, error: float) -> np.ndarray:
    """Return x. Raises SingularMatrixError if its backward error is large."""
    if not error <= BACKWARD_ERROR:  # also catches nan
        raise SingularMatrixError(f"residual {error:.1e} after refinement: singular to working precision")
    return x


class DirectSolver:
    """Factorisation of matrices of one sparsity pattern, with sorted indices and one analysis.

    symmetric: the matrices are symmetric (both triangles stored), and factors have the inertia. fronts: makes
    the fronts of the pattern, None if they are not known.
    """

    def __init__(self, symmetric: bool = True, fronts: Callable[[], Fronts] | None = None):
        self.symmetric, self._fronts = symmetric, fronts
        self._analysis: Any = None
        self._transposed: np.ndarray | None = None

    def factor(self, matrix: Matrix, more: Count = lambda: None) -> Factor:
        """Return the factors of a matrix (n, n) with the pattern of the first one.

        more: called for each further factorisation, now or in a later solution. Raises SingularMatrixError on
        a zero pivot or an entry that is not finite.
        """
        if self._fronts is not None:
            data = matrix.data if self.symmetric else self._symmetric_part(matrix)
            if signed := signed_factors(data, self._fronts()):
                solve, negative = signed
                if self.symmetric:
                    error = np.inf if negative else CHOLESKY
                    return Factor(matrix, solve, negative, backward_error=error)
                if negative == 0:
                    full = partial(self._by_library, matrix, more)
                    return SymmetricPartFactor(matrix, solve, more=more, full=full)
                more()
        return self._by_library(matrix, more)  # with pivoting

    def iterated(self, matrix: Matrix, near: Factor, rows: np.ndarray) -> None:
        """Return None: new factors cost little compared with the assembly of elements."""

    def _symmetric_part(self, matrix: Matrix) -> np.ndarray:
        """Return the data of (A + Aᵀ)/2, which has the pattern of A."""
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
    """Solve A x = b to ITERATION_ACCURACY by conjugate gradients with the factors of a nearby matrix. Return
    None if the nearby matrix is indefinite or too different. Source: Hestenes and Stiefel (1952)."""
    if near.negative != 0:
        return None
    n = len(b)
    preconditioner = LinearOperator((n, n), matvec=near.solve_unrefined, dtype=float)
    x, failed = cg(matrix, b, rtol=ITERATION_ACCURACY, maxiter=ITERATIONS, M=preconditioner)
    return None if failed or not np.isfinite(x).all() else x
