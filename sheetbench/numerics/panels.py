"""PANEL columns of a Cholesky factor at once, as compiled loops whose operands stay in registers.

Entry r of column p, counted from the first column's diagonal, lies at place + r + p · stride of a flat array.
The diagonal is inverted.
"""

from typing import Any

import numpy as np

from sheetbench.numerics.aliasing import load, load_each, store, store_each
from sheetbench.numerics.options import REORDERED, inner

PANEL = 6  # the unknowns of a column of masses in two layers
NOTHING = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0)


@inner(fastmath=REORDERED)
def dot(a: Any, b: Any) -> float:
    """Return a · b."""
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3] + a[4] * b[4] + a[5] * b[5]


@inner(fastmath=REORDERED)
def plus(a: Any, share: float, b: Any) -> Any:
    """Return a + share b."""
    first = a[0] + share * b[0], a[1] + share * b[1], a[2] + share * b[2]
    return (*first, a[3] + share * b[3], a[4] + share * b[4], a[5] + share * b[5])


@inner(fastmath=REORDERED)
def times(a: Any, b: Any) -> Any:
    """Return the products of the parts."""
    return a[0] * b[0], a[1] * b[1], a[2] * b[2], a[3] * b[3], a[4] * b[4], a[5] * b[5]


@inner()
def triangle(flat: np.ndarray, place: Any, stride: Any) -> Any:
    """Return the panel's own rows: the diagonal, and the columns below it."""
    next_ = stride + np.uint64(1)
    p = np.uint64(place) + np.uint64(1)
    return (
        load_each(0, flat, place, next_, PANEL),
        load_each(0, flat, p, 1, 5),
        load_each(0, flat, p + next_, 1, 4),
        load_each(0, flat, p + np.uint64(2) * next_, 1, 3),
        load_each(0, flat, p + np.uint64(3) * next_, 1, 2),
        load(0, flat, p + np.uint64(4) * next_),
    )


@inner(fastmath=REORDERED)
def forward(corner: Any, b: Any) -> Any:
    """Return L⁻¹ b of a triangle."""
    d, (c01, c02, c03, c04, c05), (c12, c13, c14, c15), (c23, c24, c25), (c34, c35), c45 = corner
    x0 = b[0] * d[0]
    x1 = (b[1] - c01 * x0) * d[1]
    x2 = (b[2] - c02 * x0 - c12 * x1) * d[2]
    x3 = (b[3] - c03 * x0 - c13 * x1 - c23 * x2) * d[3]
    x4 = (b[4] - c04 * x0 - c14 * x1 - c24 * x2 - c34 * x3) * d[4]
    x5 = (b[5] - c05 * x0 - c15 * x1 - c25 * x2 - c35 * x3 - c45 * x4) * d[5]
    return x0, x1, x2, x3, x4, x5


@inner(fastmath=REORDERED)
def backward(corner: Any, b: Any) -> Any:
    """Return L⁻ᵀ b of a triangle."""
    d, (c01, c02, c03, c04, c05), (c12, c13, c14, c15), (c23, c24, c25), (c34, c35), c45 = corner
    x5 = b[5] * d[5]
    x4 = (b[4] - c45 * x5) * d[4]
    x3 = (b[3] - c34 * x4 - c35 * x5) * d[3]
    x2 = (b[2] - c23 * x3 - c24 * x4 - c25 * x5) * d[2]
    x1 = (b[1] - c12 * x2 - c13 * x3 - c14 * x4 - c15 * x5) * d[1]
    x0 = (b[0] - c01 * x1 - c02 * x2 - c03 * x3 - c04 * x4 - c05 * x5) * d[0]
    return x0, x1, x2, x3, x4, x5


@inner(fastmath=REORDERED)
def eliminate(corner: Any, flat: np.ndarray, place: Any, stride: Any, count: Any) -> None:
    """Turn `count` rows of the panel, from `place` on, into rows of the factor, in place."""
    p0, stride = np.uint64(place), np.uint64(stride)
    p1, p2, p3 = p0 + stride, p0 + np.uint64(2) * stride, p0 + np.uint64(3) * stride
    p4, p5 = p3 + stride, p3 + np.uint64(2) * stride
    for i in range(np.uint64(count)):
        b0, b1, b2 = load(0, flat, p0 + i), load(1, flat, p1 + i), load(2, flat, p2 + i)
        b3, b4, b5 = load(3, flat, p3 + i), load(4, flat, p4 + i), load(5, flat, p5 + i)
        x0, x1, x2, x3, x4, x5 = forward(corner, (b0, b1, b2, b3, b4, b5))
        store(0, flat, p0 + i, x0)
        store(1, flat, p1 + i, x1)
        store(2, flat, p2 + i, x2)
        store(3, flat, p3 + i, x3)
        store(4, flat, p4 + i, x4)
        store(5, flat, p5 + i, x5)


@inner(fastmath=REORDERED)
def solve_forward(flat: np.ndarray, place: Any, stride: Any, x: np.ndarray, at: Any, count: Any) -> None:
    """Solve with the panel for x from `at` on, and subtract it from the next `count` entries, in place."""
    place, stride, behind = np.uint64(place), np.uint64(stride), np.uint64(PANEL)
    f = forward(triangle(flat, place, stride), load_each(1, x, at, 1, PANEL))
    store_each(1, x, at, 1, f)
    rest = x[at + PANEL :]
    for i in range(np.uint64(count)):
        taken = dot(f, load_each(0, flat, place + behind + i, stride, PANEL))
        store(1, rest, i, load(1, rest, i) - taken)


@inner(fastmath=REORDERED)
def solve_backward(flat: np.ndarray, place: Any, stride: Any, x: np.ndarray, at: Any, count: Any) -> None:
    """Solve with the panel's transpose for x from `at` on, given the next `count` entries, in place."""
    place, stride, behind, s = np.uint64(place), np.uint64(stride), np.uint64(PANEL), NOTHING
    rest = x[at + PANEL :]
    for i in range(np.uint64(count)):
        s = plus(s, load(1, rest, i), load_each(0, flat, place + behind + i, stride, PANEL))
    b = plus(load_each(1, x, at, 1, PANEL), -1.0, s)
    store_each(1, x, at, 1, backward(triangle(flat, place, stride), b))
