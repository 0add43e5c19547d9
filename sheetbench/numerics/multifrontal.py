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

from sheetbench.numerics.fronts import Fronts
from sheetbench.numerics.typed import inner, njit

PANEL, BLOCK = 6, 48  # columns
WIDE = 160  # from here on a front is eliminated by blocks
ROUNDING_PIVOT = 1e-13  # of the diagonal, up to which a pivot counts as rounding
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
    front, panel = np.empty((fronts.widest + 1) * fronts.widest), np.empty(PANEL * fronts.widest)
    waiting, top = np.empty(fronts.waiting), 0
    where, local = np.empty(len(fronts.order), np.int64), np.empty(fronts.widest, np.int64)
    diagonal, indefinite = np.empty(len(fronts.order)), False
    for i in range(len(diagonal)):
        diagonal[i] = abs(data[fronts.diagonal[i]])
    for f in range(len(fronts.own)):
        own, start, end = fronts.own[f], fronts.starts[f], fronts.starts[f + 1]
        width = end - start
        dense = front[: (width + 1) * width].reshape(width + 1, width)
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
                for i in range(rest):
                    local[i] = where[left[i]]
                for j in range(rest):
                    column = dense[local[j]]
                    for i in range(j, rest):
                        column[local[i]] += update[j, i]
        first = fronts.first[f]
        room = panel[: PANEL * width].reshape(PANEL, width)
        if not _eliminate(dense, diagonal[first : first + own], signs[first : first + own], room):
            return False
        for k in range(own):
            indefinite = indefinite or signs[first + k] < 0.0
        for k in range(own if indefinite else 0):
            for i in range(k, width):
                if not dense[k, i] ** 2 <= GROWTH * diagonal[fronts.rows[start + i]]:
                    return False
        kept = fronts.kept[f]
        for i in range(len(flat)):
            factors[kept + i] = flat[i]
        rest = width - own
        update = waiting[top : top + rest * rest].reshape(rest, rest)
        for j in range(rest):
            column = dense[own + j]
            for i in range(j, rest):
                update[j, i] = column[own + i]
        top += rest * rest
    return True


@inner(fastmath=REORDERED)
def _eliminate(dense: np.ndarray, diagonal: np.ndarray, signs: np.ndarray, panel: np.ndarray) -> bool:
    """Turn the first columns of a lower triangle, stored in rows with one to spare, into those of its factor,
    and the others into what is left; False at a pivot that is not finite, or nothing but rounding. panel:
    room (PANEL, width), where columns that are missing are zero."""
    width, own = dense.shape[1], len(signs)
    block = BLOCK if width > WIDE else max(own, 1)
    shares, inverse, sign = np.zeros((PANEL, PANEL)), np.zeros(PANEL), np.zeros(PANEL)
    for b0 in range(0, own, block):
        b1 = min(own, b0 + block)
        limit = b1 if width > WIDE else width
        for k0 in range(b0, b1, PANEL):
            start = min(b1, k0 + PANEL)
            if start < k0 + PANEL:
                panel[:] = 0.0
                shares[:] = 0.0
                sign[:] = 0.0
            for k in range(k0, start):
                column, p = dense[k], k - k0
                pivot = np.abs(column[k])
                if not (pivot > ROUNDING_PIVOT * diagonal[k] and pivot > 0.0 and pivot < np.inf):
                    return False
                sign[p] = 1.0 if column[k] > 0.0 else -1.0
                column[k] = np.sqrt(pivot)
                signs[k], inverse[p] = sign[p], sign[p] / column[k]
                for j in range(k + 1, start):
                    column[j] *= inverse[p]
                    shares[p, j - k0] = sign[p] * column[j]
                    for i in range(k + 1, j + 1):
                        dense[i, j] -= shares[p, i - k0] * column[j]
                for i in range(start, width):
                    panel[p, i] = column[i]
            _below(panel[:, start:], shares, inverse)
            for p in range(start - k0):
                column = dense[k0 + p]
                for i in range(start, width):
                    column[i] = panel[p, i]
            _update(panel, sign, dense, start, limit)
        if limit < width:
            left, signed = np.empty((width - limit, b1 - b0)), np.empty((width - limit, b1 - b0))
            for k in range(b0, b1):
                for i in range(limit, width):
                    left[i - limit, k - b0], signed[i - limit, k - b0] = dense[k, i], signs[k] * dense[k, i]
            for j0 in range(0, width - limit, BLOCK):
                products = np.dot(signed[j0 : j0 + BLOCK], left[j0:].T)
                for j in range(len(products)):
                    column = dense[limit + j0 + j, limit + j0 :]
                    for i in range(j, len(column)):
                        column[i] -= products[j, i]
    return True


@inner(fastmath=REORDERED)
def _below(panel: np.ndarray, shares: np.ndarray, inverse: np.ndarray) -> None:
    """Columns of the factor below their own square, all of a panel at once."""
    l0, l1, l2, l3, l4, l5 = panel[0], panel[1], panel[2], panel[3], panel[4], panel[5]
    d0, d1, d2, d3, d4, d5 = inverse[0], inverse[1], inverse[2], inverse[3], inverse[4], inverse[5]
    s01, s02, s03, s04, s05 = shares[0, 1], shares[0, 2], shares[0, 3], shares[0, 4], shares[0, 5]
    s12, s13, s14, s15 = shares[1, 2], shares[1, 3], shares[1, 4], shares[1, 5]
    s23, s24, s25, s34, s35 = shares[2, 3], shares[2, 4], shares[2, 5], shares[3, 4], shares[3, 5]
    s45 = shares[4, 5]
    for i in range(len(l0)):
        m0 = l0[i] * d0
        m1 = (l1[i] - s01 * m0) * d1
        m2 = (l2[i] - (s02 * m0 + s12 * m1)) * d2
        m3 = (l3[i] - (s03 * m0 + s13 * m1 + s23 * m2)) * d3
        m4 = (l4[i] - (s04 * m0 + s14 * m1 + s24 * m2 + s34 * m3)) * d4
        m5 = (l5[i] - (s05 * m0 + s15 * m1 + s25 * m2 + s35 * m3 + s45 * m4)) * d5
        l0[i], l1[i], l2[i], l3[i], l4[i], l5[i] = m0, m1, m2, m3, m4, m5


@inner(fastmath=REORDERED)
def _update(panel: np.ndarray, sign: np.ndarray, dense: np.ndarray, start: int, limit: int) -> None:
    """Take the products of a panel off the columns start … limit."""
    l0, l1, l2, l3, l4, l5 = panel[0], panel[1], panel[2], panel[3], panel[4], panel[5]
    s0, s1, s2, s3, s4, s5 = sign[0], sign[1], sign[2], sign[3], sign[4], sign[5]
    for j in range(start, limit, 2):
        f0, f1, f2, f3, f4, f5 = s0 * l0[j], s1 * l1[j], s2 * l2[j], s3 * l3[j], s4 * l4[j], s5 * l5[j]
        g0 = g1 = g2 = g3 = g4 = g5 = 0.0
        k = j + 1
        if k < limit:
            g0, g1, g2, g3, g4, g5 = s0 * l0[k], s1 * l1[k], s2 * l2[k], s3 * l3[k], s4 * l4[k], s5 * l5[k]
        one, two = dense[j], dense[k]  # what is above the second's diagonal is never looked at
        for i in range(j, len(l0)):
            m0, m1, m2, m3, m4, m5 = l0[i], l1[i], l2[i], l3[i], l4[i], l5[i]
            one[i] -= f0 * m0 + f1 * m1 + f2 * m2 + f3 * m3 + f4 * m4 + f5 * m5
            two[i] -= g0 * m0 + g1 * m1 + g2 * m2 + g3 * m3 + g4 * m4 + g5 * m5


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


@inner(fastmath=REORDERED)
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


@inner(fastmath=REORDERED)
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
