"""The fronts of a sparse symmetric matrix whose unknowns lie in a plane, by nested dissection.

The cells that share unknowns are halved across their longer extent, again and again, and an unknown is
eliminated in the smallest part that holds all its cells. A part's front is the dense matrix of its own
unknowns and of those on its border (see `multifrontal`).
Source: George, SIAM J. Numer. Anal. 10 (1973) 345; Duff & Reid, ACM Trans. Math. Softw. 9 (1983) 302.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit

LEAF = 128  # unknowns of its cells, together, up to which a part of more than two is not halved


class Cells(NamedTuple):
    """What a matrix couples, and where: unknowns (m, k) of every cell, −1 for none; its place (m, 2)."""

    unknowns: np.ndarray
    places: np.ndarray


class Fronts(NamedTuple):
    """Where everything goes, of F fronts, halves before what they are halves of.

    order: (n,) the unknown at each place; own, first: (F,) how many places a front eliminates, from where on;
    rows: places of all fronts' unknowns, own ones first, from `starts` (F + 1,) on; halves: (F, 2), −1 where
    there is none; target, source: of every entry of the lower triangle, where in its front it goes and where
    in the matrix's data it is, by front from `entries` (F + 1,) on; diagonal: (n,) where in the data the
    diagonal is, by places; kept: where the factors' columns start
    (F + 1,); widest: the largest front; waiting: room for what fronts leave.
    """

    order: np.ndarray
    own: np.ndarray
    first: np.ndarray
    rows: np.ndarray
    starts: np.ndarray
    halves: np.ndarray
    target: np.ndarray
    source: np.ndarray
    entries: np.ndarray
    diagonal: np.ndarray
    kept: np.ndarray
    widest: int
    waiting: int


def fronts_of(columns: np.ndarray, starts: np.ndarray, cells: Cells) -> Fronts:
    """The fronts of a symmetric matrix by compressed rows, both triangles and the whole diagonal. Raises
    ValueError where an entry of the diagonal is missing."""
    leaf = max(2, LEAF // cells.unknowns.shape[1])
    return _fronts(columns, starts, cells.unknowns, *_dissected(np.ascontiguousarray(cells.places), leaf))


@njit(cache=True)
def _dissected(places: np.ndarray, leaf: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Cells in line (m,), parts (F, 2) as ranges of the line, and every part's halves (F, 2), −1 for none;
    halves before what they are halves of. leaf: cells in a part that is not halved."""
    line = np.arange(len(places))
    parts = np.empty((2 * len(places) + 1, 2), np.int64)
    halves = np.full((2 * len(places) + 1, 2), -1)
    parts[0, 0], parts[0, 1] = 0, len(places)
    count, at = 1, 0
    while at < count:  # breadth first, to be turned over
        start, end = parts[at]
        if end - start > leaf:
            here = places[line[start:end]]
            spread_x = here[:, 0].max() - here[:, 0].min()
            spread_y = here[:, 1].max() - here[:, 1].min()
            axis = 0 if spread_x >= spread_y else 1
            line[start:end] = line[start:end][np.argsort(here[:, axis], kind="mergesort")]
            middle = (start + end) // 2
            halves[at, 0], halves[at, 1] = count, count + 1
            parts[count, 0], parts[count, 1] = start, middle
            parts[count + 1, 0], parts[count + 1, 1] = middle, end
            count += 2
        at += 1
    return _after_halves(line, parts[:count], halves[:count])


@njit(cache=True, inline="always")
def _after_halves(
    line: np.ndarray, parts: np.ndarray, halves: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Parts in the order of a walk that ends at each part after its halves."""
    count = len(parts)
    walk, stack, number = np.empty(count, np.int64), np.empty(count + 1, np.int64), np.empty(count, np.int64)
    stack[0], top, filled = 0, 1, count
    while top > 0:  # a part, its second half, its first, and that turned over
        top -= 1
        part = stack[top]
        filled -= 1
        walk[filled], number[part] = part, filled
        for h in range(2):
            if halves[part, h] >= 0:
                stack[top] = halves[part, h]
                top += 1
    out = np.full((count, 2), -1)
    for i in range(count):
        for h in range(2):
            if halves[walk[i], h] >= 0:
                out[i, h] = number[halves[walk[i], h]]
    return line, parts[walk], out


@njit(cache=True)
def _fronts(
    columns: np.ndarray,
    starts: np.ndarray,
    cells: np.ndarray,
    line: np.ndarray,
    parts: np.ndarray,
    halves: np.ndarray,
) -> Fronts:
    size, count = len(starts) - 1, len(parts)
    above, leaf = np.full(count, -1), np.empty(len(line), np.int64)
    for f in range(count):
        for h in range(2):
            if halves[f, h] >= 0:
                above[halves[f, h]] = f
        if halves[f, 0] < 0:
            leaf[parts[f, 0] : parts[f, 1]] = f
    low, high = np.full(size, len(line)), np.full(size, -1)
    for at in range(len(line)):
        for u in cells[line[at]]:
            if u >= 0:
                low[u], high[u] = min(low[u], at), max(high[u], at)
    owner, own = np.empty(size, np.int64), np.zeros(count, np.int64)
    for u in range(size):
        f = leaf[low[u]]
        while parts[f, 1] <= high[u]:
            f = above[f]
        owner[u] = f
        own[f] += 1
    first = np.zeros(count, np.int64)
    first[1:] = np.cumsum(own)[:-1]
    order, place, next_one = np.empty(size, np.int64), np.empty(size, np.int64), first.copy()
    for u in range(size):
        place[u] = next_one[owner[u]]
        order[place[u]] = u
        next_one[owner[u]] += 1

    # unknowns of a front: its own, and those of its cells or halves that are eliminated later
    begin = np.zeros(count + 1, np.int64)
    rows = np.empty(64 * size + 64, np.int64)
    seen = np.full(size, -1)
    for f in range(count):
        end = begin[f]
        need = end + own[f]
        for h in range(2):
            if halves[f, h] >= 0:
                need += begin[halves[f, h] + 1] - begin[halves[f, h]]
        need += (parts[f, 1] - parts[f, 0]) * cells.shape[1] if halves[f, 0] < 0 else 0
        if need > len(rows):
            longer = np.empty(2 * need, np.int64)
            longer[:end] = rows[:end]
            rows = longer
        for i in range(own[f]):
            rows[end] = first[f] + i
            end += 1
        last = first[f] + own[f]
        if halves[f, 0] < 0:
            for at in range(parts[f, 0], parts[f, 1]):
                for u in cells[line[at]]:
                    if u >= 0 and place[u] >= last and seen[place[u]] != f:
                        seen[place[u]] = f
                        rows[end] = place[u]
                        end += 1
        for h in range(2):
            if halves[f, h] >= 0:
                for i in range(begin[halves[f, h]], begin[halves[f, h] + 1]):
                    if rows[i] >= last and seen[rows[i]] != f:
                        seen[rows[i]] = f
                        rows[end] = rows[i]
                        end += 1
        rows[begin[f] + own[f] : end].sort()
        begin[f + 1] = end

    widest, waiting, most = 0, 0, 0
    kept, entries = np.zeros(count + 1, np.int64), np.zeros(count + 1, np.int64)
    for f in range(count):
        width = begin[f + 1] - begin[f]
        widest = max(widest, width)
        kept[f + 1] = kept[f] + own[f] * width
        for h in range(2):
            if halves[f, h] >= 0:
                waiting -= (begin[halves[f, h] + 1] - begin[halves[f, h]] - own[halves[f, h]]) ** 2
        waiting += (width - own[f]) ** 2
        most = max(most, waiting)

    lower = (len(columns) + size) // 2
    target, source = np.empty(lower, np.int32), np.empty(lower, np.int32)
    diagonal = np.full(size, -1)
    local, filled = np.empty(size, np.int64), 0
    for f in range(count):
        width = begin[f + 1] - begin[f]
        for i in range(width):
            local[rows[begin[f] + i]] = i
        for i in range(own[f]):
            u = order[first[f] + i]
            for at in range(starts[u], starts[u + 1]):
                if columns[at] == u:
                    diagonal[first[f] + i] = at
                if place[columns[at]] >= first[f] + i:
                    target[filled] = i * width + local[place[columns[at]]]
                    source[filled] = at
                    filled += 1
        entries[f + 1] = filled
    if np.any(diagonal < 0):
        raise ValueError("the pattern lacks a part of its diagonal")
    rows = rows[: begin[count]].copy()
    return Fronts(
        order, own, first, rows, begin, halves, target, source, entries, diagonal, kept, widest, most
    )  # fmt: skip
