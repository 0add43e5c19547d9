"""Monomials of a few coordinates: their values, gradients and sums, as compiled loops.

A monomial is a row of coordinate numbers, i ≤ j ≤ …, padded with −1: (0, 0, 2, −1) is q₀² q₂.
"""

from __future__ import annotations

from itertools import combinations_with_replacement

import numpy as np
from numba import njit

WIDEST = 4  # the highest degree


def monomials(count: int, degrees: tuple[int, ...]) -> np.ndarray:
    """All monomials of `count` coordinates of these degrees, (m, WIDEST)."""
    rows = [row for d in degrees for row in combinations_with_replacement(range(count), d)]
    return np.array([[*row, *[-1] * (WIDEST - len(row))] for row in rows])


@njit(cache=True)
def values(table: np.ndarray, q: np.ndarray) -> np.ndarray:
    """Every monomial at q, (m,)."""
    out = np.ones(len(table))
    for m in range(len(table)):
        for place in range(WIDEST):
            if table[m, place] >= 0:
                out[m] *= q[table[m, place]]
    return out


@njit(cache=True)
def gradients(table: np.ndarray, q: np.ndarray) -> np.ndarray:
    """∂/∂qᵢ of every monomial at q, (m, r)."""
    out = np.zeros((len(table), len(q)))
    for m in range(len(table)):
        for place in range(WIDEST):
            if table[m, place] < 0:
                break
            product = 1.0
            for other in range(WIDEST):
                if other != place and table[m, other] >= 0:
                    product *= q[table[m, other]]
            out[m, table[m, place]] += product
    return out


@njit(cache=True)
def add_force(
    table: np.ndarray, weight: np.ndarray, q: np.ndarray, force: np.ndarray, tangent: np.ndarray
) -> None:
    """Add gradient (r,) and second derivatives (r, r) of Σ weight × monomial at q."""
    for m in range(len(table)):
        for place in range(WIDEST):
            i = table[m, place]
            if i < 0:
                break
            product = weight[m]
            for other in range(WIDEST):
                if other != place and table[m, other] >= 0:
                    product *= q[table[m, other]]
            force[i] += product
            for second in range(WIDEST):
                j = table[m, second]
                if second == place or j < 0:
                    continue
                product = weight[m]
                for other in range(WIDEST):
                    if other != place and other != second and table[m, other] >= 0:
                        product *= q[table[m, other]]
                tangent[i, j] += product
