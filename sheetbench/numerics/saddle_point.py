"""Saddle points: a symmetric matrix with constraints' multipliers among its unknowns, modified for L D Lᵀ.

A solver that pivots within small fronts fails on the zero diagonal of [K Jᵀ; J 0], and K without constraints
may be singular (a director that only its constraints hold). An equivalent system, up to ε, is

    [K + ρ JᵀJ  Jᵀ; J  −ε] x = (b1 + ρ Jᵀ b2, b2),

which is quasi-definite if K is positive on the constraints' null space: it has factors in any order
(Vanderbei 1995), with one negative eigenvalue more for every multiplier. The weight ρ makes ρ JᵀJ as large
as the largest entry of K among the constrained coordinates. Corrections with the matrix itself remove ε.
If stiff parts of K meet at nearly dependent constraints (the joints of a long chain), J K⁻¹ Jᵀ has a few
eigenvalues of the order of ε and below, whose error plain refinement removes slowly or never.
`minimal_residual` removes it in as many steps as they form groups (Eisenstat, Elman and Schultz 1983, GCR).
"""

from collections.abc import Callable

import numpy as np
import scipy.sparse as sp

SHIFT = 1e-6  # ε ρ: each correction gains some six digits, and six digits are lost by rounding
CORRECTIONS = 12  # of one solution
ROUNDED = 1e-15  # residual, relative to the matrix and the vectors, at which corrections end


class Saddle:
    """Places of the constraints in a matrix of a fixed pattern, given by row and column of every entry.

    multipliers: (m,) bool. Coordinates of one constraint must be neighbours in the pattern.
    """

    def __init__(self, rows: np.ndarray, columns: np.ndarray, multipliers: np.ndarray):
        self._multipliers = np.flatnonzero(multipliers)
        order = np.cumsum(multipliers) - 1
        of_constraint = np.flatnonzero(multipliers[rows] & ~multipliers[columns])
        self._coordinates, place = np.unique(columns[of_constraint], return_inverse=True)
        self._jacobian_at = of_constraint
        self._jacobian_place = (order[rows[of_constraint]], place)
        coordinate = np.full(len(multipliers), -1)
        coordinate[self._coordinates] = np.arange(len(self._coordinates))
        self._block_at = np.flatnonzero((coordinate[rows] >= 0) & (coordinate[columns] >= 0))
        self._block_place = (coordinate[rows[self._block_at]], coordinate[columns[self._block_at]])
        self._diagonal = np.flatnonzero((rows == columns) & multipliers[columns])

    def quasi_definite(self, matrix: sp.csc_array) -> tuple[sp.csc_array, Callable[[np.ndarray], np.ndarray]]:
        """Return the matrix to factor, and a function that augments right-hand sides for it."""
        jacobian = np.zeros((len(self._multipliers), len(self._coordinates)))
        jacobian[self._jacobian_place] = matrix.data[self._jacobian_at]
        weight = float(np.abs(matrix.data[self._block_at]).max() / np.abs(jacobian).max() ** 2)
        close_by = matrix.copy()
        close_by.data[self._diagonal] -= SHIFT / weight
        close_by.data[self._block_at] += weight * (jacobian.T @ jacobian)[self._block_place]

        def augmented(b: np.ndarray) -> np.ndarray:
            out = b.copy()
            out[self._coordinates] += weight * (jacobian.T @ b[self._multipliers])
            return out

        return close_by, augmented


def minimal_residual(
    matrix: sp.csc_array, solve: Callable[[np.ndarray], np.ndarray], b: np.ndarray, enough: float = ROUNDED
) -> tuple[np.ndarray, float]:
    """Solve A x = b by corrections of least residual with the factors of a nearby matrix; return x and error.
    The error is the residual relative to ‖A‖‖x‖ + ‖b‖ (largest entries); `enough` ends the corrections."""
    largest = np.abs(matrix.data).max(initial=0.0)
    x, residual, error = np.zeros_like(b), b, 1.0
    directions: list[tuple[np.ndarray, np.ndarray]] = []  # and their products with the matrix, orthonormal
    for _ in range(CORRECTIONS):
        direction = solve(residual)
        product = matrix @ direction
        for other, of_other in directions:
            share = float(of_other @ product)
            direction, product = direction - share * other, product - share * of_other
        length = float(np.linalg.norm(product))
        if not 0.0 < length < np.inf:
            break
        directions.append((direction / length, product / length))
        x = x + float(directions[-1][1] @ residual) * directions[-1][0]
        residual = b - matrix @ x
        error = float(np.abs(residual).max() / (largest * np.abs(x).max() + np.abs(b).max()))
        if error <= enough:
            break
    return x, error if b.any() else 0.0
