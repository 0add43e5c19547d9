"""Unit vectors d (n, 3) as unknowns: tangent planes, the step to unit length, the multiplier of |d|² = 1."""

from __future__ import annotations

import numpy as np
from numba import njit


@njit(cache=True)
def tangent_frames(directors: np.ndarray, nodes: np.ndarray, axes: np.ndarray) -> np.ndarray:
    """Orthonormal T (n, 3, 2) with T ⊥ d, whose first tangent is the given axis at the given nodes (k,)."""
    out = np.zeros((len(directors), 3, 2))
    chosen = np.full(len(directors), -1)
    for i in range(len(nodes)):
        chosen[nodes[i]] = axes[i]
    for n in range(len(directors)):
        x, y, z = directors[n] / np.sqrt(np.sum(directors[n] ** 2))
        first, second = out[n, :, 0], out[n, :, 1]
        if chosen[n] >= 0:
            first[chosen[n]] = 1.0
        else:  # the axis farthest from d, times d
            if abs(x) <= abs(y) and abs(x) <= abs(z):
                first[1], first[2] = -z, y
            elif abs(y) <= abs(z):
                first[0], first[2] = z, -x
            else:
                first[0], first[1] = -y, x
            first /= np.sqrt(np.sum(first**2))
        second[0] = y * first[2] - z * first[1]
        second[1] = z * first[0] - x * first[2]
        second[2] = x * first[1] - y * first[0]
    return out


def to_unit(directors: np.ndarray) -> np.ndarray:
    """The step (n, 3) along d with d · δd = ½ (1 − d · d)."""
    square = np.einsum("nc,nc->n", directors, directors)
    return (0.5 * (1.0 - square) / square)[:, None] * directors


def multiplier(directors: np.ndarray, couple: np.ndarray) -> np.ndarray:
    """−(R_d · d)/(d · d) (n,) of residuals R_d (n, 3): the curvature of the sphere, on both rotations."""
    square = np.einsum("nc,nc->n", directors, directors)
    return -np.einsum("nc,nc->n", couple, directors) / square
