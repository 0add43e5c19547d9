"""Saddle points: a symmetric matrix with constraints' multipliers among its unknowns, made fit for L D Lᵀ.

A solver that pivots within small fronts fails on the zero diagonal of [K Jᵀ; J 0], and K alone may be
singular (a director that only its constraints hold). The same solution has

    [K + ρ JᵀJ  Jᵀ; J  −ε] x = (b1 + ρ Jᵀ b2, b2)     up to ε,

which is quasi-definite wherever K is positive on the constraints' null space: it has factors in any order
(Vanderbei 1995), with one negative eigenvalue more for every multiplier. The weight ρ makes ρ JᵀJ as large
as the largest entry of K among the constrained coordinates. Corrections with the matrix itself remove ε.
Where stiff parts of K meet at constraints that are nearly dependent (the joints of a long chain), J K⁻¹ Jᵀ
has a few eigenvalues of the order of ε and below, which plain refinement removes slowly or never.
`minimal_residual` removes them in as many steps as there are groups of such eigenvalues (Eisenstat, Elman and
Schultz 1983, GCR).
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import scipy.sparse as sp

SHIFT = 1e-6  # ε ρ; each correction gains about as many digits, each lost in it costs one of rounding
CORRECTIONS = 12  # of one solution
ROUNDED = 1e-15  # residual, relative to the matrix and the vectors, at which corrections end


class Saddle:
    """Where the constraints are in a matrix of a fixed pattern (row and column of every entry).

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
        """The matrix to factor, and what turns a right-hand side into the one that goes with it."""
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
    """x with A x = b, by corrections of least residual with the factors of a matrix close by, and the
    residual relative to ‖A‖‖x‖ + ‖b‖ (largest entries), at which it is `enough`."""
    largest = np.abs(matrix.data).max(initial=0.0)
    x, left, miss = np.zeros_like(b), b, 1.0
    moves: list[tuple[np.ndarray, np.ndarray]] = []  # and what the matrix makes of them, orthonormal
    for _ in range(CORRECTIONS):
        move = solve(left)
        made = matrix @ move
        for other, of_other in moves:
            share = float(of_other @ made)
            move, made = move - share * other, made - share * of_other
        length = float(np.linalg.norm(made))
        if not 0.0 < length < np.inf:
            break
        moves.append((move / length, made / length))
        x = x + float(moves[-1][1] @ left) * moves[-1][0]
        left = b - matrix @ x
        miss = float(np.abs(left).max() / (largest * np.abs(x).max() + np.abs(b).max()))
        if miss <= enough:
            break
    return x, miss if b.any() else 0.0
