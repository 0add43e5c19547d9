"""Cholesky factors of sparse symmetric positive definite matrices, front by front, as compiled loops.

A front takes its entries of the matrix and what is left of the fronts of its halves, eliminates its own
unknowns and leaves the rest to the front that it is half of (see `fronts`). It is stored by columns of the
lower triangle, a row each; PANEL columns are eliminated together, and others updated two at a time, with
operands that stay in registers; BLAS updates what is beyond a block of a wide front.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from fem_reference.solving.fronts import Fronts

PANEL, BLOCK = 6, 48  # columns
WIDE = 160  # from here on a front is eliminated by blocks
NOTHING = 1e-13  # of the diagonal, up to which a pivot counts as rounding
REORDERED = {"reassoc", "contract", "nsz"}  # sums in any order, for vector instructions; infinities count


class Cholesky:
    """The factors of one matrix."""

    def __init__(self, data: np.ndarray, fronts: Fronts):
        """data: of the matrix, whose pattern the fronts are of. Raises NotPositiveDefinite."""
        self._fronts, self._factors = fronts, np.empty(fronts.kept[-1])
        if not factor(data, fronts, self._factors):
            raise NotPositiveDefinite

    def solve(self, b: np.ndarray) -> np.ndarray:
        """x (n,) with A x = b."""
        found: np.ndarray = solve(self._factors, self._fronts, b)
        return found


class NotPositiveDefinite(ArithmeticError):
    """A pivot is not positive."""


@njit(cache=True, nogil=True, fastmath=REORDERED)
def factor(data: np.ndarray, fronts: Fronts, factors: np.ndarray) -> bool:
    """The factors of the matrix with this data into `factors`; False where it is not positive definite."""
    front = np.empty(fronts.widest**2)
    waiting, top = np.empty(fronts.waiting), 0
    where, least = np.empty(len(fronts.order), np.int64), np.empty(fronts.widest)
    for f in range(len(fronts.own)):
        own, start, end = fronts.own[f], fronts.starts[f], fronts.starts[f + 1]
        width = end - start
        dense = front[: width * width].reshape(width, width)
        dense[:] = 0.0
        flat = front[: own * width]
        for t in range(fronts.entries[f], fronts.entries[f + 1]):
            flat[fronts.target[t]] = data[fronts.source[t]]
        for i in range(width):
            where[fronts.rows[start + i]] = i
        for k in range(own):
            least[k] = NOTHING * dense[k, k]
        for h in range(1, -1, -1):  # what the second half has left lies on top
            half = fronts.halves[f, h]
            if half >= 0:
                left = fronts.rows[fronts.starts[half] + fronts.own[half] : fronts.starts[half + 1]]
                rest = len(left)
                top -= rest * rest
                update = waiting[top : top + rest * rest].reshape(rest, rest)
                for j in range(rest):
                    column = dense[where[left[j]]]
                    for i in range(j, rest):
                        column[where[left[i]]] += update[j, i]
        if not _eliminate(dense, own, least):
            return False
        factors[fronts.kept[f] : fronts.kept[f + 1]] = flat
        rest = width - own
        update = waiting[top : top + rest * rest].reshape(rest, rest)
        update[:] = dense[own:, own:]
        top += rest * rest
    return True


@njit(cache=True, nogil=True, inline="always", fastmath=REORDERED)
def _eliminate(dense: np.ndarray, own: int, least: np.ndarray) -> bool:
    """Turn the first columns of a lower triangle, stored in rows, into those of its factor, and the others
    into what is left; False at a pivot that is not positive, or nothing but rounding."""
    width = len(dense)
    block = BLOCK if width > WIDE else max(own, 1)
    for b0 in range(0, own, block):
        b1 = min(own, b0 + block)
        limit = b1 if width > WIDE else width
        for k0 in range(b0, b1, PANEL):
            start = min(b1, k0 + PANEL)
            for k in range(k0, start):
                column = dense[k]
                pivot = column[k]
                if not (pivot > least[k] and pivot > 0.0 and pivot < np.inf):
                    return False
                root = np.sqrt(pivot)
                inverse = 1.0 / root
                column[k] = root
                for i in range(k + 1, width):
                    column[i] *= inverse
                for j in range(k + 1, start if start - k0 == PANEL else limit):
                    share, other = column[j], dense[j]
                    for i in range(j, width):
                        other[i] -= share * column[i]
            if start - k0 == PANEL:
                _update(dense[k0:start], dense, start, limit)
        if limit < width:
            left = dense[b0:b1, limit:].T.copy()
            for j0 in range(0, width - limit, BLOCK):
                j1 = min(width - limit, j0 + BLOCK)
                dense[limit + j0 : limit + j1, limit + j0 :] -= np.dot(left[j0:j1], left[j0:].T)
    return True


@njit(cache=True, nogil=True, inline="always", fastmath=REORDERED)
def _update(panel: np.ndarray, dense: np.ndarray, start: int, limit: int) -> None:
    """Take the products of PANEL columns of the factor off the columns start … limit."""
    l0, l1, l2, l3, l4, l5 = panel[0], panel[1], panel[2], panel[3], panel[4], panel[5]
    width = len(l0)
    for j in range(start, limit - 1, 2):
        f0, f1, f2, f3, f4, f5 = l0[j], l1[j], l2[j], l3[j], l4[j], l5[j]
        g0, g1, g2, g3, g4, g5 = l0[j + 1], l1[j + 1], l2[j + 1], l3[j + 1], l4[j + 1], l5[j + 1]
        one, two = dense[j], dense[j + 1]  # what is above the second's diagonal is never looked at
        for i in range(j, width):
            m0, m1, m2, m3, m4, m5 = l0[i], l1[i], l2[i], l3[i], l4[i], l5[i]
            one[i] -= f0 * m0 + f1 * m1 + f2 * m2 + f3 * m3 + f4 * m4 + f5 * m5
            two[i] -= g0 * m0 + g1 * m1 + g2 * m2 + g3 * m3 + g4 * m4 + g5 * m5
    if (limit - start) % 2:
        j = limit - 1
        one = dense[j]
        for i in range(j, width):
            one[i] -= (l0[j] * l0[i] + l1[j] * l1[i] + l2[j] * l2[i]) + (
                l3[j] * l3[i] + l4[j] * l4[i] + l5[j] * l5[i]
            )


@njit(cache=True, nogil=True, fastmath=REORDERED)
def solve(factors: np.ndarray, fronts: Fronts, b: np.ndarray) -> np.ndarray:
    """x (n,) with A x = b."""
    y = b[fronts.order]
    local = np.empty(fronts.widest)
    for f in range(len(fronts.own)):
        own, rows = fronts.own[f], fronts.rows[fronts.starts[f] : fronts.starts[f + 1]]
        columns = factors[fronts.kept[f] : fronts.kept[f + 1]].reshape(own, len(rows))
        local[: len(rows)] = 0.0
        for k in range(own):
            column = columns[k]
            share = (y[rows[k]] + local[k]) / column[k]
            y[rows[k]] = share
            for i in range(k + 1, len(rows)):
                local[i] -= share * column[i]
        for i in range(own, len(rows)):
            y[rows[i]] += local[i]
    for f in range(len(fronts.own) - 1, -1, -1):
        own, rows = fronts.own[f], fronts.rows[fronts.starts[f] : fronts.starts[f + 1]]
        columns = factors[fronts.kept[f] : fronts.kept[f + 1]].reshape(own, len(rows))
        for i in range(own, len(rows)):
            local[i] = y[rows[i]]
        for k in range(own - 1, -1, -1):
            column, value = columns[k], y[rows[k]]
            for i in range(k + 1, len(rows)):
                value -= column[i] * local[i]
            local[k] = value / column[k]
            y[rows[k]] = local[k]
    x = np.empty_like(y)
    for i in range(len(y)):
        x[fronts.order[i]] = y[i]
    return x
