"""MKL's PARDISO for large lattices, where the extra `mkl` is installed: L D Lᵀ with Bunch–Kaufman pivots.

It has the face of rslab: an analysis of a pattern, factors of matrices that have it, their inertia. PARDISO
keeps one set of factors a handle, and its memory until it is released: factors that are still in use
keep their handle, and the next ones get one of their own.
"""

from __future__ import annotations

import weakref
from functools import cache
from typing import Any

import numpy as np
import scipy.sparse as sp

SYMMETRIC_INDEFINITE = -2
ANALYSE, FACTORISE, SOLVE = 11, 22, 33
# of PARDISO's `iparm`, counted from 1: no defaults; nested dissection; pivots below 1e-13 of the matrix are
# raised to that; pivots of one row and of two
SETTINGS = {1: 1, 2: 2, 10: 13, 21: 1}
RAISED, POSITIVE, NEGATIVE = 14, 22, 23  # where `iparm` tells of pivots: how many were raised; the inertia


@cache
def library() -> Any:
    """The package pypardiso, or None where it or MKL is missing."""
    try:
        import pypardiso
    except ImportError:
        return None
    return pypardiso


class Analysis:
    """The analysis of a symmetric pattern, from a matrix (n, n) with both triangles and sorted indices."""

    def __init__(self, matrix: sp.csc_array):
        n = matrix.shape[0]
        # the columns of a symmetric matrix are its rows
        self._upper = matrix.indices >= np.repeat(np.arange(n), np.diff(matrix.indptr))
        self._columns = matrix.indices[self._upper].astype(np.int32)
        self._starts = np.concatenate([[0], np.cumsum(self._upper)])[matrix.indptr].astype(np.int32)
        self._handle = self._analysed(matrix)
        self._factors: weakref.ref[Factors] | None = None

    def factor(self, matrix: sp.csc_array) -> Factors:
        """Factors of a matrix that has the pattern. Raises RuntimeError where it has none."""
        if self._factors is not None and self._factors() is not None:
            self._handle = self._analysed(matrix)
        factors = Factors(self._handle, self._triangle(matrix))
        self._factors = weakref.ref(factors)
        return factors

    def _analysed(self, matrix: sp.csc_array) -> _Handle:
        handle = _Handle()
        handle.call(ANALYSE, self._triangle(matrix))
        return handle

    def _triangle(self, matrix: sp.csc_array) -> sp.csr_matrix:
        return sp.csr_matrix((matrix.data[self._upper], self._columns, self._starts), shape=matrix.shape)


class Factors:
    """Factors of one matrix: solve(b), and the numbers of positive, negative and zero eigenvalues."""

    def __init__(self, handle: _Handle, triangle: sp.csr_matrix):
        self._handle, self._triangle = handle, triangle
        handle.call(FACTORISE, triangle)
        if raised := handle.get(RAISED):
            raise RuntimeError(f"{raised} pivots vanish")
        positive, negative = handle.get(POSITIVE), handle.get(NEGATIVE)
        self.inertia = (positive, negative, triangle.shape[0] - positive - negative)

    def solve(self, b: np.ndarray) -> np.ndarray:
        """x (n,) with A x = b."""
        return self._handle.call(SOLVE, self._triangle, b)


class _Handle:
    """PARDISO's memory, which goes with this object."""

    def __init__(self) -> None:
        self._solver = library().PyPardisoSolver(mtype=SYMMETRIC_INDEFINITE)
        for i, value in SETTINGS.items():
            self._solver.set_iparm(i, value)
        weakref.finalize(self, self._solver.free_memory, everything=True)

    def get(self, i: int) -> int:
        return int(self._solver.get_iparm(i))

    def call(self, phase: int, triangle: sp.csr_matrix, b: np.ndarray | None = None) -> np.ndarray:
        self._solver.set_phase(phase)
        try:
            x: np.ndarray = self._solver._call_pardiso(
                triangle, np.zeros(triangle.shape[0]) if b is None else b
            )
        except library().PyPardisoError as error:
            raise RuntimeError(str(error)) from None
        return x
