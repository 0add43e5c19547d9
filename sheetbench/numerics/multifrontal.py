"""Factors L S Lᵀ of sparse symmetric matrices, S = ±1 on the diagonal, front by front, as compiled loops.

A front takes its entries of the matrix and what is left of the fronts of its halves, eliminates its own
unknowns and leaves the rest to the front that it is half of (see `fronts`). It is stored by columns of the
lower triangle, a row each; PANEL columns are eliminated together, and others updated two at a time, with
operands that stay in registers; BLAS updates what is beyond a block of a wide front.

Of a positive definite matrix these are Cholesky's factors. S has the inertia of any other (Sylvester); as no
rows are exchanged, its factors may grow beyond the matrix: where L² exceeds GROWTH times the diagonal, which
it cannot where all signs are positive, the factors are refused.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from sheetbench.numerics.fronts import Fronts

PANEL, BLOCK = 6, 48  # columns
WIDE = 160  # from here on a front is eliminated by blocks
NOTHING = 1e-13  # of the diagonal, up to which a pivot counts as rounding
GROWTH = 1e3
REORDERED = {"reassoc", "contract", "nsz"}  # sums in any order, for vector instructions; infinities count


class SignedFactors:
    """The factors of one matrix. negative: how many of its eigenvalues are below zero."""

    def __init__(self, data: np.ndarray, fronts: Fronts):
        """data: of the matrix, whose pattern the fronts are of. Raises NoFactorsError."""
        self._fronts, self._factors = fronts, np.empty(fronts.kept[-1])
        self._signs = np.ones(len(fronts.order))
        if not factor(data, fronts, self._factors, self._signs):
            raise NoFactorsError
        self.negative = int(np.count_nonzero(self._signs < 0.0))

    def solve(self, b: np.ndarray) -> np.ndarray:
        """x (n,) with A x = b."""
        found: np.ndarray = solve(self._factors, self._signs, self._fronts, b)
        return found


class NoFactorsError(ArithmeticError):
    """A pivot vanishes or is not finite, or the factors grow."""


@njit(cache=True, nogil=True, fastmath=REORDERED)
def factor(data: np.ndarray, fronts: Fronts, factors: np.ndarray, signs: np.ndarray) -> bool:
    """The factors of the matrix with this data into `factors` and `signs` (n,); False if there are none."""
    front = np.empty(fronts.widest**2)
    waiting, top = np.empty(fronts.waiting), 0
    where, diagonal = np.empty(len(fronts.order), np.int64), np.abs(data[fronts.diagonal])
    indefinite = False
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
        first = fronts.first[f]
        if not _eliminate(dense, diagonal[first : first + own], signs[first : first + own]):
            return False
        for k in range(own):
            indefinite = indefinite or signs[first + k] < 0.0
        for k in range(own if indefinite else 0):
            for i in range(k, width):
                if not dense[k, i] ** 2 <= GROWTH * diagonal[fronts.rows[start + i]]:
                    return False
        factors[fronts.kept[f] : fronts.kept[f + 1]] = flat
        rest = width - own
        update = waiting[top : top + rest * rest].reshape(rest, rest)
        update[:] = dense[own:, own:]
        top += rest * rest
    return True


@njit(cache=True, nogil=True, inline="always", fastmath=REORDERED)
def _eliminate(dense: np.ndarray, diagonal: np.ndarray, signs: np.ndarray) -> bool:
    """Turn the first columns of a lower triangle, stored in rows, into those of its factor, and the others
    into what is left; False at a pivot that is not finite, or nothing but rounding."""
    width, own = len(dense), len(signs)
    block = BLOCK if width > WIDE else max(own, 1)
    for b0 in range(0, own, block):
        b1 = min(own, b0 + block)
        limit = b1 if width > WIDE else width
        for k0 in range(b0, b1, PANEL):
            start = min(b1, k0 + PANEL)
            for k in range(k0, start):
                column = dense[k]
                pivot = np.abs(column[k])
                if not (pivot > NOTHING * diagonal[k] and pivot > 0.0 and pivot < np.inf):
                    return False
                sign = 1.0 if column[k] > 0.0 else -1.0
                root = np.sqrt(pivot)
                inverse = sign / root
                signs[k] = sign
                column[k] = root
                for i in range(k + 1, width):
                    column[i] *= inverse
                for j in range(k + 1, start if start - k0 == PANEL else limit):
                    share, other = sign * column[j], dense[j]
                    for i in range(j, width):
                        other[i] -= share * column[i]
            if start - k0 == PANEL:
                _update(dense[k0:start], signs[k0:start], dense, start, limit)
        if limit < width:
            left = dense[b0:b1, limit:].T.copy()
            signed = left * signs[b0:b1]
            for j0 in range(0, width - limit, BLOCK):
                j1 = min(width - limit, j0 + BLOCK)
                dense[limit + j0 : limit + j1, limit + j0 :] -= np.dot(signed[j0:j1], left[j0:].T)
    return True


@njit(cache=True, nogil=True, inline="always", fastmath=REORDERED)
def _update(panel: np.ndarray, signs: np.ndarray, dense: np.ndarray, start: int, limit: int) -> None:
    """Take the products of PANEL columns of the factor off the columns start … limit."""
    l0, l1, l2, l3, l4, l5 = panel[0], panel[1], panel[2], panel[3], panel[4], panel[5]
    width = len(l0)
    if signs.min() < 0.0:  # seldom: a column at a time
        for k in range(PANEL):
            for j in range(start, limit):
                share, one = signs[k] * panel[k, j], dense[j]
                for i in range(j, width):
                    one[i] -= share * panel[k, i]
        return
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
def solve(factors: np.ndarray, signs: np.ndarray, fronts: Fronts, b: np.ndarray) -> np.ndarray:
    """x (n,) with A x = b."""
    y = b[fronts.order]
    local = np.empty(fronts.widest)
    for f in range(len(fronts.own)):
        own, first = fronts.own[f], fronts.first[f]
        rows = fronts.rows[fronts.starts[f] : fronts.starts[f + 1]]
        columns = factors[fronts.kept[f] : fronts.kept[f + 1]].reshape(own, len(rows))
        for i in range(own):
            local[i] = y[first + i]
        local[own : len(rows)] = 0.0
        whole = own - own % PANEL
        for k0 in range(0, whole, PANEL):
            _forward(columns[k0 : k0 + PANEL, k0:], local[k0 : len(rows)])
        for k in range(whole, own):
            column = columns[k]
            local[k] /= column[k]
            share = local[k]
            for i in range(k + 1, len(rows)):
                local[i] -= share * column[i]
        for i in range(own):
            y[first + i] = local[i]
        for i in range(own, len(rows)):
            y[rows[i]] += local[i]
    for f in range(len(fronts.own) - 1, -1, -1):
        own, first = fronts.own[f], fronts.first[f]
        rows = fronts.rows[fronts.starts[f] : fronts.starts[f + 1]]
        columns = factors[fronts.kept[f] : fronts.kept[f + 1]].reshape(own, len(rows))
        for i in range(own):
            local[i] = signs[first + i] * y[first + i]
        for i in range(own, len(rows)):
            local[i] = y[rows[i]]
        whole = own - own % PANEL
        for k in range(own - 1, whole - 1, -1):
            column, value = columns[k], local[k]
            for i in range(k + 1, len(rows)):
                value -= column[i] * local[i]
            local[k] = value / column[k]
        for k0 in range(whole - PANEL, -1, -PANEL):
            _backward(columns[k0 : k0 + PANEL, k0:], local[k0 : len(rows)])
        for i in range(own):
            y[first + i] = local[i]
    x = np.empty_like(y)
    for i in range(len(y)):
        x[fronts.order[i]] = y[i]
    return x


@njit(cache=True, nogil=True, inline="always", fastmath=REORDERED)
def _forward(columns: np.ndarray, x: np.ndarray) -> None:
    """Solve with PANEL columns of the factor (PANEL, m), from the first's diagonal on, in place."""
    for k in range(PANEL):
        x[k] /= columns[k, k]
        for j in range(k + 1, PANEL):
            x[j] -= x[k] * columns[k, j]
    l0, l1, l2, l3, l4, l5 = columns[0], columns[1], columns[2], columns[3], columns[4], columns[5]
    f0, f1, f2, f3, f4, f5 = x[0], x[1], x[2], x[3], x[4], x[5]
    for i in range(PANEL, len(x)):
        x[i] -= f0 * l0[i] + f1 * l1[i] + f2 * l2[i] + f3 * l3[i] + f4 * l4[i] + f5 * l5[i]


@njit(cache=True, nogil=True, inline="always", fastmath=REORDERED)
def _backward(columns: np.ndarray, x: np.ndarray) -> None:
    """Solve with the transpose of PANEL columns of the factor, in place."""
    l0, l1, l2, l3, l4, l5 = columns[0], columns[1], columns[2], columns[3], columns[4], columns[5]
    s0 = s1 = s2 = s3 = s4 = s5 = 0.0
    for i in range(PANEL, len(x)):
        value = x[i]
        s0 += l0[i] * value
        s1 += l1[i] * value
        s2 += l2[i] * value
        s3 += l3[i] * value
        s4 += l4[i] * value
        s5 += l5[i] * value
    for k, total in enumerate((s0, s1, s2, s3, s4, s5)):
        x[k] -= total
    for k in range(PANEL - 1, -1, -1):
        for j in range(k + 1, PANEL):
            x[k] -= x[j] * columns[k, j]
        x[k] /= columns[k, k]
