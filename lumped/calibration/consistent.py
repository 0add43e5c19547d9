"""Every modulus met: the closed form where its links are nonnegative, bounded least squares elsewhere; and
along free, hinged and held edges the twist that a plate lets go there (`lumped.calibration.edge_twist`).

Of a graded grid every cell has its closed form (`lumped.calibration.cell_by_cell`).
"""

from __future__ import annotations

from dataclasses import replace

from lumped import moduli, sections
from lumped.calibration.calibration import Calibration, plan_spacing
from lumped.calibration.cell_by_cell import Sides, cell_by_cell
from lumped.calibration.closed_form import closed_form
from lumped.calibration.least_squares import bounded_least_squares
from lumped.calibration.report import report
from lumped.calibration.rim_twist import with_twist
from lumped.lattice import Grid
from lumped.sections import Section
from sheetbench.errors import BadInput
from sheetbench.scenes import Cells, Material, Sheet, SpringSet
from sheetbench.scenes.grading import Graded


def consistent(
    sheet: Sheet,
    material: Material,
    grid: Grid,
    layer_distance: float | None = None,
    grading: Graded = 0.0,
    cells: Cells | Section | None = None,
) -> Calibration:
    """The moduli of the sheet, and the twist of its edges: of second order in the size of the cells.

    Raises BadInput as `consistent_interior`.
    """
    found = consistent_interior(sheet, material, grid, layer_distance, grading, cells)
    return replace(with_twist(sheet, material, found), method="consistent")


def consistent_membrane(
    sheet: Sheet,
    material: Material,
    grid: Grid,
    layer_distance: float | None = None,
    grading: Graded = 0.0,
    cells: Cells | Section | None = None,
) -> Calibration:
    """As `consistent`, with layers so far apart that a cell bends in its own plane as the sheet does.

    Raises BadInput as `consistent_interior`.
    """
    found = consistent_interior(sheet, material, grid, layer_distance, grading, cells, gradients=True)
    return replace(with_twist(sheet, material, found), method="consistent-membrane")


def consistent_oblique(
    sheet: Sheet,
    material: Material,
    grid: Grid,
    layer_distance: float | None = None,
    grading: Graded = 0.0,
    cells: Cells | Section | None = None,
) -> Calibration:
    """As `consistent`, with waves oblique to the grid right in l² too.

    Raises BadInput as `consistent_interior`.
    """
    found = consistent_interior(sheet, material, grid, layer_distance, grading, cells, waves=True)
    return replace(with_twist(sheet, material, found), method="consistent-oblique")


def consistent_interior(
    sheet: Sheet,
    material: Material,
    grid: Grid,
    layer_distance: float | None = None,
    grading: Graded = 0.0,
    cells: Cells | Section | None = None,
    gradients: bool = False,
    waves: bool = False,
) -> Calibration:
    """The moduli alone, cells along edges like those inside: the closed form; with a given layer distance, or
    where it would need a negative link, bounded least squares on the same moduli. grading: of the grid
    (`lumped.grid_lines`), cells: what they are made of, where they differ, gradients: whether layers are so
    far apart that strains in the plane that vary across a cell cost what they cost the sheet, waves: whether
    oblique ones are right in the second power of the cells (`lumped.calibration.closed_form`), all in closed
    form only.

    Raises BadInput where area springs would leave a cell without positive energy, and for a graded grid whose
    cells have no closed form.
    """
    of_material = cells is None and material.kind == "orthotropic"
    if of_material:
        cells = Cells.of(sheet, material)
    if isinstance(cells, Cells):
        cells = sections.of_cells(cells, grid)
    if grading or cells is not None:
        springs: SpringSet | None = _by_cell(
            sheet, material, grid, layer_distance, grading, cells, gradients, waves
        )
    elif layer_distance is None:
        spacing = plan_spacing(sheet, grid)
        springs = closed_form(
            moduli.of_sheet(sheet, material, spacing), spacing, grid[2], None, gradients, waves
        )
    else:
        springs = None
    if springs is None:
        springs = bounded_least_squares(sheet, material, grid, layer_distance)
    found = report("consistent-interior", sheet, material, grid, springs, grading, cells)
    return replace(found, of_material=of_material)


def _by_cell(
    sheet: Sheet,
    material: Material,
    grid: Grid,
    layer_distance: float | None,
    grading: Graded,
    cells: Section | None,
    gradients: bool,
    waves: bool,
) -> SpringSet:
    def of_cell(sides: Sides, own: Section, distance: float | None) -> SpringSet:
        springs = closed_form(moduli.of_section(own, sides), sides, grid[2], distance, gradients, waves)
        if springs is None:
            given = f"{grid[2]} layers" if distance is None else f"layer_distance = {distance:g} m"
            raise BadInput(
                f"grading = {grading:g}: with {given} a cell of {sides[0]:.4g} × {sides[1]:.4g} m "
                "has no closed form; take two layers, no layer distance of your own, or grading 0"
            )
        return springs

    return cell_by_cell(of_cell, sheet, material, grid, grading, cells, layer_distance)
