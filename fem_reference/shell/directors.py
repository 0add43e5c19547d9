"""Unit vectors d (n, 3) as unknowns: tangent planes, the step to unit length, the multiplier of |d|² = 1."""

from __future__ import annotations

import numpy as np

from sheetbench.numerics.aliasing import empty
from sheetbench.numerics.options import njit


@njit
def tangent_frames(directors: np.ndarray, axes: np.ndarray) -> np.ndarray:
    """Return orthonormal T (n, 3, 2) with T ⊥ d; axes: numbers of the first tangents (n,), −1 for any."""
    out = empty((len(directors), 3, 2))
    for n in range(len(directors)):
        x, y, z = directors[n, 0], directors[n, 1], directors[n, 2]
        length = np.sqrt(x * x + y * y + z * z)
        x, y, z = x / length, y / length, z / length
        p, q, r = 1.0 * (axes[n] == 0), 1.0 * (axes[n] == 1), 1.0 * (axes[n] == 2)
        if axes[n] < 0:  # e_x rotated with d from e_z: continuous in d
            side = 1.0 if z > -0.5 else -1.0
            p, q, r = 1.0 - x * x / (1.0 + side * z), -x * y / (1.0 + side * z), -side * x
        out[n, 0, 0], out[n, 1, 0], out[n, 2, 0] = p, q, r
        out[n, 0, 1], out[n, 1, 1], out[n, 2, 1] = y * r - z * q, z * p - x * r, x * q - y * p
    return out


def to_unit(directors: np.ndarray) -> np.ndarray:
    """Return the step (n, 3) along d with d · δd = ½ (1 − d · d)."""
    square = np.einsum("nc,nc->n", directors, directors)
    return (0.5 / square - 0.5)[:, None] * directors


def multiplier(directors: np.ndarray, couple: np.ndarray) -> np.ndarray:
    """Return −(R_d · d)/(d · d) (n,) of residuals R_d (n, 3), the sphere's curvature, on both rotations."""
    square = np.einsum("nc,nc->n", directors, directors)
    return -np.einsum("nc,nc->n", couple, directors) / square


def projected(tangent: np.ndarray, frames: np.ndarray) -> np.ndarray:
    """Return tangents (m, 45, 45) in the elements' unknowns, from tangents (m, 18, 3, 18, 3) of loads on
    them. Unknowns: displacements of nine nodes, then two rotations β of nine directors, δd = T β; frames: T
    (m, 9, 3, 2)."""
    m = len(tangent)
    turned = tangent[:, :, :, 9:].reshape(m, 54, 9, 3).swapaxes(1, 2) @ frames
    columns = tangent[:, :, :, :9].reshape(m, 18, 3, 27), turned.swapaxes(1, 2).reshape(m, 18, 3, 18)
    right = np.concatenate(columns, axis=3)
    lower = (frames.swapaxes(2, 3) @ right[:, 9:]).reshape(m, 18, 45)
    return np.concatenate([right[:, :9].reshape(m, 27, 45), lower], axis=1)
