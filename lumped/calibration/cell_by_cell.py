"""The cells of a grid, all at once: their sides and sections, or one where all are alike.

Springs of cells that differ, in size or by a table, are each as if all were like it, with one layer distance:
the largest that any cell asks for. What a cell that asks for less is then missing in its membrane, its layers
being softer, is the mid-surface's (`lumped.calibration.closed_form`)."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from lumped import moduli
from lumped.calibration.calibration import Calibration
from lumped.grid_lines import Lines, grid_lines
from lumped.sections import CellSection
from lumped.spring_constants import Springs
from sheetbench.scenes import Constants, Material, Sheet
from sheetbench.scenes.objects.grading import Graded
from sheetbench.scenes.objects.grid import Grid


@dataclass(frozen=True, eq=False)
class EachCell:
    """sides (rows, columns, 2) [m] and section (rows, columns, …) of the cells, of one where all are alike;
    there: which there are, (rows, columns); cells: the sections as given, where they differ."""

    sheet: Sheet
    material: Material
    grid: Grid
    grading: Graded
    lines: tuple[Lines, Lines]
    cells: CellSection | None
    sides: np.ndarray
    section: CellSection
    there: np.ndarray

    @cached_property
    def present(self) -> tuple[np.ndarray, CellSection]:
        """Sides and section of the cells that there are, (m, 2) and (m, …)."""
        return self.sides[self.there], self.section.each(lambda part: part[self.there])

    @cached_property
    def target(self) -> moduli.Moduli:
        """Moduli of the cells that there are (m, …), with MacNeal's S* as their shear stiffness."""
        sides, section = self.present
        return moduli.of_section(section, sides)

    def placed(self, values: np.ndarray) -> np.ndarray:
        """Values (…, m) of the cells that there are among all of them, (…, rows, columns), 0 elsewhere."""
        found = np.zeros((*values.shape[:-1], *self.there.shape))
        found[..., self.there] = values
        return found

    def share(self) -> np.ndarray:
        """The sheet's share of each cell, (rows, columns), 0 where there is none."""
        share = self.there if self.cells is None or self.cells.share is None else self.cells.share
        return np.asarray(share, dtype=float)


def each_cell(
    sheet: Sheet, material: Material, grid: Grid, grading: Graded = 0.0, cells: CellSection | None = None
) -> EachCell:
    """Return the cells. cells: the sections of all, where they differ. Raises BadInput for a grading outside
    0 to 1."""
    lines, section = grid_lines(sheet, grid, grading), cells
    even = not grading and cells is None
    shape = (1, 1) if even else (grid[1] - 1, grid[0] - 1)
    widths = [[across.mean] if even else across.widths for across in lines]
    if section is None:
        plain = CellSection.of(Constants.of(sheet, material))
        section = plain.each(
            lambda part: part[None, None] if even else np.broadcast_to(part, (*shape, *part.shape))
        )
    sides = np.stack(np.meshgrid(*widths), axis=-1)
    if cells is not None and cells.growth is not None:
        sides = sides * cells.growth
    there = section.bending[..., 0, 0] > 0.0
    return EachCell(sheet, material, grid, grading, lines, cells, sides, section, there)


def with_shares(found: Calibration, sheet: Sheet, material: Material, cells: CellSection) -> Calibration:
    """Return springs, alike in all cells, on a sheet with an outline or cutouts: a share for each cell.
    cells: the sections of all, which differ by a factor alone."""
    whole = CellSection.of(Constants.of(sheet, material)).bending[0, 0]
    springs = Springs.read(found.springs).scaled(cells.bending[..., 0, 0] / whole)
    return replace(found, springs=springs.table(), cells=cells)
