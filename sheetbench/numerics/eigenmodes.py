"""The lowest modes of K φ = λ M φ, K symmetric and M symmetric positive definite."""

from collections.abc import Callable
from typing import Any

import numpy as np
import scipy.linalg
from scipy.sparse.linalg import LinearOperator, eigsh

from sheetbench.numerics.direct import DirectSolver, Factor

DENSE = 600  # unknowns up to which dense matrices are quicker; a third of them for one mode alone
SHARE = 2  # dense matrices also for half of all modes or more
FEW = 8  # vectors of Lanczos' method for one mode, for which ARPACK would take 20


def lowest_modes(
    stiffness: Any,
    mass: Any,
    count: int,
    shift: float = 0.0,
    factor: Callable[[], Factor] | None = None,
    dense: int = DENSE,
) -> tuple[np.ndarray, np.ndarray]:
    """Return the lowest eigenvalues (count,), rising, and their eigenvectors (n, count), φᵀ M φ = 1.

    stiffness, mass: sparse (n, n). count: at most n. shift: σ below the spectrum, or 0 for a positive
    definite K: Lanczos' method is applied to (K − σM)⁻¹. factor: makes its factors, if not by `DirectSolver`
    without fronts. dense: unknowns up to which dense matrices are used for several modes. Raises
    SingularMatrixError if K − σM has no factors.

    >>> import scipy.sparse as sp
    >>> values, vectors = lowest_modes(sp.diags_array([4.0, 1.0, 9.0]), sp.eye_array(3), 2)
    >>> values
    array([1., 4.])
    """
    n = stiffness.shape[0]
    if n <= max(dense if count > 1 else dense // 3, SHARE * count):
        modes = scipy.linalg.eigh(stiffness.toarray(), mass.toarray(), subset_by_index=[0, count - 1])
        return modes[0], modes[1]
    factors = factor() if factor else DirectSolver().factor(stiffness - shift * mass if shift else stiffness)
    inverse = LinearOperator((n, n), matvec=factors.solve, dtype=float)
    start = np.random.default_rng(0).uniform(-1.0, 1.0, n)
    basis = FEW if count == 1 else None
    values, vectors = eigsh(stiffness, count, mass, sigma=shift, OPinv=inverse, v0=start, ncv=basis)
    order = np.argsort(values)
    return values[order], vectors[:, order]
