"""The fronts of a sparse symmetric matrix whose unknowns lie in a plane, by nested dissection.

The cells are cut in two, along x or y where the sides share the fewest unknowns, again and again, and an
unknown is eliminated in the smallest part that contains all its cells. A part's front is the dense matrix of
its own unknowns and of the unknowns on its border (see `multifrontal`).
Source: George, SIAM J. Numer. Anal. 10 (1973) 345; Duff & Reid, ACM Trans. Math. Softw. 9 (1983) 302.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy.sparse import csr_array

from sheetbench.numerics.aliasing import empty, zeros
from sheetbench.numerics.options import njit

LEAF = 128  # unknowns of a part's cells up to which a part of more than two cells is not halved


class CoupledCells(NamedTuple):
    """Cells whose unknowns a matrix couples: unknowns (m, k), −1 for none, and places (m, 2) in the plane."""

    unknowns: np.ndarray
    places: np.ndarray


class Fronts(NamedTuple):
    """Layout of F fronts, each after its two halves.

    order: (n,) the unknown at each place. pivots, first: (F,) number of places that a front eliminates, and
    the first of them. rows: places of all fronts' unknowns, pivots first, from `starts` (F + 1,) on. halves:
    (F, 2), −1 for none. target, source: for every entry of the lower triangle its place in its front, and in
    the matrix's data, by front from `entries` (F + 1,) on. diagonal: (n,) the diagonal's places in the data.
    columns: (F + 1,) starts of the fronts' columns in the factors. widest: width of the largest front.
    updates: largest total size of the fronts' updates.
    """

    order: np.ndarray
    pivots: np.ndarray
    first: np.ndarray
    rows: np.ndarray
    starts: np.ndarray
    halves: np.ndarray
    target: np.ndarray
    source: np.ndarray
    entries: np.ndarray
    diagonal: np.ndarray
    columns: np.ndarray
    widest: int
    updates: int


def fronts_of(columns: np.ndarray, starts: np.ndarray, cells: CoupledCells) -> Fronts:
    """Return the fronts of a symmetric matrix by compressed rows, both triangles and the whole diagonal.
    Raises ValueError if an entry of the diagonal is missing."""
    size, leaf = len(starts) - 1, max(2, LEAF // cells.unknowns.shape[1])
    line, parts, halves = _dissect(cells, size, leaf)
    at, column = np.nonzero(cells.unknowns[line] >= 0)
    unknown = cells.unknowns[line[at], column]
    low, high = np.zeros(size, np.int64), np.zeros(size, np.int64)
    low[unknown[::-1]], high[unknown] = at[::-1], at  # of several the last one counts
    owner = np.full(size, len(parts) - 1)
    while True:
        one, two = halves[owner].T
        below = np.where(parts[one, 1] > high, one, np.where(parts[two, 0] <= low, two, -1))
        if np.all(below < 0):
            break
        owner = np.where(below < 0, owner, below)
    order = np.argsort(owner, kind="stable")
    place = np.argsort(order)
    pivots = np.bincount(owner, minlength=len(parts))
    first = np.cumsum(pivots) - pivots

    above = np.full(len(parts), -1)
    above[halves[halves >= 0]] = np.nonzero(halves >= 0)[0]
    leaves = np.flatnonzero(halves[:, 0] < 0)
    of_cells = np.repeat(leaves, np.diff(parts[leaves])[:, 0])[at]
    shape = (size, len(parts))
    step = csr_array((np.ones(len(at), bool), (place[unknown], of_cells)), shape=shape)
    having = step  # the parts that have an unknown: from its cells' to the part that eliminates it
    while step.nnz:
        unknown, part = step.nonzero()
        on = part != owner[order[unknown]]
        step = csr_array((np.ones(on.sum(), bool), (unknown[on], above[part[on]])), shape=shape)
        having = having + step
    by_part = having.tocsc()
    rows, begin = by_part.indices.astype(np.int64), by_part.indptr.astype(np.int64)
    width = np.diff(begin)
    update = np.append((width - pivots) ** 2, 0)
    updates = np.cumsum(update[:-1] - update[halves].sum(axis=1))
    factor_columns = np.append(0, np.cumsum(pivots * width))
    target, source, entries, diagonal = _targets(columns, starts, order, place, pivots, first, rows, begin)
    if np.any(diagonal < 0):
        raise ValueError("the pattern lacks a part of its diagonal")
    return Fronts(
        *(order, pivots, first, rows, begin, halves, target, source, entries, diagonal, factor_columns),
        int(width.max()), int(updates.max()),
    )  # fmt: skip


def _dissect(cells: CoupledCells, size: int, leaf: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return a line of cells (m,), parts (F, 2) as ranges of the line, and the parts' halves (F, 2). A part
    follows its halves, −1 for none. leaf: number of cells in a part that is not halved."""
    orders = np.argsort(cells.places, axis=0, kind="stable").T.copy()
    parts, halves = _halve(cells.unknowns, orders, size, leaf)
    walk = np.lexsort((-parts[:, 0], parts[:, 1]))
    number = np.append(np.argsort(walk), -1)
    return orders[0], parts[walk], number[halves[walk]]


@njit
def _halve(cells: np.ndarray, orders: np.ndarray, size: int, leaf: int) -> tuple[np.ndarray, np.ndarray]:
    """Return parts (F, 2) and their halves (F, 2) of cells (m, k); sort `orders` (2, m) by parts.

    orders: the cells along x and along y. A part is cut along an order at the least value of the number of
    shared unknowns plus one over the square of the product of the sides' numbers of cells. size: the number
    of unknowns.
    """
    m, k, count = len(cells), cells.shape[1], 1
    parts, halves = zeros((2 * m, 2), np.int64), empty((2 * m, 2), np.int64)
    first, last, seen = zeros(size, np.int64), zeros(size, np.int64), empty(size, np.int64)
    second, aside = zeros(m, np.int64), zeros(m, np.int64)
    parts[0, 1], halves[:], seen[:] = m, -1, -1
    for f in range(2 * m):
        start, end = parts[f, 0], parts[f, 1]
        if end - start <= leaf:  # also beyond the last part, where both are 0
            continue
        least, along, cut = np.inf, 0, 0
        for axis in range(2):
            for i in range(start, end):
                for j in range(k):
                    u = cells[orders[axis, i], j]
                    if u >= 0:
                        if seen[u] != 2 * f + axis:
                            seen[u], first[u] = 2 * f + axis, i
                        last[u] = i
            shared = 0
            for i in range(start, end - 1):
                for j in range(k):
                    u = cells[orders[axis, i], j]
                    if u >= 0:
                        shared += int(first[u] == i) - int(last[u] == i)
                cost = (shared + 1.0) / ((i + 1.0 - start) * (end - 1.0 - i)) ** 2
                if cost < least:
                    least, along, cut = cost, axis, i + 1
        for i in range(start, end):
            second[orders[along, i]] = i >= cut
        for axis in range(2):
            moved = 0
            for i in range(start, end):
                cell = orders[axis, i]
                if second[cell]:
                    aside[moved] = cell
                    moved += 1
                else:
                    orders[axis, i - moved] = cell
            for i in range(moved):
                orders[axis, cut + i] = aside[i]
        halves[f, 0], halves[f, 1] = count, count + 1
        parts[count, 0], parts[count, 1] = start, cut
        parts[count + 1, 0], parts[count + 1, 1] = cut, end
        count += 2
    return parts[:count], halves[:count]


@njit
def _targets(
    columns: np.ndarray,
    starts: np.ndarray,
    order: np.ndarray,
    place: np.ndarray,
    pivots: np.ndarray,
    first: np.ndarray,
    rows: np.ndarray,
    begin: np.ndarray,
) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Return target, source, entries and diagonal of `Fronts`, −1 for a missing diagonal entry."""
    lower = (len(columns) + len(order)) // 2
    target, source = empty(lower, np.int32), empty(lower, np.int32)
    entries, diagonal = zeros(len(pivots) + 1, np.int64), empty(len(order), np.int64)
    local, filled = empty(len(order), np.int64), 0
    diagonal[:] = -1
    for f in range(len(pivots)):
        width = begin[f + 1] - begin[f]
        for i in range(width):
            local[rows[begin[f] + i]] = i
        for i in range(pivots[f]):
            u = order[first[f] + i]
            for at in range(starts[u], starts[u + 1]):
                if columns[at] == u:
                    diagonal[first[f] + i] = at
                if place[columns[at]] >= first[f] + i:
                    target[filled] = i * width + local[place[columns[at]]]
                    source[filled] = at
                    filled += 1
        entries[f + 1] = filled
    return target, source, entries, diagonal
