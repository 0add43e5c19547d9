"""The sampled strains of the shell's elements and their derivatives, as compiled loops.

At every in-plane point k, with a and b slopes of the shape functions there (21, 9), φ the nine positions and
d the nine directors of an element,

    membrane  ½ (aᵀφ · bᵀφ − aᵀX · bᵀX),     bending   ½ (aᵀφ · bᵀd + bᵀφ · aᵀd),

and at the first points, where a is b, also shear aᵀφ · vᵀd with v the shape functions' values (12, 9).
Strains are numbered membrane, bending, shear; vectors Q are (m, 18, 3), positions first, and the strains'
derivatives B = H Q (54, 18, 3) linear in them.
"""

from __future__ import annotations

import numpy as np
from numba import njit

REORDERED = {"reassoc", "contract", "nsz"}  # sums in any order, for vector instructions; infinities count


@njit(cache=True)
def magnitudes(
    vectors: np.ndarray, stress: np.ndarray, a: np.ndarray, b: np.ndarray, v: np.ndarray
) -> np.ndarray:
    """Σ |B| |s| over elements, strains and components (18,)."""
    out, gradient = np.zeros(18), np.zeros((stress.shape[1], 18, 3))
    for e in range(len(vectors)):
        sampled(vectors[e], a, b, v, gradient)
        for k in range(len(gradient)):
            for i in range(18):
                size = abs(gradient[k, i, 0]) + abs(gradient[k, i, 1]) + abs(gradient[k, i, 2])
                out[i] += size * abs(stress[e, k])
    return out


@njit(cache=True, inline="always")
def sampled(vectors: np.ndarray, a: np.ndarray, b: np.ndarray, v: np.ndarray, out: np.ndarray) -> None:
    """B (54, 18, 3) of one element into zeros, whose membrane strains leave the directors' part alone."""
    plane, sheared = len(a), len(v)
    at, slant = np.empty((4, 3)), np.empty(3)
    for k in range(plane):
        _slopes(vectors, a[k], b[k], k < sheared, at)
        membrane, bending = out[k], out[plane + k]
        for i in range(9):
            half_a, half_b = 0.5 * a[k, i], 0.5 * b[k, i]
            for c in range(3):
                stretched = half_a * at[1, c] + half_b * at[0, c]
                membrane[i, c] = stretched
                bending[i, c] = half_a * at[3, c] + half_b * at[2, c]
                bending[i + 9, c] = stretched
        if k < sheared:
            _weighed(vectors[9:], v[k], slant)
            shear = out[2 * plane + k]
            for i in range(9):
                for c in range(3):
                    shear[i, c] = a[k, i] * slant[c]
                    shear[i + 9, c] = v[k, i] * at[0, c]


@njit(cache=True, fastmath=REORDERED)
def strain_of(
    vectors: np.ndarray, step: np.ndarray, a: np.ndarray, b: np.ndarray, v: np.ndarray
) -> np.ndarray:
    """B δQ (m, 54) of a step (m, 18, 3) from the vectors."""
    plane, sheared = len(a), len(v)
    out = np.empty((len(step), 2 * plane + sheared))
    at, by = np.empty((4, 3)), np.empty((4, 3))
    slant, slanting = np.empty(3), np.empty(3)
    for e in range(len(step)):
        for k in range(plane):
            _slopes(vectors[e], a[k], b[k], k < sheared, at)
            _slopes(step[e], a[k], b[k], k < sheared, by)
            stretched = bent = 0.0
            for c in range(3):
                stretched += at[0, c] * by[1, c] + at[1, c] * by[0, c]
                bent += at[0, c] * by[3, c] + at[1, c] * by[2, c] + at[2, c] * by[1, c] + at[3, c] * by[0, c]
            out[e, k], out[e, plane + k] = 0.5 * stretched, 0.5 * bent
            if k < sheared:
                _weighed(vectors[e, 9:], v[k], slant)
                _weighed(step[e, 9:], v[k], slanting)
                sheared_by = 0.0
                for c in range(3):
                    sheared_by += at[0, c] * slanting[c] + slant[c] * by[0, c]
                out[e, 2 * plane + k] = sheared_by
    return out


@njit(cache=True, fastmath=REORDERED)
def forces_of(
    vectors: np.ndarray, stress: np.ndarray, a: np.ndarray, b: np.ndarray, v: np.ndarray
) -> np.ndarray:
    """Bᵀ s (m, 18, 3) of stresses (m, 54); of a step in place of the vectors, what it adds to Bᵀ s."""
    plane, sheared = len(a), len(v)
    out = np.zeros((len(vectors), 18, 3))
    at, slant = np.empty((4, 3)), np.empty(3)
    by_a, by_b = np.empty((2, 3)), np.empty((2, 3))  # what slopes a and b are multiplied by, of φ and of d
    for e in range(len(vectors)):
        for k in range(plane):
            _slopes(vectors[e], a[k], b[k], k < sheared, at)
            pull, turn = 0.5 * stress[e, k], 0.5 * stress[e, plane + k]
            for c in range(3):
                by_a[0, c], by_a[1, c] = pull * at[1, c] + turn * at[3, c], turn * at[1, c]
                by_b[0, c], by_b[1, c] = pull * at[0, c] + turn * at[2, c], turn * at[0, c]
            by_value = 0.0
            if k < sheared:
                by_value = stress[e, 2 * plane + k]
                _weighed(vectors[e, 9:], v[k], slant)
                for c in range(3):
                    by_a[0, c] += by_value * slant[c]
            for i in range(9):
                for c in range(3):
                    out[e, i, c] += a[k, i] * by_a[0, c] + b[k, i] * by_b[0, c]
                    out[e, i + 9, c] += a[k, i] * by_a[1, c] + b[k, i] * by_b[1, c]
                    if k < sheared:
                        out[e, i + 9, c] += v[k, i] * by_value * at[0, c]
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
