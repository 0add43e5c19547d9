"""Vectors as tuples of three numbers: compiled loops keep them in registers, small arrays in memory."""

from __future__ import annotations

import numpy as np
from numba import njit

Vector = tuple[float, float, float]


@njit(cache=True, error_model="numpy")
def plus(a: Vector, b: Vector) -> Vector:
    """a + b."""
    return a[0] + b[0], a[1] + b[1], a[2] + b[2]


@njit(cache=True, error_model="numpy")
def less(a: Vector, b: Vector) -> Vector:
    """a − b."""
    return a[0] - b[0], a[1] - b[1], a[2] - b[2]


@njit(cache=True, error_model="numpy")
def times(k: float, a: Vector) -> Vector:
    """k a."""
    return k * a[0], k * a[1], k * a[2]


@njit(cache=True, error_model="numpy")
def dot(a: Vector, b: Vector) -> float:
    """a·b."""
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


@njit(cache=True, error_model="numpy")
def cross(a: Vector, b: Vector) -> Vector:
    """a × b."""
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


@njit(cache=True, error_model="numpy")
def outer(k: float, a: Vector, b: Vector, out: np.ndarray) -> None:
    """k a bᵀ into `out` (9,), row by row."""
    x, y, z = times(k, a)
    out[0], out[1], out[2] = x * b[0], x * b[1], x * b[2]
    out[3], out[4], out[5] = y * b[0], y * b[1], y * b[2]
    out[6], out[7], out[8] = z * b[0], z * b[1], z * b[2]


@njit(cache=True, error_model="numpy")
def outer_sum(
    k: float, a: Vector, b: Vector, m: float, c: Vector, d: Vector, along: float, out: np.ndarray
) -> None:
    """k a bᵀ + m c dᵀ + along I into `out` (9,), row by row."""
    x, y, z = times(k, a)
    r, s, t = times(m, c)
    out[0], out[1], out[2] = x * b[0] + r * d[0] + along, x * b[1] + r * d[1], x * b[2] + r * d[2]
    out[3], out[4], out[5] = y * b[0] + s * d[0], y * b[1] + s * d[1] + along, y * b[2] + s * d[2]
    out[6], out[7], out[8] = z * b[0] + t * d[0], z * b[1] + t * d[1], z * b[2] + t * d[2] + along
