"""Factors L S Lᵀ of sparse symmetric matrices, S = ±1 on the diagonal, front by front, as compiled loops.

A front adds up its entries of the matrix and the updates of its two halves, eliminates its own unknowns and
passes the rest as an update to its parent (see `fronts`). It is stored by columns of the lower triangle, one
in a row; PANEL columns are eliminated together, and others updated two at a time.

For a positive definite matrix the factors are Cholesky's. S has the inertia of any matrix (Sylvester); since
rows are not exchanged, factors of an indefinite matrix may grow: they are refused if L² exceeds GROWTH times
the diagonal, which is impossible with positive signs alone.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import numpy as np

from sheetbench.numerics.aliasing import empty, load, load_each, store, zeros
from sheetbench.numerics.fronts import Fronts
from sheetbench.numerics.options import REORDERED, inner, njit
from sheetbench.numerics.panels import (
    NOTHING,
    PANEL,
    dot,
    eliminate,
    solve_backward,
    solve_forward,
    times,
    triangle,
)

ROUNDING_PIVOT = 1e-13  # of the diagonal, up to which a pivot counts as rounding
GROWTH = 1e3


def signed_factors(data: np.ndarray, fronts: Fronts) -> tuple[Callable[[np.ndarray], np.ndarray], int] | None:
    """Return a solver of A x = b (n,) and the number of negative eigenvalues of A. data: of A, in the fronts'
    pattern. Return None if a pivot vanishes or is not finite, or the factors grow."""
    factors, signs = np.empty(fronts.columns[-1]), np.ones(len(fronts.order))
    if not factor(data, fronts, factors, signs):
        return None
    return partial(solve, factors, signs, fronts), int(np.count_nonzero(signs < 0.0))


@njit(fastmath=REORDERED)
def factor(data: np.ndarray, fronts: Fronts, factors: np.ndarray, signs: np.ndarray) -> bool:
    """Compute a matrix's factors from its data into `factors` and `signs` (n,); False if there are none."""
    front, panel = empty((fronts.widest + 1) * fronts.widest), empty(PANEL * fronts.widest)
    updates, top = empty(fronts.updates), 0
    where, local = empty(len(fronts.order), np.int64), empty(fronts.widest, np.int64)
    diagonal, indefinite = empty(len(fronts.order)), False
    for i in range(len(diagonal)):
        diagonal[i] = abs(data[fronts.diagonal[i]])
    for f in range(len(fronts.pivots)):
        pivots, start, end = fronts.pivots[f], fronts.starts[f], fronts.starts[f + 1]
        width = end - start
        dense = front[: (width + 1) * width].reshape(width + 1, width)
        dense[:] = 0.0
        flat = front[: pivots * width]
        for t in range(fronts.entries[f], fronts.entries[f + 1]):
            flat[fronts.target[t]] = data[fronts.source[t]]
        for i in range(width):
            where[fronts.rows[start + i]] = i
        for h in range(1, -1, -1):  # the second half's update lies on top
            half = fronts.halves[f, h]
            if half >= 0:
                border = fronts.rows[fronts.starts[half] + fronts.pivots[half] : fronts.starts[half + 1]]
                rest = len(border)
                top -= rest * rest
                update = updates[top : top + rest * rest].reshape(rest, rest)
                for i in range(rest):
                    local[i] = where[border[i]]
                for j in range(rest):
                    column = dense[local[j]]
                    for i in range(j, rest):
                        column[local[i]] += update[j, i]
        first = fronts.first[f]
        room = panel[: PANEL * width].reshape(PANEL, width)
        if not _eliminate(dense, diagonal[first : first + pivots], signs[first : first + pivots], room):
            return False
        for k in range(pivots):
            indefinite = indefinite or signs[first + k] < 0.0
        for k in range(pivots if indefinite else 0):
            for i in range(k, width):
                if not dense[k, i] ** 2 <= GROWTH * diagonal[fronts.rows[start + i]]:
                    return False
        columns = fronts.columns[f]
        for i in range(len(flat)):
            factors[columns + i] = flat[i]
        for k in range(pivots):
            factors[columns + k * width + k] = 1.0 / dense[k, k]
        rest = width - pivots
        update = updates[top : top + rest * rest].reshape(rest, rest)
        for j in range(rest):
            column = dense[pivots + j]
            for i in range(j, rest):
                update[j, i] = column[pivots + i]
        top += rest * rest
    return True


@inner(fastmath=REORDERED)
def _eliminate(dense: np.ndarray, diagonal: np.ndarray, signs: np.ndarray, panel: np.ndarray) -> bool:
    """Turn the first columns of a lower triangle into columns of its factor, and the others into the update.
    dense: the columns as rows, with a spare one. panel: workspace (PANEL, width), zero for missing columns.
    Return False at a pivot that is not finite, or rounding."""
    width, pivots = dense.shape[1], len(signs)
    shares, sign, rows = zeros((PANEL, PANEL)), zeros(PANEL), panel.ravel()
    for k0 in range(0, pivots, PANEL):
        start = min(pivots, k0 + PANEL)
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
            signs[k], shares[p, p] = sign[p], sign[p] / column[k]
            for j in range(k + 1, start):
                column[j] *= shares[p, p]
                shares[p, j - k0] = sign[p] * column[j]
                for i in range(k + 1, j + 1):
                    dense[i, j] -= shares[p, i - k0] * column[j]
            for i in range(start, width):
                panel[p, i] = column[i]
        eliminate(triangle(shares.ravel(), 0, PANEL), rows, start, width, width - start)
        for p in range(start - k0):
            column = dense[k0 + p]
            for i in range(start, width):
                column[i] = panel[p, i]
        _update(rows, sign, dense, start)
    return True


@inner(fastmath=REORDERED)
def _update(rows: np.ndarray, sign: np.ndarray, dense: np.ndarray, start: int) -> None:
    """Subtract the products of a panel's rows (PANEL · width,) from the columns from `start` on."""
    width = np.uint64(dense.shape[1])
    signs = load_each(0, sign, 0, 1, PANEL)
    for j in range(start, dense.shape[1], 2):
        f, g = times(signs, load_each(0, rows, j, width, PANEL)), NOTHING
        if j + 1 < dense.shape[1]:
            g = times(signs, load_each(0, rows, j + 1, width, PANEL))
        one, two = dense[j], dense[j + 1]  # entries above the second's diagonal are never read
        for i in range(j, dense.shape[1]):
            m = load_each(0, rows, i, width, PANEL)
            store(1, one, i, load(1, one, i) - dot(f, m))
            store(2, two, i, load(2, two, i) - dot(g, m))


@njit(fastmath=REORDERED)
def solve(factors: np.ndarray, signs: np.ndarray, fronts: Fronts, b: np.ndarray) -> np.ndarray:
    """Solve A x = b for x (n,)."""
    y = b[fronts.order]
    local = empty(fronts.widest)
    for f in range(len(fronts.pivots)):
        pivots, first = fronts.pivots[f], fronts.first[f]
        rows = fronts.rows[fronts.starts[f] : fronts.starts[f + 1]]
        at, width = fronts.columns[f], len(rows)
        for i in range(pivots):
            local[i] = y[first + i]
        local[pivots : len(rows)] = 0.0
        whole = pivots - pivots % PANEL
        for k0 in range(0, whole, PANEL):
            solve_forward(factors, at + k0 * width + k0, width, local, k0, width - k0 - PANEL)
        for k in range(whole, pivots):
            column = factors[at + k * width : at + (k + 1) * width]
            local[k] *= column[k]
            share = local[k]
            for i in range(k + 1, len(rows)):
                local[i] -= share * column[i]
        for i in range(pivots):
            y[first + i] = local[i]
        for i in range(pivots, len(rows)):
            y[rows[i]] += local[i]
    for f in range(len(fronts.pivots) - 1, -1, -1):
        pivots, first = fronts.pivots[f], fronts.first[f]
        rows = fronts.rows[fronts.starts[f] : fronts.starts[f + 1]]
        at, width = fronts.columns[f], len(rows)
        for i in range(pivots):
            local[i] = signs[first + i] * y[first + i]
        for i in range(pivots, len(rows)):
            local[i] = y[rows[i]]
        whole = pivots - pivots % PANEL
        for k in range(pivots - 1, whole - 1, -1):
            column, value = factors[at + k * width : at + (k + 1) * width], local[k]
            for i in range(k + 1, len(rows)):
                value -= column[i] * local[i]
            local[k] = value * column[k]
        for k0 in range(whole - PANEL, -1, -PANEL):
            solve_backward(factors, at + k0 * width + k0, width, local, k0, width - k0 - PANEL)
        for i in range(pivots):
            y[first + i] = local[i]
    x = empty(y.shape)
    for i in range(len(y)):
        x[fronts.order[i]] = y[i]
    return x
