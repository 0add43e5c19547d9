"""Springs that match every modulus: the closed form if its links are nonnegative, else bounded least squares;
and along free, hinged and held edges the twist of a plate (`lumped.calibration.edge_twist`).

Every cell of a graded grid has its closed form (`lumped.calibration.cell_by_cell`).
"""

from collections.abc import Sequence
from dataclasses import replace

from lumped import moduli, sections
from lumped.calibration.calibration import Calibration
from lumped.calibration.cell_by_cell import GridCells, each_cell
from lumped.calibration.closed_form import NoClosedForm, springs_of_cells
from lumped.calibration.least_squares import fit_moduli
from lumped.calibration.report import report
from lumped.calibration.rim_twist import with_twist
from lumped.lattice import Grid
from lumped.sections import CellSection
from lumped.spring_constants import Springs
from sheetbench.errors import BadInput
from sheetbench.numerics.cache import cached
from sheetbench.scenes import Cells, Material, Sheet
from sheetbench.scenes.objects.grading import Graded


def springs_of_sheets(
    sheets: Sequence[tuple[Sheet, Material]], grid: Grid, method: str = "consistent"
) -> list[Springs]:
    """Return the `consistent` springs of several isotropic sheets of equal cells in one pass. Raises
    NoClosedForm for a sheet without a closed form."""
    each = [each_cell(sheet, material, grid) for sheet, material in sheets]
    together = GridCells.stacked(each, several=True)
    springs = springs_of_cells(together, **closed_form_options(method))
    if method != "consistent-interior":
        springs, _ = with_twist(together, springs, moduli.of_cells(springs, together.sides, grid[2]))
    return springs.split(len(each))


def closed_form_options(method: str) -> dict[str, bool]:
    """Return the options of the closed form of a method."""
    return {"gradients": method == "consistent-membrane", "waves": method == "consistent-oblique"}


@cached(  # of cells that are alike
    last=16,
    most=0,
    size=lambda _, material, *__, grading=0.0, cells=None, **___: float(
        bool(grading) or cells is not None or material.kind == "orthotropic"
    ),
)
def consistent(
    sheet: Sheet,
    material: Material,
    grid: Grid,
    layer_distance: float | None = None,
    *,
    grading: Graded = 0.0,
    cells: Cells | CellSection | None = None,
    method: str = "consistent",
) -> Calibration:
    """Return springs with the sheet's moduli and the twist of its edges, of second order in the cells' size.

    The closed form; with a given layer distance, or if it would need a negative link, bounded least squares.
    grading: of the grid (`lumped.grid_lines`); cells: table or sections of unequal cells. method:
    `consistent-interior` has cells along edges like cells inside, `consistent-membrane` a layer distance with
    which a cell bends in its plane as the sheet does, `consistent-oblique` waves oblique to the grid right in
    l² too (`lumped.calibration.closed_form`), both in closed form only.

    Raises BadInput if area springs would leave a cell without positive energy, and for a graded grid whose
    cells have no closed form.
    """
    of_material = cells is None and material.kind == "orthotropic"
    if of_material:
        cells = Cells.of(sheet, material)
    if isinstance(cells, Cells):
        cells = sections.of_cells(cells, grid)
    grid_cells = each_cell(sheet, material, grid, grading, cells)
    even = not grading and cells is None
    try:
        if even and layer_distance is not None:
            raise NoClosedForm
        springs = springs_of_cells(grid_cells, layer_distance, **closed_form_options(method))
    except NoClosedForm as cell:
        if not even:
            given = f"{grid[2]} layers"
            if layer_distance is not None:
                given = f"layer_distance = {layer_distance:g} m"
            if grid_cells.target.mixed.any():
                raise BadInput(
                    f"layer: not symmetric about the middle: no springs with {given} match the laminate; "
                    "take two layers without a layer distance, or the shell"
                ) from None
            unequal, instead = "unequal cells", ""
            if cells is None:
                unequal, instead = f"grading = {grading:g}", ", or grading 0"
            raise BadInput(
                f"{unequal}: with {given} a cell of {cell.args[0]:.4g} × {cell.args[1]:.4g} m "
                f"has no closed form; take two layers without a layer distance{instead}"
            ) from None
        springs = fit_moduli(grid_cells, layer_distance)
    notes: list[str] = []
    cell_moduli = moduli.of_cells(springs, grid_cells.sides, grid[2])
    # the moment that fades at an edge depends on the stretch along it too
    if cell_moduli.mixed[..., :2, 2].any():
        notes = ["layers that twist when pulled: cells along edges are not corrected, the order is 1"]
    elif method != "consistent-interior":
        springs, notes = with_twist(grid_cells, springs, cell_moduli)
    return replace(report(method, grid_cells, springs, notes, cell_moduli), of_material=of_material)
