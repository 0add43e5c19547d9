"""The sheet and material to calibrate for: those of a scene, of options, or of a scene changed by options."""

from __future__ import annotations

from collections.abc import Mapping
from math import prod
from typing import Any
from warnings import warn

import lumped
from comparisons.comparison.comparison import load_static
from comparisons.models.candidate import Candidate
from comparisons.models.expected_error import MOST, ExpectedError, expected_error
from comparisons.models.grading import fixed, grading_of
from comparisons.models.method import chosen
from comparisons.models.quantities import checked
from comparisons.models.registry import answer
from comparisons.report.work import Progress, silent
from sheetbench import scenes
from sheetbench.choices import AUTO, EXTRAPOLATED
from sheetbench.scenes import Material, Scene, SceneError, Sheet, Solution, require_static
from sheetbench.scenes.errors import BadInput, Implausible
from sheetbench.scenes.grading import Graded
from sheetbench.scenes.grid import Grid
from sheetbench.scenes.plausibility import material_slips, sheet_slips

DENSITY = 1000.0  # kg/m³, unless given


def sheet_and_material(
    scene: str | None, sheet: Mapping[str, float | None], material: Mapping[str, float | None]
) -> tuple[Sheet, Material]:
    """The scene's sheet and material with what is given put in its place, or those of the options alone.

    Raises BadInput for what is missing or out of bounds. Warns of what the options make implausible.
    """
    sheet_data: dict[str, Any] = {}
    material_data: dict[str, Any] = {"density": DENSITY}
    known: list[str] = []  # slips of the scene's own, which loading it has told
    if scene is not None:
        loaded = scenes.load(scene)
        known = [*sheet_slips(loaded.sheet), *material_slips(loaded.material)]
        sheet_data, material_data = loaded.sheet.model_dump(), loaded.material.model_dump()
    sheet_data |= {key: value for key, value in sheet.items() if value is not None}
    material_data |= {key: value for key, value in material.items() if value is not None}
    needed = {"young": "young", "poisson": "poisson", "thickness": "thickness", "length_x": "side"}
    missing = [f"--{option}" for key, option in needed.items() if key not in sheet_data | material_data]
    if missing:
        raise BadInput(f"missing {', '.join(missing)}; give them, or a SCENE to take them from")
    changed = checked(Sheet, sheet_data), checked(Material, material_data)
    for said in [*sheet_slips(changed[0]), *material_slips(changed[1])]:
        if said not in known:
            warn(Implausible(said), stacklevel=2)
    return changed


def method(
    scene: str | None,
    sheet: Sheet,
    material: Material,
    grid: Grid,
    asked: str | None,
    grading: str | None,
    own: Mapping[str, Any],
) -> tuple[str | None, str]:
    """The calibration of a grid, and why where it is chosen by the named scene with this sheet and material;
    own: the lattice's other settings. Raises BadInput for "auto" without a scene."""
    if asked == AUTO and scene is None:
        raise BadInput("method = auto: goes by a SCENE's edges and load; name one, or a calibration")
    if scene is None:
        return asked, ""
    changed = scenes.load(scene).model_copy(update={"sheet": sheet, "material": material})
    return chosen(changed, grid, asked, grading, **own)


def grading(
    scene: str | None,
    sheet: Sheet,
    material: Material,
    grid: Grid,
    asked: str | None,
    own: Mapping[str, Any],
) -> tuple[Graded, str]:
    """The grading of a grid, and why where it is chosen by the layers of the named scene with this sheet and
    material; own: the lattice's other settings. Raises BadInput for "auto" without a scene."""
    if asked == AUTO and scene is None:
        raise BadInput("grading = auto: goes by the layers of a SCENE; name one, or give a number")
    if scene is None:
        return fixed(asked) or 0.0, ""
    changed = scenes.load(scene).model_copy(update={"sheet": sheet, "material": material})
    value, why = grading_of(changed, grid, asked, **own)
    return value or 0.0, why


def foretold(scene: str | None, sheet: Sheet, material: Material, grid: Grid) -> list[str]:
    """What is known before solving of how far the named scene's answer on a grid will be off."""
    if scene is None:
        return []
    changed = scenes.load(scene).model_copy(update={"sheet": sheet, "material": material})
    return [said] if (said := lumped.polygons(changed, grid)) else []


def expected(
    scene: str | None,
    sheet: Sheet,
    material: Material,
    springs: lumped.Calibration,
    progress: Progress = silent,
) -> ExpectedError | None:
    """The grid error to expect of these springs in the named scene with this sheet and material, from two
    solves of it; None too where the scene has no static answer or the lattice is too large to be solved for
    a remark."""
    if scene is None or prod(springs.grid[:2]) > MOST or springs.method not in EXTRAPOLATED:
        return None
    changed = scenes.load(scene).model_copy(update={"sheet": sheet, "material": material, "springs": None})
    try:
        require_static(changed)
    except SceneError:
        return None
    lattice = Candidate(
        "lumped", {"grid": springs.grid, "calibration": springs.method, "grading": springs.grading or None}
    )

    def solve(candidate: Candidate) -> Solution:
        return answer(changed, candidate, progress=progress)

    return expected_error(changed, lattice, solve(lattice), solve)


def exported(scene: str | None, sheet: Sheet, material: Material) -> Scene:
    """What a lattice for another simulator is of: the named scene with this sheet and material, or the sheet
    clamped at one edge under its own weight."""
    from comparisons.models.training import training_scenes

    named = training(scene, sheet, material)
    return (named or training_scenes(sheet, material))[0]


def training(scene: str | None, sheet: Sheet, material: Material) -> list[Scene] | None:
    """The named scene with this sheet and material, for a fitted method to train on."""
    if scene is None:
        return None
    loaded = load_static(scene)
    changed = {"sheet": sheet.model_dump(), "material": material.model_dump(), "probes": {}}
    return [checked(Scene, {**loaded.model_dump(by_alias=True, exclude_none=True), **changed})]
