"""Springs of cells that differ, in size or by a table: each as if all were like it, one layer distance.

The layer distance is the largest that any cell asks for. What a cell that asks for less is then missing in
its membrane, its layers being softer, is the mid-surface's (`lumped.calibration.closed_form`).
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from lumped.grid_lines import grid_lines
from lumped.sections import Section
from lumped.spring_constants import gathered
from sheetbench.scenes import Constants, Material, Sheet, SpringSet
from sheetbench.scenes.grading import Graded
from sheetbench.scenes.grid import Grid

Sides = tuple[float, float]
# of a cell of these sides and this section, and its layer distance if that is given
OfCell = Callable[[Sides, Section, float | None], SpringSet]
DIGITS = 12  # to which cells are told apart


def kinds_of_cells(
    sheet: Sheet, material: Material, grid: Grid, grading: Graded, cells: Section | None
) -> tuple[list[list[int]], list[tuple[Sides, Section]]]:
    """Return which kind every cell is, by rows, and the kinds: sides [m] and section. cells: the sections of
    all, where they differ."""
    across_x, across_y = (lines.widths for lines in grid_lines(sheet, grid, grading))
    plain = Section.of(Constants.of(sheet, material))
    numbers: dict[tuple[float, ...], int] = {}
    found: list[tuple[Sides, Section]] = []
    which = []
    for row, y in enumerate(_rounded(across_y)):
        which.append([0] * len(across_x))
        for column, x in enumerate(_rounded(across_x)):
            own = plain if cells is None else cells.each(lambda part, at=(row, column): part[at])  # type: ignore[misc]
            key = (
                x,
                y,
                *(
                    ()
                    if cells is None
                    else _rounded(np.concatenate([part.ravel() for part in vars(own).values()]))
                ),
            )
            if key not in numbers:
                numbers[key] = len(found)
                found.append(((x, y), own))
            which[-1][column] = numbers[key]
    return which, found


def cell_by_cell(
    of_cell: OfCell,
    sheet: Sheet,
    material: Material,
    grid: Grid,
    grading: Graded,
    cells: Section | None,
    layer_distance: float | None = None,
) -> SpringSet:
    """The springs of a lattice whose cells have those that `of_cell` finds for each.

    Raises BadInput for a grading outside 0 to 1, and what `of_cell` raises.
    """
    which, kinds = kinds_of_cells(sheet, material, grid, grading, cells)
    if layer_distance is None:
        layer_distance = max(of_cell(*kind, None).layer_distance for kind in kinds)
    found = [of_cell(*kind, layer_distance) for kind in kinds]
    return gathered([[found[number] for number in row] for row in which])


def _rounded(values: np.ndarray) -> list[float]:
    return [float(f"{value:.{DIGITS}g}") for value in values]
