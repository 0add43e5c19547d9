"""Every modulus met: the closed form where its links are nonnegative, bounded least squares elsewhere."""

from __future__ import annotations

from dataclasses import replace

from lumped import moduli
from lumped.calibration.calibration import Calibration, plan_spacing, report
from lumped.calibration.closed_form import closed_form
from lumped.calibration.edge_twist import with_edges
from lumped.calibration.least_squares import bounded_least_squares
from lumped.lattice import Grid
from sheetbench.scenes import Material, Sheet


def consistent(
    sheet: Sheet, material: Material, grid: Grid, layer_distance: float | None = None
) -> Calibration:
    """The closed form; with a given layer distance, or where it would need a negative link, bounded least
    squares on the same moduli.

    Raises BadInput where area springs would leave a cell without positive energy.
    """
    springs = None
    if layer_distance is None:
        spacing = plan_spacing(sheet, grid)
        springs = closed_form(moduli.of_sheet(sheet, material, spacing), spacing, grid[2])
    if springs is None:
        springs = bounded_least_squares(sheet, material, grid, layer_distance)
    return report("consistent", sheet, material, grid, springs)


def consistent_edges(
    sheet: Sheet, material: Material, grid: Grid, layer_distance: float | None = None
) -> Calibration:
    """The springs of `consistent`, and the twist of the cells along free, hinged and held edges as a plate
    has it (`lumped.calibration.edge_twist`): of second order in the size of the cells.

    Raises BadInput where area springs would leave a cell without positive energy.
    """
    found = consistent(sheet, material, grid, layer_distance)
    springs, notes = with_edges(sheet, grid, found.springs)
    return replace(found, method="consistent-edges", springs=springs, notes=(*found.notes, *notes))
