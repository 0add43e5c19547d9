"""Products of a sparse matrix and its transpose with vectors, by compiled loops: SciPy's start slower."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import scipy.sparse as sp

from sheetbench.numerics.aliasing import zeros
from sheetbench.numerics.options import inner, njit, typed


class Rows(NamedTuple):
    """A sparse matrix by rows: row i has the columns and values pointers[i] to pointers[i + 1]."""

    pointers: np.ndarray
    columns: np.ndarray
    values: np.ndarray


def csr_arrays(matrix: sp.csr_array) -> Rows:
    """Return the arrays of a SciPy matrix with int64 integers, the one type that kernels are compiled for."""
    pointers, columns = (part.astype(np.int64) for part in (matrix.indptr, matrix.indices))
    return typed(Rows(pointers, columns, matrix.data))


@inner()
def add_product(matrix: Rows, share: float, q: np.ndarray, out: np.ndarray) -> None:
    """Add share × T q to `out` (n,); q: (m,)."""
    e = np.uint64(0)
    for row in range(len(out)):
        total, end = 0.0, np.uint64(matrix.pointers[row + 1])
        while e < end:
            total += matrix.values[e] * q[np.uint64(matrix.columns[e])]
            e += np.uint64(1)
        out[row] += share * total


@njit
def product(matrix: Rows, q: np.ndarray) -> np.ndarray:
    """Return T q (n,) of q (m,)."""
    out = zeros(len(matrix.pointers) - 1)
    add_product(matrix, 1.0, q, out)
    return out


@njit
def transposed_product(matrix: Rows, f: np.ndarray, size: int) -> np.ndarray:
    """Return Tᵀ f (size,) of f (n,)."""
    out = zeros(size)
    for row in range(len(matrix.pointers) - 1):
        for e in range(matrix.pointers[row], matrix.pointers[row + 1]):
            out[matrix.columns[e]] += matrix.values[e] * f[row]
    return out
