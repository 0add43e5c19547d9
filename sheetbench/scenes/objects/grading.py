"""How much finer a lattice's cells are at the edges of the sheet: towards all of them, or towards some.

A number from 0 (cells of one size) to 1 is of every edge, a `Grading` of those that it names; in text
0.5:x0 or 0.5:x0,x1. Of two opposite edges both, one or neither may be named: where it is one the cells at the
other are as long as in the middle of a sheet twice as long that is graded at both ends, where it is neither
they are of one size.

`places` are those that lines of the grid are moved to, the sides of a drawn sheet's shapes, and on a
sheet with other `sides`, as of one that has grown, the same shares of them.
"""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from math import ceil
from typing import Any

import numpy as np

from sheetbench.errors import BadInput
from sheetbench.scenes.objects.sheet import EDGES

THINNEST, ROUNDING = 0.1, 1e-9
ALIKE = 1e-5  # weight of how alike cells are beside how near lines are to places; its square: to the middle
Places = tuple[tuple[float, ...], tuple[float, ...]]


@dataclass(frozen=True)
class Grading:
    """by: from 0, to 1; edges: those towards which cells are finer, some of the four; places: x and y [m],
    rising, that lines are moved to, on a sheet with these sides [m]."""

    by: float
    edges: tuple[str, ...]
    places: Places = ((), ())
    sides: tuple[float, float] = (1.0, 1.0)

    def __format__(self, form: str) -> str:
        if any(self.places):
            return f"{self.by:{form}}, lines on shapes"
        return f"{self.by:{form}}:{','.join(self.edges)}"

    def __str__(self) -> str:
        return f"{self:g}"

    def ends(self, axis: int) -> tuple[bool, bool]:
        """Whether cells are finer towards the lower and towards the upper end of an axis."""
        return f"{'xy'[axis]}0" in self.edges, f"{'xy'[axis]}1" in self.edges


Graded = float | Grading


def remark(grading: Graded) -> str:
    """What a title adds of a grading: ", grading 0.3", ", lines on shapes", nothing of equal cells."""
    by = amount(grading)
    return ", lines on shapes" if grading and not by else f", grading {grading:g}" if grading else ""


def towards(by: float, edges: Iterable[str] | None = None) -> Graded:
    """Graded by a number from 0 to 1 towards the edges named, all of them for None: the number where
    that is towards all or 0. Raises BadInput for anything else."""
    if not 0.0 <= by <= 1.0:
        raise BadInput(f"grading = {by:g}: 0 (all cells alike) to 1 (finest at the edges)")
    named = tuple(EDGES) if edges is None else tuple(edges)
    if unknown := [edge for edge in named if edge not in EDGES]:
        raise BadInput(f"grading = {by:g}:{','.join(named)}: {unknown[0]!r} is none of {', '.join(EDGES)}")
    if not named:
        raise BadInput(f"grading = {by:g}: towards no edge; name some of {', '.join(EDGES)}")
    chosen = tuple(edge for edge in EDGES if edge in named)
    return by if not by or chosen == tuple(EDGES) else Grading(by, chosen)


def through(places: Places, sides: tuple[float, float]) -> Graded:
    """Cells of one size but for the lines that are moved to these places on a sheet with these sides [m]."""
    return Grading(0.0, tuple(EDGES), places, sides) if any(places) else 0.0


def places_with_lines(places: Sequence[float], length: float, count: int) -> list[float]:
    """Return those of the places [m], rising, on a side of this length that have one of its `count` lines:
    those no closer than THINNEST of a mean cell to the ends and to others, of which the outer has the line;
    none if lines are too few.

    From either end it is the same: of two as far from both ends neither has one, nor has the middle of
    places that are mirrored about it where the number of cells is odd.
    """
    least_spacing = THINNEST * length / (count - 1) * (1.0 - ROUNDING)
    inset = {at: rounded(min(at, length - at), length) for at in (rounded(each, length) for each in places)}
    own = {rounded(place, length): place for place in reversed(places)}
    kept = [0.0, length]
    for depth in sorted(set(inset.values())):
        alike = [own[at] for at in sorted(own) if inset[at] == depth]
        free = [at for at in alike if all(abs(at - other) >= least_spacing for other in kept)]
        if len(free) == 1 or (len(free) == 2 and free[1] - free[0] >= least_spacing):
            kept += free
    found = sorted(kept)[1:-1]
    if not count % 2 and len(found) % 2 and is_mirrored(found, length):
        found.pop(len(found) // 2)
    return found if len(found) < count - 1 else []


def rounded(place: float, length: float) -> float:
    """Return a place on a side without its rounding."""
    return round(place / (ROUNDING * length)) * ROUNDING * length


def is_mirrored(places: Sequence[float], length: float) -> bool:
    """Return whether places [m], rising, are the same from either end of a side."""
    pairs = zip(places, reversed(places), strict=True)
    return all(rounded(one + other - length, length) == 0.0 for one, other in pairs)


def line_numbers(places: Sequence[float], cells: int) -> list[int]:
    """Return which of the lines 1 to `cells` − 1 are moved to places [cells], rising: those nearest to all of
    them, by the sum of squares; of equally near ones those that leave cells most alike, then those nearest to
    the middle.

    From either end they are the same. Source: dynamic programming over places and lines.
    """
    at = np.array([rounded(place, cells) for place in places])
    if not is_mirrored(places, cells):
        return _nearest(np.append(at, cells), cells, 0.5 * cells)[:-1]
    half = _nearest(np.append(at[: len(at) // 2], 0.5 * cells), -(-cells // 2), 0.5 * cells)[:-1]
    return [*half, *[cells // 2] * (len(places) % 2), *(cells - number for number in reversed(half))]


def _nearest(places: np.ndarray, last: int, middle: float) -> list[int]:
    """Rising numbers from 1 to `last`, which is that of the last place."""
    before, widest = np.zeros(1, dtype=int), last - len(places) + 1
    cost, start, choices = np.zeros(1), 0.0, []
    for number, place in enumerate(places, start=1):
        lines = number + np.arange(widest) if number < len(places) else np.array([last])
        between = lines[:, None] - before
        uneven = (place - start) ** 2 / np.maximum(between, 1)
        own = (lines - place) ** 2 + ALIKE**2 * (lines - middle) ** 2
        total = np.where(between > 0, cost + own[:, None] + ALIKE * uneven, np.inf)
        choices.append((lines, total.argmin(axis=1)))
        cost, start, before = total.min(axis=1), place, lines
    chosen, numbers = 0, []
    for lines, came_from in reversed(choices):
        numbers.append(int(lines[chosen]))
        chosen = int(came_from[chosen])
    return numbers[::-1]


def lines_for_all(places: Sequence[float], length: float) -> int:
    """Return how many lines a side [m] is to have so that each of the places [m], rising, has one."""
    ends = [0.0, *places, length]
    narrowest = min(after - before for before, after in pairwise(ends))
    count = max(len(ends), ceil(THINNEST * length / narrowest * (1.0 - ROUNDING)) + 1)
    return count + (count + 1) % 2 if len(places) % 2 and is_mirrored(places, length) else count


def amount(grading: Graded) -> float:
    """The number, whatever edges it is of."""
    return grading.by if isinstance(grading, Grading) else grading


def as_settings(grading: Graded) -> dict[str, Any]:
    """As documents have it: `grading`, `graded_edges` where it is not of all edges, `lines_at` where lines
    are moved."""
    if isinstance(grading, Grading):
        if any(grading.places):
            return {"grading": grading.by, "lines_at": [list(one) for one in grading.places]}
        return {"grading": grading.by, "graded_edges": list(grading.edges)}
    return {"grading": grading}


def of_settings(settings: Mapping[str, Any], sides: tuple[float, float]) -> Graded:
    """Return the grading that `as_settings` has written, on a sheet with these sides [m]; 0 for none."""
    if x_and_y := settings.get("lines_at"):
        return through((tuple(x_and_y[0]), tuple(x_and_y[1])), sides)
    return towards(settings.get("grading") or 0.0, settings.get("graded_edges"))
