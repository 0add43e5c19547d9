"""Vectors as tuples of three numbers: compiled loops keep them in registers, small arrays in memory."""

from __future__ import annotations

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
