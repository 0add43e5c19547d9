"""Calibration methods that need the sheet and its material alone, by name; springs of a scene's table."""

from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial
from typing import Any

from lumped.calibration.calibration import Calibration
from lumped.calibration.cell_by_cell import each_cell
from lumped.calibration.central import cauchy, central
from lumped.calibration.consistent import consistent
from lumped.calibration.least_squares import fit_moduli
from lumped.calibration.report import report
from lumped.calibration.rubber import hyperelastic
from lumped.calibration.textbook import axial, lloyd, uniform, van_gelder
from lumped.sections import sections_of
from lumped.spring_constants import Springs, require_cells
from sheetbench.errors import Impossible
from sheetbench.scenes import Material, Scene, Sheet
from sheetbench.scenes.meaning.natural_state import sheet_at_rest
from sheetbench.scenes.objects.grading import Graded
from sheetbench.scenes.objects.grid import DEFAULT_MASSES, Grid, grid_of

SPRINGS: dict[str, Callable[..., Springs | tuple[Springs, list[str]]]] = {  # or springs with notes
    "moduli": fit_moduli,
    "uniform": uniform,
    "cauchy": cauchy,
    "central": central,
    "axial": axial,
    "van-gelder": van_gelder,
    "lloyd": lloyd,
}


def equal_springs(method: str, sheet: Sheet, material: Material, grid: Grid, **options: Any) -> Calibration:
    """Return springs that are alike in all cells, by a method of SPRINGS."""
    grid_cells = each_cell(sheet, material, grid)
    result = SPRINGS[method](grid_cells, **options)
    springs, notes = result if isinstance(result, tuple) else (result, [])
    return report(method, grid_cells, springs, notes)


# by name: make(sheet, material, grid, **options), with the options that `sheetbench.choices` names
MAKERS: dict[str, Callable[..., Calibration]] = {
    "consistent": consistent,
    "consistent-interior": partial(consistent, method="consistent-interior"),
    "consistent-membrane": partial(consistent, method="consistent-membrane"),
    "consistent-oblique": partial(consistent, method="consistent-oblique"),
    "neo-hookean": partial(hyperelastic, method="neo-hookean"),
    "hyperelastic": hyperelastic,
    **{name: partial(equal_springs, name) for name in SPRINGS},
}


def given(
    scene: Scene, grid: int | Sequence[int] | None = None, grading: Graded | None = None
) -> Calibration:
    """Return the springs of a scene's [springs] table.

    Parameters
    ----------
    scene : Scene
        Scene with a [springs] table.
    grid : int or sequence of int, optional
        Masses along the shorter side, (nx, ny) or (nx, ny, layers); by default the table's grid, or nine
        masses along the shorter side.
    grading : float or Grading, optional
        Grading of the grid's lines; by default the table's.

    Returns
    -------
    Calibration
        The table's spring constants [N/m] with a report of the moduli that they meet.

    Raises
    ------
    Impossible
        If the scene has no springs, or springs of another grid or grading.
    """
    if (table := scene.springs) is None:
        raise Impossible(f"scene '{scene.name}' has no [springs] table")
    requested = grid_of(scene.sheet, grid if grid is not None else table.grid or DEFAULT_MASSES)
    if table.grid not in (None, requested):
        stored, other = ("x".join(map(str, numbers)) for numbers in (table.grid, requested))
        raise Impossible(
            f"scene '{scene.name}': springs.grid = {stored}: the springs are not for a grid of {other}; "
            f"solve on {stored}, or calibrate: sheetbench calibrate --grid {other} --toml"
        )
    graded = table.graded(scene.sheet.lengths)
    if grading not in (None, graded):
        raise Impossible(
            f"scene '{scene.name}': springs.grading = {graded:g}: the springs are not for "
            f"grading {grading:g}; leave --grading out, or calibrate: "
            f"sheetbench calibrate --grading {grading:g} --toml"
        )
    require_cells(table, requested, f"scene '{scene.name}': ")
    springs = Springs.read(table)
    if table.grading and not springs.varies and requested[:2] != (2, 2):
        raise Impossible(
            f"scene '{scene.name}': springs.grading = {graded:g}: unequal cells need unequal "
            f"springs, and all are equal; calibrate: sheetbench calibrate --grading {graded:g} --toml"
        )
    cells = sections_of(scene, requested, graded)
    grid_cells = each_cell(scene.sheet, scene.material, requested, graded, cells if springs.varies else None)
    return replace(report("scene", grid_cells, springs), masses=table.masses, cells=cells)


def default(scene: Scene) -> Calibration:
    """Return the scene's springs, or else consistent ones, for rubber springs of its law, on nine masses
    along the shorter side."""
    if scene.springs is not None:
        return given(scene)
    grid = grid_of(scene.sheet)
    if scene.material.law is not None:
        return hyperelastic(scene.sheet, scene.material, grid, cells=sections_of(scene, grid))
    return consistent(sheet_at_rest(scene), scene.material, grid, cells=sections_of(scene, grid))
