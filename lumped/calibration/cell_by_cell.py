"""Springs of cells that differ, in size or by a table: each as if all were like it, one layer distance.

The layer distance is the largest that any cell asks for. What a cell that asks for less is then missing in
its membrane, its layers being softer, is the mid-surface's (`lumped.calibration.closed_form`).
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from lumped.grid_lines import grid_lines
from lumped.springs.by_cell import gathered
from sheetbench.scenes import Cells, Material, Sheet, SpringSet
from sheetbench.scenes.grading import Graded
from sheetbench.scenes.grid import Grid

# of a cell as a sheet, and its layer distance if that is given
OfCell = Callable[[Sheet, Material, float | None], SpringSet]
DIGITS = 12  # to which cells of one size are told


def kinds_of_cells(
    sheet: Sheet, material: Material, grid: Grid, grading: Graded, cells: Cells | None
) -> tuple[list[list[int]], list[tuple[Sheet, Material]]]:
    """Return which kind every cell is, by rows, and the kinds: a sheet of a cell's size, and its material."""
    across_x, across_y = (_rounded(lines.widths) for lines in grid_lines(sheet, grid, grading))
    cells = cells or Cells.of(sheet, material)
    cells.require_grid(grid)
    tables = [np.broadcast_to(value, (len(across_y), len(across_x))) for value in vars(cells).values()]
    numbers: dict[tuple[float, ...], int] = {}
    found: list[tuple[Sheet, Material]] = []
    which = []
    for row, y in enumerate(across_y):
        which.append([0] * len(across_x))
        for column, x in enumerate(across_x):
            key = (x, y, *(float(table[row, column]) for table in tables))
            if key not in numbers:
                numbers[key] = len(found)
                found.append(cells.cell(row, column, (x, y), material))
            which[-1][column] = numbers[key]
    return which, found


def cell_by_cell(
    of_cell: OfCell,
    sheet: Sheet,
    material: Material,
    grid: Grid,
    grading: Graded,
    cells: Cells | None,
    layer_distance: float | None = None,
) -> SpringSet:
    """The springs of a lattice whose cells have those that `of_cell` finds for each.

    Raises BadInput for a grading outside 0 to 1 and a table of other cells, and what `of_cell` raises.
    """
    which, kinds = kinds_of_cells(sheet, material, grid, grading, cells)
    if layer_distance is None:
        layer_distance = max(of_cell(*kind, None).layer_distance for kind in kinds)
    found = [of_cell(*kind, layer_distance) for kind in kinds]
    return gathered([[found[number] for number in row] for row in which])


def _rounded(widths: np.ndarray) -> list[float]:
    return [float(f"{width:.{DIGITS}g}") for width in widths]
