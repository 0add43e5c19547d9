"""Grading of a lattice: how much finer its cells are at the edges of the sheet, all of them or some.

A number from 0 (cells of one size) to 1 holds for every edge, a `Grading` for the edges that it names; in
text 0.5:x0 or 0.5:x0,x1. If one of two opposite edges is named, the cells at the other are as long as in the
middle of a sheet twice as long that is graded at both ends; if neither is named, cells are of one size.

Lines of the grid are moved to `places`, the sides of a drawn sheet's shapes, and on a sheet with other
`sides`, for instance one that has grown, to places in proportion.
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
EVENNESS = 1e-5  # weight of even cells against lines near to places; its square: of lines near to the middle
Places = tuple[tuple[float, ...], tuple[float, ...]]


@dataclass(frozen=True)
class Grading:
    """Grading towards some edges, or lines moved to places. by: from 0 to 1. edges: the edges towards which
    cells are finer. places: x and y [m], rising, that lines are moved to. sides: of the sheet on which the
    places are [m]."""

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
        """Return whether cells are finer towards the lower and towards the upper end of an axis."""
        return f"{'xy'[axis]}0" in self.edges, f"{'xy'[axis]}1" in self.edges


Graded = float | Grading


def remark(grading: Graded) -> str:
    """Return a clause for titles: ", grading 0.3" or ", lines on shapes", "" for equal cells."""
    by = amount(grading)
    return ", lines on shapes" if grading and not by else f", grading {grading:g}" if grading else ""


def towards(by: float, edges: Iterable[str] | None = None) -> Graded:
    """Return the grading by a number from 0 to 1 towards some edges, or all of them (None). Towards all
    edges, or by 0, it is the number. Raises BadInput for other numbers and unknown edges."""
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
    """Return the grading with equal cells but for lines moved to places, on a sheet with sides [m]."""
    return Grading(0.0, tuple(EDGES), places, sides) if any(places) else 0.0


def places_with_lines(places: Sequence[float], length: float, count: int) -> list[float]:
    """Return the places [m], rising, that get one of the `count` lines of a side of this length.

    A place gets a line if it is no closer than THINNEST of a mean cell to the ends and to other lines; of two
    close places the outer gets it. If there are too few lines, no place gets one. The choice is symmetric:
    of two close places equally far from both ends neither gets a line, nor does the middle of mirrored places
    if the number of cells is odd.
    """
    least_spacing = THINNEST * length / (count - 1) * (1.0 - ROUNDING)
    inset = {at: rounded(min(at, length - at), length) for at in (rounded(each, length) for each in places)}
    by_rounded = {rounded(place, length): place for place in reversed(places)}
    lined = [0.0, length]
    for depth in sorted(set(inset.values())):
        candidates = [by_rounded[at] for at in sorted(by_rounded) if inset[at] == depth]
        free = [at for at in candidates if all(abs(at - other) >= least_spacing for other in lined)]
        if len(free) == 1 or (len(free) == 2 and free[1] - free[0] >= least_spacing):
            lined += free
    inner = sorted(lined)[1:-1]
    if not count % 2 and len(inner) % 2 and is_mirrored(inner, length):
        inner.pop(len(inner) // 2)
    return inner if len(inner) < count - 1 else []


def rounded(place: float, length: float) -> float:
    """Return a place on a side rounded to ROUNDING of the side's length."""
    return round(place / (ROUNDING * length)) * ROUNDING * length


def is_mirrored(places: Sequence[float], length: float) -> bool:
    """Return whether places [m], rising, are symmetric about the middle of a side."""
    pairs = zip(places, reversed(places), strict=True)
    return all(rounded(one + other - length, length) == 0.0 for one, other in pairs)


def line_numbers(places: Sequence[float], cells: int) -> list[int]:
    """Return the numbers, of 1 to `cells` − 1, of the lines that are moved to places [cells], rising.

    The lines have the least sum of squared distances from the places; between equal sums the evenness of the
    cells decides, then the lines' distance from the middle. The choice is symmetric. Method: dynamic
    programming over places and lines.
    """
    at = np.array([rounded(place, cells) for place in places])
    if not is_mirrored(places, cells):
        return _nearest(np.append(at, cells), cells, 0.5 * cells)[:-1]
    half = _nearest(np.append(at[: len(at) // 2], 0.5 * cells), -(-cells // 2), 0.5 * cells)[:-1]
    return [*half, *[cells // 2] * (len(places) % 2), *(cells - number for number in reversed(half))]


def _nearest(places: np.ndarray, last: int, middle: float) -> list[int]:
    """Return rising numbers of lines, from 1 on, for the places; the last place has the number `last`."""
    before, widest = np.zeros(1, dtype=int), last - len(places) + 1
    cost, start, choices = np.zeros(1), 0.0, []
    for number, place in enumerate(places, start=1):
        lines = number + np.arange(widest) if number < len(places) else np.array([last])
        between = lines[:, None] - before
        uneven = (place - start) ** 2 / np.maximum(between, 1)
        distance = (lines - place) ** 2 + EVENNESS**2 * (lines - middle) ** 2
        total = np.where(between > 0, cost + distance[:, None] + EVENNESS * uneven, np.inf)
        choices.append((lines, total.argmin(axis=1)))
        cost, start, before = total.min(axis=1), place, lines
    chosen, numbers = 0, []
    for lines, came_from in reversed(choices):
        numbers.append(int(lines[chosen]))
        chosen = int(came_from[chosen])
    return numbers[::-1]


def lines_for_all(places: Sequence[float], length: float) -> int:
    """Return the number of lines that a side [m] needs to have one at each of the places [m], rising."""
    ends = [0.0, *places, length]
    narrowest = min(after - before for before, after in pairwise(ends))
    count = max(len(ends), ceil(THINNEST * length / narrowest * (1.0 - ROUNDING)) + 1)
    return count + (count + 1) % 2 if len(places) % 2 and is_mirrored(places, length) else count


def amount(grading: Graded) -> float:
    """Return the grading's number, without its edges."""
    return grading.by if isinstance(grading, Grading) else grading


def as_settings(grading: Graded) -> dict[str, Any]:
    """Return the keys of a grading in documents: `grading`, and `graded_edges` or `lines_at` if needed."""
    if isinstance(grading, Grading):
        if any(grading.places):
            return {"grading": grading.by, "lines_at": [list(one) for one in grading.places]}
        return {"grading": grading.by, "graded_edges": list(grading.edges)}
    return {"grading": grading}


def of_settings(settings: Mapping[str, Any], sides: tuple[float, float]) -> Graded:
    """Return the grading from the keys of `as_settings`, on a sheet with sides [m]; 0 without keys."""
    if x_and_y := settings.get("lines_at"):
        return through((tuple(x_and_y[0]), tuple(x_and_y[1])), sides)
    return towards(settings.get("grading") or 0.0, settings.get("graded_edges"))
