"""The lines of a plan grid across one side of the sheet: their places and tributary lengths.

Line i of n lines on a side a, graded by γ from 0 (equal cells) to 1 (Chebyshev's points), is at

    x(t) = a [(1 − γ) t + ½ γ (1 − cos πt)],    t = i/(n − 1),

so that for many lines the cells at both ends have 1 − γ of the mean width, and cells in the middle
1 + (½ π − 1) γ. Lines graded towards one end only are the lines of one half of a side twice as long: 1 − γ at
the fine end, 1 + (½ π − 1) γ at the other.

If shapes of a drawn sheet have sides along the axes, the lines nearest to the sides are moved there, and the
lines between in proportion, so that rims, slits and clamps end where cells do. A side closer than a tenth of
a mean cell to one further out has no line; with too few lines for all sides no line is moved.
"""

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
    """Lines across one side. at: (n,) [m] places from 0 on; widths: (n − 1,) [m] of the cells between; mean:
    [m] width."""

    at: np.ndarray
    widths: np.ndarray
    mean: float

    @property
    def tributary(self) -> np.ndarray:
        """Tributary length of each line, half of the two adjacent cells, (n,) [m]."""
        padded = np.concatenate([[0.0], self.widths, [0.0]])
        return 0.5 * (padded[:-1] + padded[1:])

    def index(self, x: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return the cell (…,) in which each place x [m] lies, the first or last for places beyond, and the
        place in the cell as a share of its width."""
        cell = np.clip(np.searchsorted(self.at, x, side="right") - 1, 0, len(self.widths) - 1)
        return cell, (x - self.at[cell]) / self.widths[cell]

    def around(self, x: np.ndarray, count: int) -> tuple[np.ndarray, np.ndarray]:
        """Return, for each position x (k,) [m], the `count` lines nearest to its cell (all, on a grid with
        fewer), and their weights in the Lagrange polynomial through them, (k, count) each."""
        count = min(count, len(self.at))
        first = np.clip(self.index(x)[0] - (count - 2) // 2, 0, len(self.at) - count)
        numbers = first[:, None] + np.arange(count)
        places, diagonal = self.at[numbers], np.eye(count, dtype=bool)
        between_lines = np.where(diagonal, 1.0, places[:, :, None] - places[:, None, :])
        to_point = np.where(diagonal, 1.0, x[:, None, None] - places[:, None, :])
        return numbers, np.asarray((to_point / between_lines).prod(axis=2))


def grid_lines(sheet: Sheet, grid: Grid, grading: Graded = 0.0) -> tuple[Lines, Lines]:
    """Return the lines across x and across y. Raises BadInput for a grading outside 0 to 1."""
    by = amount(grading)
    towards(by)
    lines = []
    for axis in (0, 1):
        ends = grading.ends(axis) if isinstance(grading, Grading) else (True, True)
        side = _lines(sheet.lengths[axis], grid[axis], by if any(ends) else 0.0, ends)
        if isinstance(grading, Grading):
            growth = sheet.lengths[axis] / grading.sides[axis]
            side = _aligned(side, [growth * place for place in grading.places[axis]])
        lines.append(side)
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


def _aligned(lines: Lines, places: Sequence[float]) -> Lines:
    """Return the lines with the nearest ones moved to the places [m], rising, and lines between in
    proportion."""
    last, end = len(lines.at) - 1, float(lines.at[-1])
    kept = places_with_lines(places, end, last + 1)
    if not kept:
        return lines
    numbers = np.arange(last + 1)
    in_cells = PiecewiseCurve(lines.at.tolist(), numbers.tolist()).at(np.array(kept))
    moved = [0, *line_numbers(in_cells.tolist(), last), last]
    at = PiecewiseCurve(moved, [0.0, *kept, end]).at(numbers)
    return Lines(at, np.diff(at), lines.mean)
