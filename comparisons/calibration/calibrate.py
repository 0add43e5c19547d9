"""The springs of a sheet and material: those of a scene, of values alone, or of a scene changed by values;
and the answer of `sheetbench calibrate`.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import partial
from math import prod
from typing import Any
from warnings import warn

import lumped
from comparisons.calibration import damping
from comparisons.models.expected_error import MOST, ExpectedError, expected_error
from comparisons.models.grading import choice_notes
from comparisons.models.quantities import checked
from comparisons.models.resolve import resolve
from comparisons.models.solve import solve
from comparisons.models.spec import Lattice
from comparisons.models.training import training_scenes
from lumped import Calibration
from sheetbench.answers.files import write_text
from sheetbench.answers.report import Write
from sheetbench.answers.solution import Solution
from sheetbench.answers.table import Table
from sheetbench.choices import AUTO, EXTRAPOLATED
from sheetbench.errors import BadInput, Implausible
from sheetbench.scenes import AnyScene, Material, Scene, SceneError, Sheet, require_static, scene_of
from sheetbench.scenes.language.toml import dumps
from sheetbench.scenes.meaning.plausibility import material_slips, sheet_slips
from sheetbench.scenes.meaning.words import sheet_in_words
from sheetbench.scenes.objects.grading import as_settings
from sheetbench.scenes.objects.material import UNDAMPED

DENSITY = 1000.0  # kg/m³, unless given
NEEDED = {"young": "young", "poisson": "poisson", "thickness": "thickness", "length_x": "side"}


def subject(scene: AnyScene | None, values: Mapping[str, Any], option: str = "") -> Scene:
    """Return the scene with these keys of its sheet and material in place of its own; without a scene the
    sheet that they describe, clamped at one edge under its own weight.

    values: None where a key is not given; option: what stands before a key where the user reads it, as "--".
    Probes go where the sheet is another. Raises BadInput for what is missing or out of bounds, and warns of
    what the values make implausible.
    """
    given = {key: value for key, value in values.items() if value is not None}
    known: list[str] = []  # slips of the scene's own, which loading it has warned of
    parts: dict[type[Sheet] | type[Material], dict[str, Any]] = {Sheet: {}, Material: {"density": DENSITY}}
    loaded = None if scene is None else scene_of(scene)
    if loaded is not None:
        known = [*sheet_slips(loaded.sheet), *material_slips(loaded.material)]
        parts = {Sheet: loaded.sheet.model_dump(), Material: loaded.material.model_dump()}
    elif missing := [option + name for key, name in NEEDED.items() if key not in given]:
        raise BadInput(f"missing {', '.join(missing)}; give them, or a SCENE to take them from")
    if {"loss_factor", "relaxation"} & given.keys():
        parts[Material] |= UNDAMPED  # what is given takes the place of the scene's own
    for kind, data in parts.items():
        data |= {key: value for key, value in given.items() if key in kind.model_fields}
    sheet, material = checked(Sheet, parts[Sheet], option), checked(Material, parts[Material], option)
    for slip in [*sheet_slips(sheet), *material_slips(material)]:
        if slip not in known:
            warn(Implausible(slip), stacklevel=3)
    if loaded is None:
        return training_scenes(sheet, material)[0]
    probes = loaded.probes if sheet == loaded.sheet else {}
    return loaded.replace(sheet=sheet, material=material, probes=probes)


def calibrate(scene: Scene, lattice: Lattice, named: bool = True) -> lumped.Calibration:
    """Return the springs of a lattice for a scene's sheet and material, whatever [springs] the scene has.

    named: whether the user named the scene: a fitted method trains on it, "auto" goes by it, and what is
    known before solving of how far its answer will be off is among the notes. Raises BadInput for a lattice
    that cannot be had, and for a fit that takes more memory than there is.
    """
    for name, what in (("calibration", lattice.calibration), ("grading", lattice.grading)):
        if what == AUTO and not named:
            raise BadInput(
                f"{name} = auto: goes by the edges and load of a SCENE; name one, or another {name}"
            )
    found = resolve(scene, lattice, "springs", own=False)
    springs = found.calibrated([scene] if named else None)
    return replace(springs, remarks=(*choice_notes(found.settings), *springs.remarks))


def expected(scene: Scene, springs: lumped.Calibration) -> ExpectedError | None:
    """Return the grid error to expect of these springs in a scene, from two solves of it; None too where the
    scene has no static answer or the lattice is too large to be solved for a remark."""
    if prod(springs.grid[:2]) > MOST or springs.method not in EXTRAPOLATED:
        return None
    try:
        require_static(scene)
    except SceneError:
        return None
    lattice = Lattice(springs.grid, springs.method, grading=springs.grading or None)

    def answer(spec: Lattice) -> Solution:
        return solve(resolve(scene, spec))

    found = expected_error(scene, lattice, answer(lattice), answer)
    return found if isinstance(found, ExpectedError) else None


@dataclass(frozen=True, repr=False)
class SheetCalibration(Calibration):
    """Springs for a scene's sheet; found: the same with what data tell of them; expected: the error of their
    grid in the scene, where it is known; lattice: files for another code, and what is not in them."""

    found: Calibration = field(kw_only=True, repr=False)
    scene: Scene = field(kw_only=True)
    expected: ExpectedError | None = None
    lattice: tuple[dict[str, Write], list[str]] = field(default=({}, []), compare=False)

    def heading(self) -> tuple[str, str, str]:
        return (*self.found.heading()[:2], sheet_in_words(self.scene.sheet, self.scene.material))

    def document(self) -> dict[str, Any]:
        known = {} if self.expected is None else {"expected_error": self.expected.as_dict()}
        return self.found.document() | known | damping.document(self.scene.material)

    def tables(self) -> tuple[Table, ...]:
        return (*self.found.tables(), *damping.tables(self.scene.material))

    def notes(self) -> tuple[str, ...]:
        expected = () if self.expected is None else (f"in this scene: {self.expected}",)
        return (*self.found.notes(), *expected, *damping.notes(self.scene.material), *self.lattice[1])

    def files(self) -> dict[str, Write]:
        return {"springs.toml": partial(write_text, text=to_toml(self)), **self.lattice[0]}


def to_toml(springs: Calibration) -> str:
    """Return the [springs] table for pasting into a scene, with the lattice that it is for; all digits."""
    found = springs.document()
    grading = as_settings(springs.grading) if springs.grading else {}
    keys = {"grid": found["grid"], "masses": found["masses"], **grading, **found["springs"]}
    return dumps({"springs": {**keys, "layer_distance": found["layer_distance"]}})
