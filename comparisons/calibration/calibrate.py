"""Springs of a sheet and material, given by a scene, by values, or by a scene with changed values: the answer
of `sheetbench calibrate`.
"""

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
    """Return a scene with other values of its sheet and material, by default the sheet of the given values,
    clamped at one edge under its own weight.

    values: by key, None if not given; option: prefix of keys in messages, as "--". Probes are dropped if the
    sheet changes. Raises BadInput for a missing or invalid value, and warns about implausible values.
    """
    given = {key: value for key, value in values.items() if value is not None}
    reported: list[str] = []  # slips of the scene itself, reported when it was loaded
    parts: dict[type[Sheet] | type[Material], dict[str, Any]] = {Sheet: {}, Material: {"density": DENSITY}}
    loaded = None if scene is None else scene_of(scene)
    if loaded is not None:
        reported = [*sheet_slips(loaded.sheet), *material_slips(loaded.material)]
        parts = {Sheet: loaded.sheet.model_dump(), Material: loaded.material.model_dump()}
    elif missing := [option + name for key, name in NEEDED.items() if key not in given]:
        raise BadInput(f"missing {', '.join(missing)}; give them, or a SCENE to take them from")
    if {"loss_factor", "relaxation"} & given.keys():
        parts[Material] |= UNDAMPED  # given damping replaces the scene's
    for kind, data in parts.items():
        data |= {key: value for key, value in given.items() if key in kind.model_fields}
    sheet, material = checked(Sheet, parts[Sheet], option), checked(Material, parts[Material], option)
    for slip in [*sheet_slips(sheet), *material_slips(material)]:
        if slip not in reported:
            warn(Implausible(slip), stacklevel=3)
    if loaded is None:
        return training_scenes(sheet, material)[0]
    probes = loaded.probes if sheet == loaded.sheet else {}
    return loaded.replace(sheet=sheet, material=material, probes=probes)


def calibrate(scene: Scene, lattice: Lattice, named: bool = True) -> lumped.Calibration:
    """Return the springs of a lattice for a scene's sheet and material, independent of the scene's [springs].

    named: whether the user named the scene: a fitted method then trains on it, and "auto" chooses by it.
    Raises BadInput for an impossible lattice, and for a fit that needs more memory than is free.
    """
    for name, value in (("calibration", lattice.calibration), ("grading", lattice.grading)):
        if value == AUTO and not named:
            raise BadInput(f"{name} = auto: needs the edges and load of a SCENE; give one, or another {name}")
    model = resolve(scene, lattice, "springs", scene_springs=False)
    springs = model.calibrated([scene] if named else None)
    return replace(springs, remarks=(*choice_notes(model.settings), *springs.remarks))


def expected(scene: Scene, springs: lumped.Calibration) -> ExpectedError | None:
    """Return the expected grid error of springs in a scene, from two solves, if there is an estimate, the
    scene has a static answer, and the lattice has at most MOST masses."""
    if prod(springs.grid[:2]) > MOST or springs.method not in EXTRAPOLATED:
        return None
    try:
        require_static(scene)
    except SceneError:
        return None
    lattice = Lattice(springs.grid, springs.method, grading=springs.grading or None)

    def answer(spec: Lattice) -> Solution:
        return solve(resolve(scene, spec))

    estimate = expected_error(scene, lattice, answer(lattice), answer)
    return estimate if isinstance(estimate, ExpectedError) else None


@dataclass(frozen=True, repr=False)
class SheetCalibration(Calibration):
    """Springs for a scene's sheet; calibration: with its report; expected: their expected grid error in the
    scene, if known; lattice: files for another code, and notes on features missing there."""

    calibration: Calibration = field(kw_only=True, repr=False)
    scene: Scene = field(kw_only=True)
    expected: ExpectedError | None = None
    lattice: tuple[dict[str, Write], list[str]] = field(default=({}, []), compare=False)

    def heading(self) -> tuple[str, str, str]:
        return (*self.calibration.heading()[:2], sheet_in_words(self.scene.sheet, self.scene.material))

    def document(self) -> dict[str, Any]:
        expected = {} if self.expected is None else {"expected_error": self.expected.as_dict()}
        return self.calibration.document() | expected | damping.document(self.scene.material)

    def tables(self) -> tuple[Table, ...]:
        return (*self.calibration.tables(), *damping.tables(self.scene.material))

    def notes(self) -> tuple[str, ...]:
        expected = () if self.expected is None else (f"in this scene: {self.expected}",)
        return (*self.calibration.notes(), *expected, *damping.notes(self.scene.material), *self.lattice[1])

    def files(self) -> dict[str, Write]:
        return {"springs.toml": partial(write_text, text=to_toml(self)), **self.lattice[0]}


def to_toml(springs: Calibration) -> str:
    """Return a [springs] table with the springs and their grid, in all digits, for use in a scene."""
    document = springs.document()
    grading = as_settings(springs.grading) if springs.grading else {}
    keys = {"grid": document["grid"], "masses": document["masses"], **grading, **document["springs"]}
    return dumps({"springs": {**keys, "layer_distance": document["layer_distance"]}})
