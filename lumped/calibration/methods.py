"""All calibration methods by name and the one door to them; springs that a scene brings itself."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from functools import partial
from typing import Any

from lumped.calibration.calibration import Calibration
from lumped.calibration.cell_by_cell import each_cell
from lumped.calibration.central import central
from lumped.calibration.consistent import consistent
from lumped.calibration.least_squares import fit_moduli
from lumped.calibration.report import report
from lumped.calibration.rubber import hyperelastic
from lumped.calibration.textbook import axial, cauchy, lloyd, uniform, van_gelder
from lumped.sections import CellSection, sections_of
from lumped.spring_constants import Springs, require_cells
from sheetbench import choices
from sheetbench.errors import BadInput, Impossible, require_choice
from sheetbench.numerics.threads import one_blas_thread
from sheetbench.scenes import Cells, Material, Scene, Sheet, SpringTable
from sheetbench.scenes.meaning.natural_state import sheet_at_rest
from sheetbench.scenes.objects.grading import Graded
from sheetbench.scenes.objects.grid import MASSES, grid_of
from sheetbench.scenes.objects.quantities import require_positive


@dataclass(frozen=True)
class CalibrationMethod(choices.Method):
    """A method as `sheetbench.choices` describes it, and what carries it out:
    make(sheet, material, grid, **options)."""

    make: Callable[..., Calibration] = field(kw_only=True)


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
CALIBRATIONS = {
    name: CalibrationMethod(**vars(method), make=MAKERS[name])
    for name, method in choices.CALIBRATIONS.items()
}
UNITS = {"k": "N/m", "layer_distance": "m"}


def calibrate(
    sheet: Sheet,
    material: Material,
    grid: int | Sequence[int] = MASSES,
    method: str = choices.CALIBRATION,
    k: float | None = None,
    layer_distance: float | None = None,
    grading: Graded = 0.0,
    cells: Cells | CellSection | None = None,
) -> Calibration:
    """Springs of a grid for a sheet of this material, by a named method.

    grid: masses along the shorter side, (nx, ny) or (nx, ny, layers), see `sheetbench.scenes.objects.grid`.
    k [N/m] and layer_distance [m] are for the methods that take them. grading: how much smaller the cells are
    at the edges, 0 to 1 (`lumped.grid_lines`). cells: what each is made of, where they differ. Raises
    BadInput for an unknown method, a grid too small, an option that the method does not take or that is out
    of its bounds.

    >>> import lumped
    >>> from sheetbench.scenes import load
    >>> scene = load("two-edges-clamped")
    >>> springs = lumped.calibrate(scene.sheet, scene.material, grid=9)
    >>> springs.method, springs.grid, round(springs.layer_distance, 6)
    ('consistent', (9, 9, 2), 0.003706)
    """
    require_choice("calibration", method, CALIBRATIONS)
    chosen = CALIBRATIONS[method]
    requested = {"k": k, "layer_distance": layer_distance, "grading": grading or None, "cells": cells}
    options: dict[str, Any] = {name: value for name, value in requested.items() if value is not None}
    for name, value in options.items():
        if name not in chosen.takes:
            others = " and ".join(f"'{other}'" for other, one in CALIBRATIONS.items() if name in one.takes)
            unit = f" {UNITS[name]}" if name in UNITS else ""
            given = "" if name == "cells" else f"{name} = {value:g}{unit}: "
            raise BadInput(f"{given}calibration '{method}' takes no {name}; {name} goes with {others}")
        if name in UNITS:
            require_positive(name, value, UNITS[name])
    with one_blas_thread():
        return chosen.make(sheet, material, grid_of(sheet, grid), **options)


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
