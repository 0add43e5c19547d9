"""The answer of `sheetbench calibrate`: springs for a sheet, and the [springs] table of a scene."""

from __future__ import annotations

from dataclasses import dataclass, fields
from functools import cached_property, partial
from typing import Any

from comparisons.calibration import damping
from comparisons.calibration.damping import ModeDamping
from comparisons.codes.lattice import lattice_files
from comparisons.models.expected_error import ExpectedError
from lumped import Calibration, FittedCalibration
from sheetbench.answers.files import write_text
from sheetbench.answers.report import Write
from sheetbench.answers.table import Table
from sheetbench.scenes import Scene
from sheetbench.scenes.grading import as_settings
from sheetbench.scenes.toml import dumps
from sheetbench.scenes.words import sheet_in_words


@dataclass(frozen=True, repr=False)
class SheetCalibration(Calibration):
    """Springs for a scene's sheet; expected: the error of their grid in the scene, where it is known; modes:
    the damping of the lowest ones; code: another one that the lattice is written for."""

    scene: Scene | None = None
    expected: ExpectedError | None = None
    modes: tuple[ModeDamping, ...] = ()
    code: str | None = None

    @classmethod
    def of(cls, springs: Calibration, scene: Scene, **more: Any) -> SheetCalibration:
        """Return springs as those of a scene."""
        kind = FittedSheetCalibration if isinstance(springs, FittedCalibration) else cls
        return kind(**{one.name: getattr(springs, one.name) for one in fields(springs)}, scene=scene, **more)

    @property
    def subject(self) -> Scene:
        """The scene that they are of."""
        assert self.scene is not None
        return self.scene

    def heading(self) -> tuple[str, str, str]:
        return (*super().heading()[:2], sheet_in_words(self.subject.sheet, self.subject.material))

    def document(self) -> dict[str, Any]:
        found = super().document()
        if self.expected is not None:
            found["expected_error"] = self.expected.as_dict()
        return found | damping.document(self.subject.material, self.modes)

    def tables(self) -> tuple[Table, ...]:
        return (*super().tables(), *damping.tables(self.subject.material, self.modes))

    def notes(self) -> tuple[str, ...]:
        expected = () if self.expected is None else (f"in this scene: {self.expected}",)
        return (*super().notes(), *expected, *(self._for_code[1] if self.code else ()))

    def files(self) -> dict[str, Write]:
        own = {"springs.toml": partial(write_text, text=to_toml(self))}
        return {**own, **(self._for_code[0] if self.code else {})}

    @cached_property
    def _for_code(self) -> tuple[dict[str, Write], list[str]]:
        return lattice_files(self.subject, self, self.code)


@dataclass(frozen=True, repr=False)
class FittedSheetCalibration(SheetCalibration, FittedCalibration):
    """The same of springs that were fitted to data."""


def to_toml(springs: Calibration) -> str:
    """Return the [springs] table for pasting into a scene, with the lattice that it is for; all digits."""
    found = springs.document()
    grading = as_settings(springs.grading) if springs.grading else {}
    keys = {"grid": found["grid"], "masses": found["masses"], **grading, **found["springs"]}
    return dumps({"springs": {**keys, "layer_distance": found["layer_distance"]}})
