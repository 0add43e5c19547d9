"""Sampled strains of the shell's elements and their derivatives, as compiled loops.

At every in-plane point k, with a and b slopes of the shape functions there, φ the nine positions and d the
nine directors of an element,

    membrane  ½ (aᵀφ · bᵀφ − aᵀX · bᵀX),     bending   ½ (aᵀφ · bᵀd + bᵀφ · aᵀd),

and at the first points, where a is b, also shear aᵀφ · vᵀd with v the shape functions' values. Strains are
numbered membrane, bending, shear; vectors Q are (m, 18, 3), positions first, and the strains' derivatives
B = H Q (54, 18, 3) linear in them. tables: a, b and v one after the other (9, 54), so that loops go along all
points at once, in vector instructions.
"""

from __future__ import annotations

import numpy as np

from sheetbench.numerics.aliasing import empty, zeros
from sheetbench.numerics.options import REORDERED, inner, njit

PLANE, SHEARED = 21, 12  # in-plane points, of which the first ones have shear


@njit(fastmath=REORDERED)
def magnitudes(vectors: np.ndarray, stress: np.ndarray, tables: np.ndarray) -> np.ndarray:
    """Return Σ |B| |s| (18,) over elements, strains and components."""
    strains = tables.shape[1]
    out, gradient, at = zeros(18), zeros((strains, 18, 3)), empty((6, strains))
    for e in range(len(vectors)):
        sampled(vectors[e], tables, at, gradient)
        for k in range(strains):
            for i in range(18):
                size = abs(gradient[k, i, 0]) + abs(gradient[k, i, 1]) + abs(gradient[k, i, 2])
                out[i] += size * abs(stress[e, k])
    return out


@inner(fastmath=REORDERED)
def sampled(vectors: np.ndarray, tables: np.ndarray, at: np.ndarray, out: np.ndarray) -> None:
    """Write B (54, 18, 3) of one element into zeros, without the zero parts; at: scratch (6, 54)."""
    _weighted_sums(vectors, tables, at)
    for k in range(PLANE):
        b = PLANE + k
        membrane, bending = out[k], out[b]
        for i in range(9):
            half_a, half_b = 0.5 * tables[i, k], 0.5 * tables[i, b]
            for c in range(3):
                stretched = half_a * at[c, b] + half_b * at[c, k]
                membrane[i, c] = stretched
                bending[i, c] = half_a * at[3 + c, b] + half_b * at[3 + c, k]
                bending[i + 9, c] = stretched
        if k < SHEARED:
            s = 2 * PLANE + k
            shear = out[s]
            for i in range(9):
                for c in range(3):
                    shear[i, c] = tables[i, k] * at[3 + c, s]
                    shear[i + 9, c] = tables[i, s] * at[c, k]


@njit(fastmath=REORDERED)
def strain_of(vectors: np.ndarray, step: np.ndarray, tables: np.ndarray) -> np.ndarray:
    """Return B δQ (m, 54) of a step (m, 18, 3) from the vectors."""
    strains = tables.shape[1]
    out = zeros((len(step), strains))
    at, by = empty((6, strains)), empty((6, strains))
    for e in range(len(step)):
        _weighted_sums(vectors[e], tables, at)
        _weighted_sums(step[e], tables, by)
        strain = out[e]
        for c in range(3):
            place, turn, place_by, turn_by = at[c], at[3 + c], by[c], by[3 + c]
            for k in range(PLANE):
                b = PLANE + k
                strain[k] += 0.5 * (place[k] * place_by[b] + place[b] * place_by[k])
                bent = place[k] * turn_by[b] + place[b] * turn_by[k]
                strain[b] += 0.5 * (bent + turn[k] * place_by[b] + turn[b] * place_by[k])
            for k in range(SHEARED):
                s = 2 * PLANE + k
                strain[s] += place[k] * turn_by[s] + turn[s] * place_by[k]
    return out


@njit(fastmath=REORDERED)
def forces_of(vectors: np.ndarray, stress: np.ndarray, tables: np.ndarray) -> np.ndarray:
    """Return Bᵀ s (m, 18, 3) of stresses (m, 54); with a step in place of the vectors, its change of Bᵀ s."""
    strains = tables.shape[1]
    out, at = empty((len(vectors), 18, 3)), empty((6, strains))
    on_places, on_turns = zeros(strains), zeros(strains)  # factors of the tables, of φ and of d
    for e in range(len(vectors)):
        _weighted_sums(vectors[e], tables, at)
        pull = stress[e]
        for c in range(3):
            place, turn = at[c], at[3 + c]
            for k in range(PLANE):
                b = PLANE + k
                on_places[k] = 0.5 * (pull[k] * place[b] + pull[b] * turn[b])
                on_places[b] = 0.5 * (pull[k] * place[k] + pull[b] * turn[k])
                on_turns[k] = 0.5 * pull[b] * place[b]
                on_turns[b] = 0.5 * pull[b] * place[k]
            for k in range(SHEARED):
                s = 2 * PLANE + k
                on_places[k] += pull[s] * turn[s]
                on_turns[s] = pull[s] * place[k]
            _sums_over_points(tables, on_places, out[e, :9, c])
            _sums_over_points(tables, on_turns, out[e, 9:, c])
    return out


@inner(fastmath=REORDERED)
def _weighted_sums(vectors: np.ndarray, tables: np.ndarray, out: np.ndarray) -> None:
    """Write sums (6, 54) of one element's vectors (18, 3) with the tables, positions then directors."""
    for row in range(6):
        v, total = vectors[9 * (row // 3) : 9 * (row // 3) + 9, row % 3], out[row]
        for k in range(len(total)):
            entry = 0.0
            for i in range(9):
                entry += tables[i, k] * v[i]
            total[k] = entry


@inner(fastmath=REORDERED)
def _sums_over_points(tables: np.ndarray, by: np.ndarray, out: np.ndarray) -> None:
    """Write sums (9,) over the points of the tables times factors (54,)."""
    for i in range(9):
        total = 0.0
        for k in range(len(by)):
            total += tables[i, k] * by[k]
        out[i] = total
