"""Stability under follower loads, whose tangent K is unsymmetric: one definition for both solvers.

An equilibrium is unstable where K has a real eigenvalue below zero: the structure then collapses, and along a
path that starts stable such an eigenvalue comes through zero, where K is singular. Complex pairs say nothing
here, whatever their real part: flutter is a matter of masses and dampers, which K does not hold.

Of a large matrix those nearest to zero are found, of which a path that begins stable crosses zero with the
first. One that is below zero and far away, behind softer stable ones, is not among them; but det K = Π λ, and
complex pairs being positive its sign tells whether the number of all is odd. Where that and the count
disagree nothing is known. Two that are far away are not seen.
Source: Bolotin, Nonconservative Problems of the Theory of Elastic Stability (1963).
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import scipy.sparse as sp
from scipy.sparse.csgraph import connected_components
from scipy.sparse.linalg import ArpackError, LinearOperator, eigs, splu

NEAREST = 12  # eigenvalues sought
DENSE = 40  # unknowns up to which all are found
REAL = 1e-3  # imaginary part over the magnitude: rounding makes such a pair of two equal real eigenvalues


def negative_real(eigenvalues: np.ndarray) -> int:
    """Return how many of these complex eigenvalues are real and below zero.

    >>> negative_real(np.array([-1.0, -2.0 + 1.0j, -2.0 - 1.0j, 3.0]))
    1
    """
    real = np.abs(eigenvalues.imag) <= REAL * np.abs(eigenvalues)
    return int(np.sum(real & (eigenvalues.real < 0.0)))


def nearest_to_zero(
    matrix: sp.sparray | sp.spmatrix, solve: Callable[[np.ndarray], np.ndarray], count: int = NEAREST
) -> np.ndarray | None:
    """The eigenvalues (complex) of least magnitude of an unsymmetric matrix, by Arnoldi on its inverse;
    all of a small one. None where the iteration finds none. solve: b (n,) → x (n,) with A x = b."""
    n = matrix.shape[0]
    if n <= max(DENSE, count + 2):
        return np.linalg.eigvals(matrix.toarray()).astype(complex)
    inverse = LinearOperator((n, n), matvec=solve, dtype=float)
    start = np.random.default_rng(0).uniform(-1.0, 1.0, n)
    try:
        found: np.ndarray = eigs(matrix, count, sigma=0.0, OPinv=inverse, v0=start, return_eigenvectors=False)
    except ArpackError:
        return None
    return found


def odd_below_zero(matrix: sp.sparray | sp.spmatrix) -> bool | None:
    """Return whether det A < 0, of its L U; None where that has no factors.

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
    """Of a permutation (n,): n less its cycles."""
    n = len(permutation)
    graph = sp.coo_array((np.ones(n), (np.arange(n), permutation)), shape=(n, n))
    return n - int(connected_components(graph)[0])
