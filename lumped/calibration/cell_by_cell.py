"""The cells of a grid as arrays: their sides and sections, or one cell if all are alike.

The springs of a cell among unequal cells are the springs of a grid of equal cells like it, but with one layer
distance for all: the largest that any cell needs. The layers of a cell that needs less are then softer, and
the mid-surface carries the rest of its membrane stiffness (`lumped.calibration.closed_form`)."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, Self

import numpy as np

from lumped import moduli
from lumped.calibration.calibration import Calibration
from lumped.grid_lines import Lines, grid_lines
from lumped.sections import PARTS, CellSection
from lumped.spring_constants import Springs
from sheetbench.scenes import Constants, Material, Sheet
from sheetbench.scenes.objects.grading import Graded
from sheetbench.scenes.objects.grid import Grid


@dataclass(frozen=True, eq=False)
class GridCells:
    """The cells of a grid, or one cell if all are alike. sides: (rows, columns, 2) [m]; section: (rows,
    columns, …); covered: (rows, columns) bool, cells that the sheet covers; cells: sections of unequal
    cells, as given; several: whether every row is a sheet of its own, of equal cells."""

    sheet: Sheet
    material: Material
    grid: Grid
    grading: Graded
    lines: tuple[Lines, Lines]
    cells: CellSection | None
    sides: np.ndarray
    section: CellSection
    covered: np.ndarray
    several: bool = False

    @classmethod
    def stacked(cls, each: Sequence[Self], several: bool = False) -> Self:
        """Return the cells of several grids stacked by rows; the grids differ in sides and sections only."""

        def joined(parts: Iterable[Any], names: Iterable[str]) -> dict[str, Any]:
            return {name: np.concatenate([getattr(part, name) for part in parts]) for name in names}

        section = CellSection(**joined([one.section for one in each], PARTS))
        own = joined(each, ("sides", "covered"))
        return replace(each[0], cells=None, section=section, several=several, **own)

    @cached_property
    def present(self) -> tuple[np.ndarray, CellSection]:
        """Sides (m, 2) [m] and section (m, …) of the covered cells."""
        return self.sides[self.covered], self.section.map(lambda part: part[self.covered])

    @cached_property
    def target(self) -> moduli.Moduli:
        """Moduli of the covered cells (m, …), with MacNeal's S* as their shear stiffness."""
        sides, section = self.present
        return moduli.of_section(section, sides)

    def on_grid(self, values: np.ndarray) -> np.ndarray:
        """Return values (…, m) of the covered cells as values of all cells, (…, rows, columns), 0
        elsewhere."""
        array = np.zeros((*values.shape[:-1], *self.covered.shape))
        array[..., self.covered] = values
        return array

    def share(self) -> np.ndarray:
        """Return the share of each cell's area that the sheet covers, (rows, columns)."""
        share = self.covered if self.cells is None or self.cells.share is None else self.cells.share
        return np.asarray(share, dtype=float)


def each_cell(
    sheet: Sheet, material: Material, grid: Grid, grading: Graded = 0.0, cells: CellSection | None = None
) -> GridCells:
    """Return the cells of a grid. cells: sections of unequal cells. Raises BadInput for a grading outside 0
    to 1."""
    lines, section = grid_lines(sheet, grid, grading), cells
    even = not grading and cells is None
    shape = (1, 1) if even else (grid[1] - 1, grid[0] - 1)
    widths = [[across.mean] if even else across.widths for across in lines]
    if section is None:
        plain = CellSection.of(Constants.of(sheet, material))
        section = plain.map(lambda part: np.broadcast_to(part, (*shape, *part.shape)))
    sides = np.stack(np.meshgrid(*widths), axis=-1)
    if cells is not None and cells.growth is not None:
        sides = sides * cells.growth
    covered = section.bending[..., 0, 0] > 0.0
    return GridCells(sheet, material, grid, grading, lines, cells, sides, section, covered)


def with_shares(springs: Calibration, sheet: Sheet, material: Material, cells: CellSection) -> Calibration:
    """Return springs of equal cells, scaled to the cells of a sheet with an outline or cutouts.

    Parameters
    ----------
    springs : Calibration
        Springs of a whole rectangle, alike in all cells.
    sheet : Sheet
        Length, width and thickness.
    material : Material
        Material of the sheet.
    cells : CellSection
        Sections of the cells, (rows, columns, …), which differ by a factor alone.

    Returns
    -------
    Calibration
        Spring constants cell by cell, times the factor of each cell's bending stiffness.
    """
    whole = CellSection.of(Constants.of(sheet, material)).bending[0, 0]
    scaled = Springs.read(springs.springs).scaled(cells.bending[..., 0, 0] / whole)
    return replace(springs, springs=scaled.table(), cells=cells)
