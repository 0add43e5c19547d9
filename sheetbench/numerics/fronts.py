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
    found = _fronts(columns, starts, cells.unknowns, *_dissected(cells.places, leaf))
    if np.any(found.diagonal < 0):
        raise ValueError("the pattern lacks a part of its diagonal")
    return found


def _dissected(places: np.ndarray, leaf: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Cells in line (m,), parts (F, 2) as ranges of the line, and every part's halves (F, 2), −1 for none;
    parts in the order of a walk that ends at each part after its halves. leaf: cells in a part that is not
    halved."""
    line, count = np.arange(len(places)), 1
    parts, halves = [np.array([[0, len(places)]])], [np.full((1, 2), -1)]
    while (split := np.flatnonzero(np.diff(parts[-1])[:, 0] > leaf)).size:  # a generation at once
        start, end = parts[-1][split].T
        size = end - start
        first = np.cumsum(size) - size
        at = np.arange(size.sum()) + np.repeat(start - first, size)
        here = places[line[at]]
        extent = np.maximum.reduceat(here, first) - np.minimum.reduceat(here, first)
        along = np.repeat(extent[:, 0] < extent[:, 1], size)
        of_part = np.repeat(np.arange(len(split)), size)
        line[at] = line[at[np.lexsort((np.where(along, here[:, 1], here[:, 0]), of_part))]]
        middle = (start + end) // 2
        halves[-1][split] = count + np.arange(2 * len(split)).reshape(-1, 2)
        parts.append(np.column_stack([start, middle, middle, end]).reshape(-1, 2))
        halves.append(np.full(parts[-1].shape, -1))
        count += len(parts[-1])
    every, below = np.concatenate(parts), np.concatenate(halves)
    walk = np.lexsort((-every[:, 0], every[:, 1]))
    number = np.append(np.argsort(walk), -1)
    return line, every[walk], number[below[walk]]


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
    first, next_one = np.zeros(count, np.int64), np.zeros(count, np.int64)
    for f in range(1, count):
        first[f] = next_one[f] = first[f - 1] + own[f - 1]
    order, place = np.empty(size, np.int64), np.empty(size, np.int64)
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
        last, border = first[f] + own[f], end
        if halves[f, 0] < 0:
            for at in range(parts[f, 0], parts[f, 1]):
                for u in cells[line[at]]:
                    if u >= 0 and place[u] >= last and seen[place[u]] != f:
                        seen[place[u]] = f
                        k = end
                        while k > border and rows[k - 1] > place[u]:
                            rows[k] = rows[k - 1]
                            k -= 1
                        rows[k] = place[u]
                        end += 1
        else:  # both halves' borders are in order
            i, j = begin[halves[f, 0]] + own[halves[f, 0]], begin[halves[f, 1]] + own[halves[f, 1]]
            end_i, end_j = begin[halves[f, 0] + 1], begin[halves[f, 1] + 1]
            while i < end_i or j < end_j:
                row = rows[i] if j == end_j or (i < end_i and rows[i] <= rows[j]) else rows[j]
                i += i < end_i and rows[i] == row
                j += j < end_j and rows[j] == row
                if row >= last:
                    rows[end] = row
                    end += 1
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
    rows = rows[: begin[count]].copy()
    return Fronts(
        order, own, first, rows, begin, halves, target, source, entries, diagonal, kept, widest, most
    )  # fmt: skip
