"""Unit vectors d (n, 3) as unknowns: tangent planes, the step to unit length, the multiplier of |d|² = 1."""

from __future__ import annotations

import numpy as np


def tangent_frames(directors: np.ndarray, nodes: np.ndarray, axes: np.ndarray) -> np.ndarray:
    """Orthonormal T (n, 3, 2) with T ⊥ d, whose first tangent is the given axis at the given nodes (k,)."""
    unit = directors / np.linalg.norm(directors, axis=1, keepdims=True)
    axis = np.eye(3)[np.argmin(np.abs(unit), axis=1)]
    first = np.cross(axis, unit)
    first /= np.linalg.norm(first, axis=1, keepdims=True)
    first[nodes] = np.eye(3)[axes]
    return np.stack([first, np.cross(unit, first)], axis=-1)


def to_unit(directors: np.ndarray) -> np.ndarray:
    """The step (n, 3) along d with d · δd = ½ (1 − d · d)."""
    square = np.einsum("nc,nc->n", directors, directors)
    return (0.5 * (1.0 - square) / square)[:, None] * directors


def multiplier(directors: np.ndarray, couple: np.ndarray) -> np.ndarray:
    """−(R_d · d)/(d · d) (n,) of residuals R_d (n, 3): the curvature of the sphere, on both rotations."""
    square = np.einsum("nc,nc->n", directors, directors)
    return -np.einsum("nc,nc->n", couple, directors) / square
