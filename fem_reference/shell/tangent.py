"""The tangent of the shell's elements in their unknowns, as compiled loops.

Unknowns of an element are the displacements of its nine nodes, then two rotations β of nine directors: a
director turns in its tangent plane, δd = T β. With B on them, (54, 45), and D by parts, these coupled or not,

    K = Bᵀ D B + Σ s_k H_k ⊗ I,

of which the lower triangle is formed; membrane strains have nothing to do with rotations.
"""

from __future__ import annotations

import numpy as np

from fem_reference.shell.sampling import PLANE, REORDERED, sampled
from sheetbench.numerics.typed import njit

MOVES, UNKNOWNS = 27, 45  # of an element: displacements, and with them rotations
AT_ONCE = 3  # strains and unknowns that are gone through together, whose numbers by part it divides
LANES = 4  # numbers in a vector instruction: loops go on to whole vectors, into columns that nothing looks at
FEW, ALL = -(-MOVES // LANES) * LANES, -(-UNKNOWNS // LANES) * LANES


@njit(cache=True, fastmath=REORDERED)
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
    """Add K of elements with vectors (m, 18, 3), D (m, 54, 54) and Σ s_k H_k (m, 9, 18), rows of positions,
    to the data of a matrix, at slots (m, 45, 45), −1 for none; frames: T (n, 3, 2) of all nodes; nodes:
    (m, 9); tables: of `sampling`."""
    plane, strains = PLANE, tables.shape[1]
    gradient, at = np.zeros((strains, 54)), np.empty((6, strains))
    weighed, lower = np.empty((strains, ALL)), np.empty((UNKNOWNS, ALL))
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


@njit(cache=True, inline="always")
def _add_weighed(moduli: np.ndarray, coupled: bool, gradient: np.ndarray, out: np.ndarray) -> None:
    """Adds D B; blocks of D that are zero, as many are where sides lie along the axes, are left out, and so
    are rotations in the rows of membrane strains."""
    for k in range(0, len(out), AT_ONCE):
        row0, row1, row2 = out[k], out[k + 1], out[k + 2]
        columns = FEW if k < PLANE else ALL
        start, end = k // PLANE * PLANE, min((k // PLANE + 1) * PLANE, len(out))
        if coupled:
            start, end = 0, len(out)
        for by in range(start, end, AT_ONCE):
            d00, d01, d02 = moduli[k, by], moduli[k, by + 1], moduli[k, by + 2]
            d10, d11, d12 = moduli[k + 1, by], moduli[k + 1, by + 1], moduli[k + 1, by + 2]
            d20, d21, d22 = moduli[k + 2, by], moduli[k + 2, by + 1], moduli[k + 2, by + 2]
            size = abs(d00) + abs(d01) + abs(d02) + abs(d10) + abs(d11) + abs(d12)
            if size + abs(d20) + abs(d21) + abs(d22) == 0.0:
                continue
            b0, b1, b2 = gradient[by], gradient[by + 1], gradient[by + 2]
            for j in range(columns):
                x, y, z = b0[j], b1[j], b2[j]
                row0[j] += d00 * x + d01 * y + d02 * z
                row1[j] += d10 * x + d11 * y + d12 * z
                row2[j] += d20 * x + d21 * y + d22 * z


@njit(cache=True, inline="always")
def _add_product(gradient: np.ndarray, weighed: np.ndarray, lower: np.ndarray) -> None:
    """Adds Bᵀ (D B) to the lower triangle; membrane strains have no rotations."""
    for i in range(0, UNKNOWNS, AT_ONCE):
        row0, row1, row2 = lower[i], lower[i + 1], lower[i + 2]
        columns = -(-(i + AT_ONCE) // LANES) * LANES
        for k in range(0 if i < MOVES else PLANE, len(gradient), AT_ONCE):
            b00, b01, b02 = gradient[k, i], gradient[k, i + 1], gradient[k, i + 2]
            b10, b11, b12 = gradient[k + 1, i], gradient[k + 1, i + 1], gradient[k + 1, i + 2]
            b20, b21, b22 = gradient[k + 2, i], gradient[k + 2, i + 1], gradient[k + 2, i + 2]
            w0, w1, w2 = weighed[k], weighed[k + 1], weighed[k + 2]
            for j in range(columns):
                x, y, z = w0[j], w1[j], w2[j]
                row0[j] += b00 * x + b10 * y + b20 * z
                row1[j] += b01 * x + b11 * y + b21 * z
                row2[j] += b02 * x + b12 * y + b22 * z
