"""Conjugate gradients with the factors of a matrix close by (Hestenes and Stiefel 1952)."""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp
from scipy.sparse.linalg import LinearOperator, cg

from sheetbench.numerics.reduced import Factor

ACCURACY = 1e-4  # residual over the right-hand side: a Newton correction gains few digits more than that
MOST = 20  # iterations: each costs a solution with the factors


def iterated(matrix: sp.csc_array, near: Factor, b: np.ndarray) -> np.ndarray | None:
    """x with A x = b to ACCURACY; None where the factors are those of an indefinite matrix or too far off."""
    if near.negative != 0:
        return None
    n = len(b)
    preconditioner = LinearOperator((n, n), matvec=near.solve_unrefined, dtype=float)
    x, failed = cg(matrix, b, rtol=ACCURACY, maxiter=MOST, M=preconditioner)
    return None if failed or not np.isfinite(x).all() else x
