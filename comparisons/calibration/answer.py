"""The answer of `sheetbench calibrate`: springs for a sheet, and the [springs] table of a scene."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import partial
from typing import Any

from comparisons.calibration import damping
from comparisons.calibration.damping import ModeDamping
from comparisons.models.expected_error import ExpectedError
from lumped import Calibration
from sheetbench.answers.files import write_text
from sheetbench.answers.report import Write
from sheetbench.answers.table import Table
from sheetbench.scenes import Scene
from sheetbench.scenes.language.toml import dumps
from sheetbench.scenes.meaning.words import sheet_in_words
from sheetbench.scenes.objects.grading import as_settings


@dataclass(frozen=True, repr=False)
class SheetCalibration(Calibration):
    """Springs for a scene's sheet, as they were found; expected: the error of their grid in the scene, where
    it is known; modes: the damping of the lowest ones; lattice: files for another code, and what is not in
    them."""

    found: Calibration | None = None
    scene: Scene | None = None
    expected: ExpectedError | None = None
    modes: tuple[ModeDamping, ...] = ()
    lattice: tuple[dict[str, Write], list[str]] = field(default=({}, []), compare=False)

    @property
    def parts(self) -> tuple[Calibration, Scene]:
        """The springs as they were found, and the scene that they are of."""
        assert self.found is not None and self.scene is not None
        return self.found, self.scene

    def heading(self) -> tuple[str, str, str]:
        found, scene = self.parts
        return (*found.heading()[:2], sheet_in_words(scene.sheet, scene.material))

    def document(self) -> dict[str, Any]:
        springs, scene = self.parts
        found = springs.document()
        if self.expected is not None:
            found["expected_error"] = self.expected.as_dict()
        return found | damping.document(scene.material, self.modes)

    def tables(self) -> tuple[Table, ...]:
        found, scene = self.parts
        return (*found.tables(), *damping.tables(scene.material, self.modes))

    def notes(self) -> tuple[str, ...]:
        expected = () if self.expected is None else (f"in this scene: {self.expected}",)
        return (*self.parts[0].notes(), *expected, *self.lattice[1])

    def files(self) -> dict[str, Write]:
        return {"springs.toml": partial(write_text, text=to_toml(self)), **self.lattice[0]}

    def choices(self) -> dict[str, Any]:
        return dict(self.parts[0].choices())


def to_toml(springs: Calibration) -> str:
    """Return the [springs] table for pasting into a scene, with the lattice that it is for; all digits."""
    found = springs.document()
    grading = as_settings(springs.grading) if springs.grading else {}
    keys = {"grid": found["grid"], "masses": found["masses"], **grading, **found["springs"]}
    return dumps({"springs": {**keys, "layer_distance": found["layer_distance"]}})
