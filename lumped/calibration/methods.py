"""Methods that need nothing but the sheet and its material, by name; springs that a scene brings itself."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import partial

from lumped.calibration.calibration import Calibration
from lumped.calibration.cell_by_cell import each_cell
from lumped.calibration.central import central
from lumped.calibration.consistent import consistent
from lumped.calibration.least_squares import fit_moduli
from lumped.calibration.report import report
from lumped.calibration.rubber import hyperelastic
from lumped.calibration.textbook import axial, cauchy, lloyd, uniform, van_gelder
from lumped.sections import sections_of
from lumped.spring_constants import Springs, require_cells
from sheetbench import choices
from sheetbench.errors import Impossible
from sheetbench.scenes import Scene, SpringTable
from sheetbench.scenes.meaning.natural_state import sheet_at_rest
from sheetbench.scenes.objects.grading import Graded
from sheetbench.scenes.objects.grid import MASSES, grid_of


@dataclass(frozen=True)
class CalibrationMethod(choices.Method):
    """A method as `sheetbench.choices` describes it, and what carries it out:
    make(sheet, material, grid, **options)."""

    make: Callable[..., Calibration] = field(kw_only=True)


def described(makers: Mapping[str, Callable[..., Calibration]]) -> dict[str, CalibrationMethod]:
    """These makers as methods by name, in the order of `sheetbench.choices`."""
    return {
        name: CalibrationMethod(**vars(choice), make=makers[name])
        for name, choice in choices.CALIBRATIONS.items()
        if name in makers
    }


MAKERS: dict[str, Callable[..., Calibration]] = {
    "consistent": consistent,
    "consistent-interior": partial(consistent, method="consistent-interior"),
    "consistent-membrane": partial(consistent, method="consistent-membrane"),
    "consistent-oblique": partial(consistent, method="consistent-oblique"),
    "neo-hookean": partial(hyperelastic, method="neo-hookean"),
    "hyperelastic": hyperelastic,
    "moduli": fit_moduli,
    "uniform": uniform,
    "cauchy": cauchy,
    "central": central,
    "axial": axial,
    "van-gelder": van_gelder,
    "lloyd": lloyd,
}
CLOSED = described(MAKERS)


def given(
    scene: Scene, grid: int | Sequence[int] | None = None, grading: Graded | None = None
) -> Calibration:
    """The springs of the scene's own [springs] table, with their moduli report.

    grid: as `scenes.objects.grid` reads it; by default the table's own, or nine masses along the shorter
    side where it names none; grading: the table's own unless given. Raises Impossible when the scene has no
    springs, or those of another lattice.
    """
    if scene.springs is None:
        raise Impossible(f"scene '{scene.name}' has no [springs] table")
    table = SpringTable.model_validate(scene.springs)
    requested = grid_of(scene.sheet, grid if grid is not None else table.grid or MASSES)
    if table.grid not in (None, requested):
        own, other = ("x".join(map(str, numbers)) for numbers in (table.grid, requested))
        raise Impossible(
            f"scene '{scene.name}': springs.grid = {own}: these springs are not those of {other} masses; "
            f"solve on {own}, or find others: sheetbench calibrate --grid {other} --toml"
        )
    if grading not in (None, table.graded):
        raise Impossible(
            f"scene '{scene.name}': springs.grading = {table.graded:g}: these springs are not those of "
            f"grading {grading:g}; leave --grading out, or find others: "
            f"sheetbench calibrate --grading {grading:g} --toml"
        )
    require_cells(table.constants, requested, f"scene '{scene.name}': ")
    springs = Springs.read(table.constants)
    if table.grading and not springs.varies and requested[:2] != (2, 2):
        raise Impossible(
            f"scene '{scene.name}': springs.grading = {table.graded:g}: unequal cells have springs of their "
            f"own, and these are the same for all: sheetbench calibrate --grading {table.graded:g} --toml"
        )
    cells = sections_of(scene, requested, table.graded)
    each = each_cell(scene.sheet, scene.material, requested, table.graded, cells if springs.varies else None)
    return replace(report("scene", each, springs), masses=table.masses, cells=cells)


def default(scene: Scene) -> Calibration:
    """The scene's own springs, or else consistent ones, of rubber those of its law, on nine masses along the
    shorter side."""
    if scene.springs is not None:
        return given(scene)
    grid = grid_of(scene.sheet)
    if scene.material.law is not None:
        return hyperelastic(scene.sheet, scene.material, grid, cells=sections_of(scene, grid))
    return consistent(sheet_at_rest(scene), scene.material, grid, cells=sections_of(scene, grid))
