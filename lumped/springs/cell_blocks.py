"""Blocks of a cell's tangent from the derivatives of its stress, as compiled functions.

A cell has the mean sides a = (d1 − d2)/2 and b = (d1 + d2)/2, d1 and d2 the diagonals. The derivative of its
forces (`lumped.springs.cells`) is computed in the diagonals first: (4, 9) of (d1, d1), (d1, d2), (d2, d1) and
(d2, d2), each a 3×3 matrix by rows. A corner's part is one of the four matrices, with a sign.
"""

import numpy as np

from lumped.springs.laws import Four, Three, Vector, less, plus, times
from sheetbench.numerics.options import inner

Pair = tuple[Vector, Vector]
Rows = tuple[Pair, Pair, Pair]


@inner()
def by_sides(d: Three, a: Vector, b: Vector) -> Pair:
    """Return the derivatives by the sides a and b of a quantity with the derivative d by their measure g."""
    return plus(times(2.0 * d[0], a), times(d[2], b)), plus(times(2.0 * d[1], b), times(d[2], a))


@inner()
def to_diagonals(stress: Three, a: Vector, b: Vector, rows: Rows, out: np.ndarray) -> None:
    """Set the tangent of a cell in its diagonals, (4, 9) of (d1, d1), (d1, d2), (d2, d1), (d2, d2), from the
    stress and the derivatives of S₁, S₂, S₃ by the sides a = (d1 − d2)/2 and b = (d1 + d2)/2."""
    (s1a, s1b), (s2a, s2b), (s3a, s3b) = rows
    s1, s2, s3 = 0.5 * stress[0], 0.5 * stress[1], 0.25 * stress[2]
    for q in range(3):
        x, y = a[q], b[q]
        x2, y2, x1, y1 = 0.5 * x, 0.5 * y, 0.25 * x, 0.25 * y
        for r in range(3):
            aa, ab = x2 * s1a[r] + y1 * s3a[r], x2 * s1b[r] + y1 * s3b[r]
            ba, bb = y2 * s2a[r] + x1 * s3a[r], y2 * s2b[r] + x1 * s3b[r]
            if q == r:
                aa, bb, ab, ba = aa + s1, bb + s2, ab + s3, ba + s3
            at = 3 * q + r
            out[0, at] = bb + aa + (ab + ba)
            out[1, at] = bb - aa + (ab - ba)
            out[2, at] = bb - aa - (ab - ba)
            out[3, at] = bb + aa - (ab + ba)


@inner(cache=True, forceinline=True)
def by_warp(stress: float, more: Four, a: Vector, b: Vector, q: Vector, out: np.ndarray) -> None:
    """Set the tangent's part of q, (3, 9) of (q, d1), (q, d2) and (q, q), from S₄ and the derivatives of the
    stress by s, 14 24 34 44."""
    by_a, by_b = by_sides((more[0], more[1], more[2]), a, b)
    by_d1, by_d2 = plus(by_a, by_b), less(by_b, by_a)
    for x in range(3):
        for y in range(3):
            out[0, 3 * x + y] = q[x] * by_d1[y]
            out[1, 3 * x + y] = q[x] * by_d2[y]
            out[2, 3 * x + y] = 4.0 * more[3] * q[x] * q[y] + (2.0 * stress if x == y else 0.0)


@inner()
def add_blocks(
    in_diagonals: np.ndarray, of_warp: np.ndarray, warps: bool, p: int, slots: np.ndarray, blocks: np.ndarray
) -> None:
    """Add a tangent in a cell's diagonals, (4, 9), and, if it `warps`, in q, (3, 9), to the blocks on and
    below the diagonal of its corners, each a mean of p masses."""
    flat, share = blocks.reshape(-1, 9), 1.0 / (p * p)
    for corner in range(4):
        side, turn = -share if corner < 2 else share, 1.0 if corner % 2 == 0 else -1.0
        for other in range(4):
            side2, turn2 = -1.0 if other < 2 else 1.0, 1.0 if other % 2 == 0 else -1.0
            part = in_diagonals[2 * (corner % 2) + other % 2]
            for s in range(p):
                for t in range(p):
                    row, column = corner * p + s, other * p + t
                    if slots[row, column] < slots[column, row]:
                        continue
                    block = flat[np.uint64(slots[row, column])]
                    for e in range(9):
                        block[e] += side * side2 * part[e]
                    if warps:
                        for e in range(9):
                            block[e] += (
                                turn * side2 * of_warp[other % 2, e]
                                + side * turn2 * of_warp[corner % 2, 3 * (e % 3) + e // 3]
                                + turn * turn2 * of_warp[2, e]
                            )
