"""The rows of a trade-off: which models with which settings, as the user lists them.

Sizes are numbers of masses (lumped) or of elements (plate, shell, solid) along the shorter side of the sheet,
with cells as square as that allows; `NxM` and `NxMxL` say it in full.
"""

from __future__ import annotations

import json
from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import Any

from comparisons.models.grids import parse_grid
from sheetbench.scenes import Sheet
from sheetbench.scenes.errors import BadInput
from sheetbench.scenes.grid import LAYERS


@dataclass(frozen=True)
class Candidate:
    """A model and its settings (plain JSON data)."""

    model: str
    settings: dict[str, Any] = field(default_factory=dict)

    def but(self, **settings: Any) -> Candidate:
        """The same model with other values of some settings."""
        return Candidate(self.model, {**self.settings, **settings})

    @property
    def series(self) -> str:
        """What stays the same as the grid is refined: the model's name, calibration and other settings."""
        return series(self.model, self.settings)


def series(model: str, settings: dict[str, Any]) -> str:
    """The name of the family of rows that differ in their grids only."""
    grid = settings.get("grid")
    layers = grid[2:] if isinstance(grid, list | tuple) else []
    said = [str(settings.get("calibration", ""))]
    said += [f"{n} layers" for n in layers if n != LAYERS]
    said += [
        name if value is True else f"{name} {value}"
        for name, value in sorted(settings.items())
        if name not in ("grid", "elements", "calibration") and value is not False
    ]
    return " ".join(part for part in (model, *said) if part)


def lattices(sheet: Sheet, grids: Iterable[str], calibrations: Iterable[str]) -> list[Candidate]:
    """Every calibration on every grid, coarse grids first. Raises BadInput for what is not a grid."""
    shapes = [parse_grid(sheet, text) for text in grids]
    return [
        Candidate("lumped", {"grid": list(shape), "calibration": name})
        for name in calibrations
        for shape in shapes
    ]


def references(model: str, elements: Iterable[str]) -> list[Candidate]:
    """A finite-element model on several meshes. Raises BadInput for what is not a number of elements."""
    found = []
    for text in elements:
        if not text.isdigit() or int(text) < 1:
            raise BadInput(f"--{model} = '{text}': not a number of elements along the shorter side")
        found.append(Candidate(model, {"elements": int(text)}))
    return found


def parse_model(text: str) -> Candidate:
    """The candidate of `NAME` or `NAME:key=value,key=value`, values as in JSON or else plain text."""
    name, _, rest = text.partition(":")
    settings: dict[str, Any] = {}
    for part in filter(None, rest.split(",")):
        key, equals, value = part.partition("=")
        if not equals:
            raise BadInput(f"--model = '{text}': write NAME:key=value,key=value")
        try:
            settings[key] = json.loads(value)
        except json.JSONDecodeError:
            settings[key] = value
    return Candidate(name, settings)


def items(text: str | None) -> list[str]:
    """The parts of a list as people write it: 5,9,17."""
    return [part.strip() for part in (text or "").split(",") if part.strip()]
