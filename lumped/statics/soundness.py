"""Whether links have a length left and cells face upwards, as compiled loops (`lumped.statics.faults`)."""

from __future__ import annotations

import math

import numpy as np
from numba import njit

from lumped.springs.links import measure


@njit(cache=True)
def long_enough(
    u: np.ndarray, nodes: np.ndarray, offset: np.ndarray, rest_length: np.ndarray, share: float
) -> bool:
    """Whether every link is longer than a share of its rest length, u: (n, 3) [m]; arrays as in
    `lumped.springs.links`."""
    for m in range(len(nodes)):
        square = measure(u, nodes, offset, m)[1]
        if not square >= (share * rest_length[m]) ** 2:  # also catches nan
            return False
    return True


@njit(cache=True)
def upright(columns: np.ndarray, positions: np.ndarray, areas: np.ndarray, u: np.ndarray) -> bool:
    """Whether the normal of every mid-surface cell points the way that the directors of its corners do.

    columns: (ny, nx, layers) masses; positions (n, 3) [m] at rest; areas (ny − 1, nx − 1) [m²] of the cells.
    """
    ny, nx, layers = columns.shape
    middle, director = np.zeros((ny, nx, 3)), np.empty((ny, nx, 3))
    for j in range(ny):
        for i in range(nx):
            square = 0.0
            for q in range(3):
                for k in range(layers):
                    mass = columns[j, i, k]
                    middle[j, i, q] += (positions[mass, q] + u[mass, q]) / layers
                top, bottom = columns[j, i, layers - 1], columns[j, i, 0]
                across = positions[top, q] + u[top, q] - positions[bottom, q] - u[bottom, q]
                director[j, i, q] = across
                square += across * across
            for q in range(3):
                director[j, i, q] /= max(math.sqrt(square), np.finfo(np.float64).tiny)
    first, second, mean = np.empty(3), np.empty(3), np.empty(3)
    for j in range(ny - 1):
        for i in range(nx - 1):
            for q in range(3):
                first[q] = middle[j + 1, i + 1, q] - middle[j, i, q]
                second[q] = middle[j + 1, i, q] - middle[j, i + 1, q]
                mean[q] = director[j, i, q] + director[j, i + 1, q]
                mean[q] += director[j + 1, i + 1, q] + director[j + 1, i, q]
            facing = 0.0
            for q in range(3):
                r, s = (q + 1) % 3, (q + 2) % 3
                facing += (first[r] * second[s] - first[s] * second[r]) * mean[q]
            if not 0.125 * facing / areas[j, i] > 0.0:
                return False
    return True
