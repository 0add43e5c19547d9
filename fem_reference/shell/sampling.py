"""The sampled strains of the shell's elements and their derivatives, as compiled loops.

At every in-plane point k, with a and b slopes of the shape functions there (21, 9), φ the nine positions and
d the nine directors of an element,

    membrane  ½ (aᵀφ · bᵀφ − aᵀX · bᵀX),     bending   ½ (aᵀφ · bᵀd + bᵀφ · aᵀd),

and at the first points, where a is b, also shear aᵀφ · vᵀd with v the shape functions' values (12, 9).
Strains are numbered membrane, bending, shear; vectors are (m, 18, 3), positions first.
"""

from __future__ import annotations

import numpy as np
from numba import njit


@njit(cache=True)
def gradient(vectors: np.ndarray, a: np.ndarray, b: np.ndarray, v: np.ndarray) -> np.ndarray:
    """The strains' derivatives (m, 54, 18, 3) at the vectors."""
    plane, sheared = len(a), len(v)
    out = np.empty((len(vectors), 2 * plane + sheared, 18, 3))
    out[:, :plane, 9:] = 0.0
    at, slant = np.empty((4, 3)), np.empty(3)
    for e in range(len(vectors)):
        for k in range(plane):
            _slopes(vectors[e], a[k], b[k], k < sheared, at)
            membrane, bending = out[e, k], out[e, plane + k]
            for i in range(9):
                half_a, half_b = 0.5 * a[k, i], 0.5 * b[k, i]
                for c in range(3):
                    stretched = half_a * at[1, c] + half_b * at[0, c]
                    membrane[i, c] = stretched
                    bending[i, c] = half_a * at[3, c] + half_b * at[2, c]
                    bending[i + 9, c] = stretched
        for k in range(sheared):
            _slopes(vectors[e], a[k], b[k], True, at)
            _weighed(vectors[e, 9:], v[k], slant)
            shear = out[e, 2 * plane + k]
            for i in range(9):
                for c in range(3):
                    shear[i, c] = a[k, i] * slant[c]
                    shear[i + 9, c] = v[k, i] * at[0, c]
    return out


@njit(cache=True)
def strain(
    change: np.ndarray, reference: np.ndarray, a: np.ndarray, b: np.ndarray, v: np.ndarray
) -> np.ndarray:
    """The strains (m, 54) of a change of the reference vectors: its product with the derivatives half way,
    which keeps the digits of a small one."""
    plane, sheared = len(a), len(v)
    out = np.zeros((len(change), 2 * plane + sheared))
    half, at, by = np.empty((18, 3)), np.empty((4, 3)), np.empty((4, 3))
    slant, slanting = np.empty(3), np.empty(3)
    for e in range(len(change)):
        half[:] = reference[e] + 0.5 * change[e]
        for k in range(plane):
            _slopes(half, a[k], b[k], k < sheared, at)
            _slopes(change[e], a[k], b[k], k < sheared, by)
            for c in range(3):
                out[e, k] += 0.5 * (at[0, c] * by[1, c] + at[1, c] * by[0, c])
                bent = at[0, c] * by[3, c] + at[1, c] * by[2, c] + at[2, c] * by[1, c] + at[3, c] * by[0, c]
                out[e, plane + k] += 0.5 * bent
            if k < sheared:
                _weighed(half[9:], v[k], slant)
                _weighed(change[e, 9:], v[k], slanting)
                for c in range(3):
                    out[e, 2 * plane + k] += at[0, c] * slanting[c] + slant[c] * by[0, c]
    return out


@njit(cache=True, inline="always")
def _slopes(vectors: np.ndarray, a: np.ndarray, b: np.ndarray, same: bool, out: np.ndarray) -> None:
    """aᵀφ, bᵀφ, aᵀd and bᵀd of one element's vectors (18, 3) into (4, 3); same: b is a."""
    _weighed(vectors[:9], a, out[0])
    _weighed(vectors[9:], a, out[2])
    if same:
        out[1], out[3] = out[0], out[2]
    else:
        _weighed(vectors[:9], b, out[1])
        _weighed(vectors[9:], b, out[3])


@njit(cache=True, inline="always")
def _weighed(vectors: np.ndarray, weights: np.ndarray, out: np.ndarray) -> None:
    x = y = z = 0.0
    for i in range(9):
        x += weights[i] * vectors[i, 0]
        y += weights[i] * vectors[i, 1]
        z += weights[i] * vectors[i, 2]
    out[0], out[1], out[2] = x, y, z
