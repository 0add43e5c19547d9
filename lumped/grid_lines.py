"""The lines of a plan grid across one side of the sheet: where they are, and what length each stands for.

Of n lines on a side a, graded by γ from 0 (all cells alike) to 1 (Chebyshev's points), line i is at

    x(t) = a [(1 − γ) t + ½ γ (1 − cos πt)],    t = i/(n − 1),

so that of many the cells at both ends have 1 − γ of the mean width, and those in the middle 1 + (½ π − 1) γ.
Graded towards one end only they are the lines of one half of a side twice as long: 1 − γ at that end,
1 + (½ π − 1) γ at the other.

Of a drawn sheet whose shapes have sides along the axes the lines nearest to these are moved there, and those
between them in proportion, so that rims, slits and clamps end where cells do. Sides closer to one further out
than a tenth of a mean cell have no line of their own; where there are too few lines for all none is moved.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from sheetbench.scenes import PiecewiseCurve, Sheet
from sheetbench.scenes.objects.grading import (
    Graded,
    Grading,
    amount,
    line_numbers,
    places_with_lines,
    towards,
)
from sheetbench.scenes.objects.grid import Grid


@dataclass(frozen=True, eq=False)
class Lines:
    """at: (n,) [m] places of the lines from 0 on; widths: (n − 1,) [m] of the cells between; mean: [m]."""

    at: np.ndarray
    widths: np.ndarray
    mean: float

    @property
    def tributary(self) -> np.ndarray:
        """Length that each line stands for, half of the cells beside it, (n,) [m]."""
        padded = np.concatenate([[0.0], self.widths, [0.0]])
        return 0.5 * (padded[:-1] + padded[1:])

    def index(self, x: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """The cell (…,) in which places x [m] lie, the first or last for those beyond, and how far into it
        they are as a share of its width."""
        cell = np.clip(np.searchsorted(self.at, x, side="right") - 1, 0, len(self.widths) - 1)
        return cell, (x - self.at[cell]) / self.widths[cell]

    def around(self, x: np.ndarray, count: int) -> tuple[np.ndarray, np.ndarray]:
        """The `count` lines nearest to the cells of places x (k,) [m], all where there are fewer, and the
        weight of each in the polynomial through them (Lagrange's), on a line its own is 1; (k, count)."""
        count = min(count, len(self.at))
        first = np.clip(self.index(x)[0] - (count - 2) // 2, 0, len(self.at) - count)
        chosen = first[:, None] + np.arange(count)
        places, own = self.at[chosen], np.eye(count, dtype=bool)
        apart = np.where(own, 1.0, places[:, :, None] - places[:, None, :])
        to_point = np.where(own, 1.0, x[:, None, None] - places[:, None, :])
        return chosen, np.asarray((to_point / apart).prod(axis=2))


def grid_lines(sheet: Sheet, grid: Grid, grading: Graded = 0.0) -> tuple[Lines, Lines]:
    """The lines across x and across y. Raises BadInput for a grading outside 0 to 1."""
    by = amount(grading)
    towards(by)
    lines = []
    for axis in (0, 1):
        ends = grading.ends(axis) if isinstance(grading, Grading) else (True, True)
        found = _lines(sheet.lengths[axis], grid[axis], by if any(ends) else 0.0, ends)
        if isinstance(grading, Grading):
            grown = sheet.lengths[axis] / grading.sides[axis]
            found = _through(found, [grown * place for place in grading.places[axis]])
        lines.append(found)
    return lines[0], lines[1]


def _lines(length: float, count: int, grading: float, ends: tuple[bool, bool]) -> Lines:
    mean = length / (count - 1)
    if not grading:
        return Lines(np.arange(count) * mean, np.full(count - 1, mean), mean)
    if not all(ends):
        whole = _lines(2.0 * length, 2 * count - 1, grading, (True, True))
        at, widths = whole.at[:count], whole.widths[: count - 1]
        if not ends[0]:
            at, widths = at[-1] - at[::-1], widths[::-1]
        return Lines(at, widths, mean)
    t = np.linspace(0.0, 1.0, count)
    at = length * ((1.0 - grading) * t + 0.5 * grading * (1.0 - np.cos(np.pi * t)))
    widths = np.diff(at)
    return Lines(at, 0.5 * (widths + widths[::-1]), mean)  # mirror images to the last digit


def _through(lines: Lines, places: Sequence[float]) -> Lines:
    """The lines with some moved to the places [m], rising, and those between in proportion."""
    last, end = len(lines.at) - 1, float(lines.at[-1])
    kept = places_with_lines(places, end, last + 1)
    if not kept:
        return lines
    numbers = np.arange(last + 1)
    in_cells = PiecewiseCurve(lines.at.tolist(), numbers.tolist()).at(np.array(kept))
    moved = [0, *line_numbers(in_cells.tolist(), last), last]
    at = PiecewiseCurve(moved, [0.0, *kept, end]).at(numbers)
    return Lines(at, np.diff(at), lines.mean)
