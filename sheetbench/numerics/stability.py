"""Stability under follower loads, whose tangent K is unsymmetric: one definition for both solvers.

An equilibrium is unstable if K has a real eigenvalue below zero: the structure then collapses. Along a path
that starts stable the eigenvalue passes through zero, where K is singular. Complex pairs are ignored,
whatever their real part: flutter depends on masses and dampers, which K does not contain.

For a large matrix the eigenvalues nearest to zero are computed; on a path that starts stable the first one to
cross zero is among them. A negative eigenvalue far from zero, behind softer stable ones, is not among them;
but det K = Π λ, and since complex pairs contribute positive factors its sign shows whether the number of
negative real eigenvalues is odd. If the sign and the count disagree, stability is not known. Two negative
eigenvalues far from zero are not detected.
Source: Bolotin, Nonconservative Problems of the Theory of Elastic Stability (1963).
"""

from collections.abc import Callable

import numpy as np
import scipy.sparse as sp
from scipy.sparse.csgraph import connected_components
from scipy.sparse.linalg import ArpackError, LinearOperator, eigs, splu

NEAREST = 12  # eigenvalues sought
DENSE = 40  # unknowns up to which all eigenvalues are computed
REAL = 1e-3  # imaginary part over the magnitude: rounding makes a complex pair of two equal real eigenvalues


def negative_real(eigenvalues: np.ndarray) -> int:
    """Return the number of complex eigenvalues that are real and below zero.

    >>> negative_real(np.array([-1.0, -2.0 + 1.0j, -2.0 - 1.0j, 3.0]))
    1
    """
    real = np.abs(eigenvalues.imag) <= REAL * np.abs(eigenvalues)
    return int(np.sum(real & (eigenvalues.real < 0.0)))


def nearest_to_zero(
    matrix: sp.sparray | sp.spmatrix, solve: Callable[[np.ndarray], np.ndarray], count: int = NEAREST
) -> np.ndarray | None:
    """Return the complex eigenvalues of least magnitude of an unsymmetric matrix, or all of a small one. The
    method is Arnoldi's on the inverse; if it does not converge, return None. solve: b (n,) → x (n,) with A x
    = b."""
    n = matrix.shape[0]
    if n <= max(DENSE, count + 2):
        return np.linalg.eigvals(matrix.toarray()).astype(complex)
    inverse = LinearOperator((n, n), matvec=solve, dtype=float)
    start = np.random.default_rng(0).uniform(-1.0, 1.0, n)
    try:
        values: np.ndarray = eigs(
            matrix, count, sigma=0.0, OPinv=inverse, v0=start, return_eigenvectors=False
        )
    except ArpackError:
        return None
    return values


def odd_below_zero(matrix: sp.sparray | sp.spmatrix) -> bool | None:
    """Return whether det A < 0 by L U, None for a matrix without factors.

    >>> odd_below_zero(sp.csc_array(np.array([[0.0, 2.0], [1.0, 0.0]])))
    True
    """
    try:
        factors = splu(sp.csc_array(matrix))
    except RuntimeError:
        return None
    of_pivots = np.sum(factors.U.diagonal() < 0.0)
    return bool((of_pivots + _transpositions(factors.perm_r) + _transpositions(factors.perm_c)) % 2)


def _transpositions(permutation: np.ndarray) -> int:
    """Return the number of transpositions of a permutation (n,): n less its number of cycles."""
    n = len(permutation)
    graph = sp.coo_array((np.ones(n), (np.arange(n), permutation)), shape=(n, n))
    return n - int(connected_components(graph)[0])
