"""The answer of `sheetbench calibrate`: springs for a sheet, and the [springs] table of a scene."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from typing import Any

from comparisons.calibration import damping
from comparisons.calibration.damping import ModeDamping
from comparisons.models.expected_error import ExpectedError
from lumped import Calibration
from sheetbench.answers.answer import Answer
from sheetbench.answers.files import write_text
from sheetbench.answers.report import Write
from sheetbench.answers.table import Table
from sheetbench.scenes import Scene
from sheetbench.scenes.grading import as_settings
from sheetbench.scenes.toml import dumps
from sheetbench.scenes.words import sheet_in_words


@dataclass(frozen=True, repr=False)
class SheetCalibration(Answer):
    """Springs for a scene's sheet; expected: the error of their grid in the scene, where it is known; modes:
    the damping of the lowest ones."""

    springs: Calibration
    scene: Scene
    expected: ExpectedError | None = None
    modes: tuple[ModeDamping, ...] = ()

    file_name = Calibration.file_name
    page_name = Calibration.page_name

    def heading(self) -> tuple[str, str, str]:
        return (*self.springs.heading()[:2], sheet_in_words(self.scene.sheet, self.scene.material))

    def document(self) -> dict[str, Any]:
        found = self.springs.document()
        if self.expected is not None:
            found["expected_error"] = self.expected.as_dict()
        return found | damping.document(self.scene.material, self.modes)

    def tables(self) -> tuple[Table, ...]:
        return (*self.springs.tables(), *damping.tables(self.scene.material, self.modes))

    def notes(self) -> tuple[str, ...]:
        expected = () if self.expected is None else (f"in this scene: {self.expected}",)
        return (*self.springs.notes(), *expected)

    def files(self) -> dict[str, Write]:
        return {"springs.toml": partial(write_text, text=to_toml(self.springs))}

    def choices(self) -> dict[str, Any]:
        return dict(self.springs.choices())


def to_toml(springs: Calibration) -> str:
    """Return the [springs] table for pasting into a scene, with the lattice that it is for; all digits."""
    found = springs.document()
    grading = as_settings(springs.grading) if springs.grading else {}
    keys = {"grid": found["grid"], "masses": found["masses"], **grading, **found["springs"]}
    return dumps({"springs": {**keys, "layer_distance": found["layer_distance"]}})
