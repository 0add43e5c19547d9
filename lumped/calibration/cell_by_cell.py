"""Springs of a graded grid: every cell's as if all cells were like it, at one layer distance for all.

The layer distance is the largest that any cell asks for. What a cell that asks for less is then missing in
its membrane, its layers being softer, is the mid-surface's (`lumped.calibration.closed_form`).
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from lumped.grid_lines import grid_lines
from lumped.springs.by_cell import gathered
from sheetbench.scenes import Sheet, SpringSet
from sheetbench.scenes.grading import Graded
from sheetbench.scenes.grid import Grid

OfCell = Callable[[Sheet, float | None], SpringSet]  # a sheet of one cell, and its layer distance if given
DIGITS = 12  # to which cells of one size are told


def cell_by_cell(
    of_cell: OfCell, sheet: Sheet, grid: Grid, grading: Graded, layer_distance: float | None = None
) -> SpringSet:
    """The springs of a lattice whose cells have those that `of_cell` finds for each.

    Raises BadInput for a grading outside 0 to 1, and what `of_cell` raises.
    """
    across_x, across_y = (_rounded(lines.widths) for lines in grid_lines(sheet, grid, grading))

    def springs_of(distance: float | None) -> dict[tuple[float, float], SpringSet]:
        return {
            (x, y): of_cell(sheet.model_copy(update={"length_x": x, "length_y": y}), distance)
            for x in set(across_x)
            for y in set(across_y)
        }

    if layer_distance is None:
        layer_distance = max(springs.layer_distance for springs in springs_of(None).values())
    found = springs_of(layer_distance)
    return gathered([[found[x, y] for x in across_x] for y in across_y])


def _rounded(widths: np.ndarray) -> list[float]:
    return [float(f"{width:.{DIGITS}g}") for width in widths]
