"""Springs of cells that differ, in size or by a table: each as if all were like it, one layer distance.

The layer distance is the largest that any cell asks for. What a cell that asks for less is then missing in
its membrane, its layers being softer, is the mid-surface's (`lumped.calibration.closed_form`).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from lumped.calibration.calibration import Calibration
from lumped.grid_lines import grid_lines
from lumped.sections import Section
from lumped.spring_constants import gathered
from sheetbench.scenes import Constants, Material, Sheet, SpringSet
from sheetbench.scenes.grading import Graded
from sheetbench.scenes.grid import Grid

Sides = tuple[float, float]
# of a cell of these sides and this section, and its layer distance if that is given
OfCell = Callable[[Sides, Section, float | None], SpringSet]
DIGITS = 12  # to which cells are distinguished


class Kinds(NamedTuple):
    """cells: the sections of all, where they differ; of: sides [m] and section of every kind; which: the
    number of every cell's kind, (rows, columns); factor: how many times as stiff as that the cell is, at most
    1, 0 where there is none."""

    grid: Grid
    grading: Graded
    cells: Section | None
    of: list[tuple[Sides, Section]]
    which: np.ndarray
    factor: np.ndarray


def kinds_of_cells(
    sheet: Sheet, material: Material, grid: Grid, grading: Graded = 0.0, cells: Section | None = None
) -> Kinds:
    """Return the kinds of cells. cells: the sections of all, where they differ; those that differ by a factor
    alone are of one kind. Raises BadInput for a grading outside 0 to 1."""
    lines, plain = grid_lines(sheet, grid, grading), Section.of(Constants.of(sheet, material))
    shape = grid[1] - 1, grid[0] - 1
    if not grading and cells is None:
        only = [((lines[0].mean, lines[1].mean), plain)]
        return Kinds(grid, grading, cells, only, np.zeros(shape, dtype=int), np.ones(shape))
    widths = ([float(f"{width:.{DIGITS}g}") for width in across.widths] for across in lines)
    sides = np.stack(np.meshgrid(*widths), axis=-1)
    every = plain.each(lambda part: np.broadcast_to(part, (*shape, *part.shape))) if cells is None else cells
    scale = every.bending[..., 0, 0]
    stiffness = [] if cells is None else [every.membrane, every.bending, every.shear]
    with np.errstate(invalid="ignore", divide="ignore"):
        parts = [sides, *(part.reshape(*shape, -1) / scale[..., None] for part in stiffness)]
        keys = _rounded(np.concatenate(parts, axis=-1))
    numbers: dict[tuple[float, ...], int] = {}
    found: list[tuple[Sides, Section]] = []
    stiffest = []
    which = np.zeros(shape, dtype=int)
    for at in zip(*np.unravel_index(np.argsort(-scale, axis=None, kind="stable"), shape), strict=True):
        if scale[at] == 0.0:
            continue
        number = which[at] = numbers.setdefault(tuple(keys[at]), len(found))
        if number == len(found):
            x, y = sides[at]
            found.append(((float(x), float(y)), every.each(lambda part, at=at: part[at])))  # type: ignore[misc]
            stiffest.append(scale[at])
    return Kinds(grid, grading, cells, found, which, scale / np.array(stiffest)[which])


def cell_by_cell(of_cell: OfCell, kinds: Kinds, layer_distance: float | None = None) -> SpringSet:
    """The springs of a lattice whose cells have those that `of_cell` finds for each."""
    if layer_distance is None:
        layer_distance = max(of_cell(*kind, None).layer_distance for kind in kinds.of)
    found = [of_cell(*kind, layer_distance) for kind in kinds.of]
    return gathered(found, kinds.which, kinds.factor)


def with_shares(found: Calibration, sheet: Sheet, material: Material, cells: Section) -> Calibration:
    """Return springs, alike in all cells, on a sheet with an outline or cutouts: a share for each cell.
    cells: the sections of all, which differ by a factor alone."""
    whole = Section.of(Constants.of(sheet, material)).bending[0, 0]
    factor = cells.bending[..., 0, 0] / whole
    springs = gathered([found.springs], np.zeros(factor.shape, dtype=int), factor)
    return replace(found, springs=springs, cells=cells)


def _rounded(values: np.ndarray) -> np.ndarray:
    """To so many digits."""
    unit = 10.0 ** (np.floor(np.log10(np.abs(values))) - DIGITS + 1)
    return np.where(values == 0.0, 0.0, np.rint(values / unit) * unit)
