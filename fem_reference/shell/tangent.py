"""Tangent of the shell's elements in their unknowns, as compiled loops.

Unknowns of an element are the displacements of its nine nodes, then two rotations β of nine directors: a
director turns in its tangent plane, δd = T β. The tangent, with B (54, 45) on the unknowns and D by coupled
or uncoupled parts, is

    K = Bᵀ D B + Σ s_k H_k ⊗ I,

of which the lower triangle is formed; membrane strains do not depend on rotations.
"""

from __future__ import annotations

import numpy as np

from fem_reference.shell.sampling import PLANE, sampled
from sheetbench.numerics.aliasing import empty, zeros
from sheetbench.numerics.options import REORDERED, njit

MOVES, UNKNOWNS = 27, 45  # of an element: displacements; displacements and rotations
AT_ONCE = 3  # strains and unknowns of a block; it divides their numbers by part
LANES = 4  # numbers in a vector instruction: loops go on to whole vectors, into unused columns
FEW, ALL = -(-MOVES // LANES) * LANES, -(-UNKNOWNS // LANES) * LANES


@njit(fastmath=REORDERED)
def add_tangents(
    vectors: np.ndarray,
    moduli: np.ndarray,
    coupled: bool,
    forms: np.ndarray,
    frames: np.ndarray,
    nodes: np.ndarray,
    tables: np.ndarray,
    slots: np.ndarray,
    data: np.ndarray,
) -> None:
    """Add K of elements to the data of a matrix, at slots (m, 45, 45), −1 for none. Elements have vectors (m,
    18, 3), D (m, 54, 54) and Σ s_k H_k (m, 9, 18), rows of positions; frames: T (n, 3, 2) of all nodes;
    nodes: (m, 9); tables: of `sampling`."""
    plane, strains = PLANE, tables.shape[1]
    gradient, at = zeros((strains, 54)), empty((6, strains))
    weighed, lower = empty((strains, ALL)), empty((UNKNOWNS, ALL))
    for e in range(len(vectors)):
        sampled(vectors[e], tables, at, gradient.reshape(strains, 18, 3))
        for i in range(9):
            frame, turn, turned = frames[nodes[e, i]], MOVES + 3 * i, MOVES + 2 * i
            for k in range(plane, strains):  # in place
                x, y, z = gradient[k, turn], gradient[k, turn + 1], gradient[k, turn + 2]
                gradient[k, turned] = x * frame[0, 0] + y * frame[1, 0] + z * frame[2, 0]
                gradient[k, turned + 1] = x * frame[0, 1] + y * frame[1, 1] + z * frame[2, 1]
        weighed[:] = 0.0
        lower[:] = 0.0
        _add_weighed(moduli[e], coupled, gradient, weighed)
        _add_product(gradient, weighed, lower)
        for i in range(9):
            for j in range(9):
                for c in range(3):
                    lower[3 * i + c, 3 * j + c] += forms[e, i, j]
                    for t in range(2):
                        lower[MOVES + 2 * j + t, 3 * i + c] += forms[e, i, 9 + j] * frames[nodes[e, j], c, t]
        for i in range(UNKNOWNS):
            for j in range(i + 1):
                if slots[e, i, j] >= 0:
                    data[slots[e, i, j]] += lower[i, j]
                    if j < i:
                        data[slots[e, j, i]] += lower[i, j]


@njit(inline="always")
def _add_weighed(moduli: np.ndarray, coupled: bool, gradient: np.ndarray, out: np.ndarray) -> None:
    """Add D B, without rotations in the rows of membrane strains. Blocks of D that are zero are left out:
    they are many where sides lie along the axes."""
    for k in range(0, len(out), AT_ONCE):
        columns = FEW if k < PLANE else ALL
        start, end = k // PLANE * PLANE, min((k // PLANE + 1) * PLANE, len(out))
        if coupled:
            start, end = 0, len(out)
        for by in range(start, end, AT_ONCE):
            _add_block(moduli, k, by, gradient, out, columns)


@njit(inline="always")
def _add_product(gradient: np.ndarray, weighed: np.ndarray, lower: np.ndarray) -> None:
    """Add Bᵀ (D B) to the lower triangle; membrane strains have no rotations."""
    for i in range(0, UNKNOWNS, AT_ONCE):
        for k in range(0 if i < MOVES else PLANE, len(gradient), AT_ONCE):
            _add_block(gradient.T, i, k, weighed, lower, -(-(i + AT_ONCE) // LANES) * LANES)


@njit(inline="always")
def _add_block(a: np.ndarray, i: int, k: int, b: np.ndarray, out: np.ndarray, columns: int) -> None:
    """Add the product of the 3 × 3 block of a at i, k with rows of b to `out`, unless the block is zero."""
    a00, a01, a02 = a[i, k], a[i, k + 1], a[i, k + 2]
    a10, a11, a12 = a[i + 1, k], a[i + 1, k + 1], a[i + 1, k + 2]
    a20, a21, a22 = a[i + 2, k], a[i + 2, k + 1], a[i + 2, k + 2]
    size = abs(a00) + abs(a01) + abs(a02) + abs(a10) + abs(a11) + abs(a12)
    row0, row1, row2, b0, b1, b2 = out[i], out[i + 1], out[i + 2], b[k], b[k + 1], b[k + 2]
    for j in range(columns if size + abs(a20) + abs(a21) + abs(a22) != 0.0 else 0):
        x, y, z = b0[j], b1[j], b2[j]
        row0[j] += a00 * x + a01 * y + a02 * z
        row1[j] += a10 * x + a11 * y + a12 * z
        row2[j] += a20 * x + a21 * y + a22 * z
