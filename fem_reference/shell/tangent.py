"""The tangent of the shell's elements in their unknowns, as compiled loops.

Unknowns of an element are the displacements of its nine nodes, then two rotations β of nine directors: a
director turns in its tangent plane, δd = T β. With B on them, (54, 45), and D by parts, membrane and bending
coupled or not,

    K = Bᵀ D B + Σ s_k H_k ⊗ I,

of which the lower triangle is formed; membrane strains have nothing to do with rotations.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from fem_reference.shell.sampling import REORDERED, sampled

MOVES, UNKNOWNS = 27, 45  # of an element: displacements, and with them rotations
AT_ONCE = 3  # strains that are gone through together, whose numbers by part, 21, 21 and 12, it divides


@njit(cache=True, fastmath=REORDERED)
def tangents(
    vectors: np.ndarray,
    moduli: np.ndarray,
    coupled: bool,
    forms: np.ndarray,
    frames: np.ndarray,
    nodes: np.ndarray,
    tables: tuple[np.ndarray, np.ndarray, np.ndarray],
) -> np.ndarray:
    """K (m, 45, 45) of elements with vectors (m, 18, 3), D (m, 54, 54) and Σ s_k H_k (m, 9, 18), rows of
    positions; frames: T (n, 3, 2) of all nodes; nodes: (m, 9); tables: a, b and v of `sampling`."""
    a, b, v = tables
    plane, strains = len(a), 2 * len(a) + len(v)
    out = np.zeros((len(vectors), UNKNOWNS, UNKNOWNS))
    full = np.zeros((strains, 18, 3))
    gradient, weighed = np.zeros((strains, UNKNOWNS)), np.empty((strains, UNKNOWNS))
    for e in range(len(vectors)):
        sampled(vectors[e], a, b, v, full)
        for k in range(strains):
            for i in range(9):
                for c in range(3):
                    gradient[k, 3 * i + c] = full[k, i, c]
                if k >= plane:
                    turn, frame = full[k, 9 + i], frames[nodes[e, i]]
                    for t in range(2):
                        turned = turn[0] * frame[0, t] + turn[1] * frame[1, t] + turn[2] * frame[2, t]
                        gradient[k, MOVES + 2 * i + t] = turned
        weighed[:] = 0.0
        _add_weighed(moduli[e], gradient, 0, plane, 0, plane, MOVES, weighed)
        _add_weighed(moduli[e], gradient, plane, 2 * plane, plane, 2 * plane, UNKNOWNS, weighed)
        _add_weighed(moduli[e], gradient, 2 * plane, strains, 2 * plane, strains, UNKNOWNS, weighed)
        if coupled:
            _add_weighed(moduli[e], gradient, 0, plane, plane, 2 * plane, MOVES, weighed)
            _add_weighed(moduli[e], gradient, plane, 2 * plane, 0, plane, MOVES, weighed)
        lower = out[e]
        _add_product(gradient, weighed, 0, 0, MOVES, lower)
        _add_product(gradient, weighed, plane, MOVES, UNKNOWNS, lower)
        for i in range(9):
            for j in range(9):
                for c in range(3):
                    lower[3 * i + c, 3 * j + c] += forms[e, i, j]
                    for t in range(2):
                        lower[MOVES + 2 * j + t, 3 * i + c] += forms[e, i, 9 + j] * frames[nodes[e, j], c, t]
        for i in range(UNKNOWNS):
            for j in range(i):
                lower[j, i] = lower[i, j]
    return out


@njit(cache=True, inline="always")
def _add_weighed(
    moduli: np.ndarray,
    gradient: np.ndarray,
    first: int,
    last: int,
    start: int,
    end: int,
    columns: int,
    out: np.ndarray,
) -> None:
    """Adds D B of strains first … last from those of strains start … end, in so many columns."""
    for k in range(first, last):
        row, d = out[k], moduli[k]
        for by in range(start, end, AT_ONCE):
            d0, d1, d2 = d[by], d[by + 1], d[by + 2]
            b0, b1, b2 = gradient[by], gradient[by + 1], gradient[by + 2]
            for j in range(columns):
                row[j] += d0 * b0[j] + d1 * b1[j] + d2 * b2[j]


@njit(cache=True, inline="always")
def _add_product(
    gradient: np.ndarray, weighed: np.ndarray, start: int, first: int, last: int, lower: np.ndarray
) -> None:
    """Adds Bᵀ (D B) of strains from `start` on to the rows first … last of the lower triangle."""
    for i in range(first, last):
        row = lower[i]
        for k in range(start, len(gradient), AT_ONCE):
            b0, b1, b2 = gradient[k, i], gradient[k + 1, i], gradient[k + 2, i]
            w0, w1, w2 = weighed[k], weighed[k + 1], weighed[k + 2]
            for j in range(i + 1):
                row[j] += b0 * w0[j] + b1 * w1[j] + b2 * w2[j]
