"""The rows of a trade-off: which models with which settings, as the user lists them.

Sizes are numbers of masses (lumped) or of elements (plate, shell, solid) along the shorter side of the sheet,
with cells as square as that allows; `NxM` and `NxMxL` say it in full (`comparisons.models.grids`).
"""

from __future__ import annotations

import json
import re
from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import Any

from comparisons.external.program import PREFIX
from comparisons.models import plugins
from comparisons.models.grids import GridLike, parse_elements, scene_grid
from sheetbench.choices import AUTO, EXTRAPOLATED
from sheetbench.errors import BadInput
from sheetbench.scenes import Scene
from sheetbench.scenes.grid import LAYERS
from sheetbench.scenes.quantities import LARGEST

SIZES = ("grid", "coarser", "elements")
_PROGRAM = re.compile(rf"(?P<file>{PREFIX}[^:]+)(:(?P<rest>.*))?")
_FROM_FILE = re.compile(r"(?P<file>.+\.py)(:(?P<object>\w+)(?![\w=]))?(:(?P<rest>.*=.*))?")
_COUNTS = re.compile(r"\d{1,9}(x\d{1,9})+")


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
        if name not in (*SIZES, "calibration") and value is not False
    ]
    return " ".join(part for part in (model, *said) if part)


def lattices(scene: Scene, grids: Iterable[GridLike], calibrations: Iterable[str]) -> list[Candidate]:
    """Every calibration on every grid, in their order. Raises BadInput for what is not a grid."""
    shapes = [scene_grid(scene, grid) for grid in grids]
    return [
        Candidate("lumped", {"grid": list(shape), "calibration": name})
        for name in calibrations
        for shape in shapes
    ]


def pairs(scene: Scene, grids: Iterable[str], calibrations: Iterable[str]) -> list[Candidate]:
    """Every calibration that is extrapolated on every pair of grids, 5:9. Raises BadInput for other text."""
    shapes = []
    for text in grids:
        coarser, colon, finer = text.partition(":")
        if not colon:
            raise BadInput(f"--lumped-pair = '{text}': two grids are written 5:9, the coarser first")
        shapes.append({"grid": list(scene_grid(scene, finer)), "coarser": list(scene_grid(scene, coarser))})
    named = [name for name in calibrations if name in (AUTO, *EXTRAPOLATED)]
    if shapes and not named:
        raise BadInput(f"--lumped-pair: of calibrations there is none of {', '.join(EXTRAPOLATED)}")
    return [Candidate("lumped-pair", {**shape, "calibration": name}) for name in named for shape in shapes]


def references(model: str, elements: Iterable[str]) -> list[Candidate]:
    """A finite-element model on several meshes. Raises BadInput for what is not a number of elements."""
    counts = [parse_elements(text, f"--{model}") for text in elements]
    return [Candidate(model, {"elements": n if isinstance(n, int) else list(n)}) for n in counts]


def parse_model(text: str) -> Candidate:
    """The candidate of `NAME`, `FILE.py`, `FILE.py:OBJECT` or `exec:PROGRAM`, and `:key=value,key=value`.

    Values are as in JSON, `8x4` is a list of numbers, anything else plain text. Raises BadInput.
    """
    if (found := _PROGRAM.fullmatch(text)) is not None:
        name, rest = found["file"], found["rest"] or ""
    elif (found := _FROM_FILE.fullmatch(text)) is not None:
        name, rest = f"{found['file']}:{found['object'] or plugins.OBJECT}", found["rest"] or ""
    else:
        name, _, rest = text.partition(":")
    settings: dict[str, Any] = {}
    for part in filter(None, rest.split(",")):
        key, equals, value = part.partition("=")
        if not equals:
            raise BadInput(
                f"--model = '{text}': write NAME:key=value,key=value, FILE.py:CLASS:key=value or "
                "exec:PROGRAM:key=value"
            )
        settings[key] = _value(value)
    return Candidate(name, settings)


def written(candidate: Candidate) -> str:
    """The text that `parse_model` reads as this candidate."""
    settings = [
        f"{key}={'x'.join(map(str, value)) if isinstance(value, list | tuple) else _plain(value)}"
        for key, value in candidate.settings.items()
    ]
    return candidate.model + (f":{','.join(settings)}" if settings else "")


def _value(text: str) -> Any:
    if _COUNTS.fullmatch(text):
        return [int(part) for part in text.split("x")]
    try:
        value = json.loads(text)
    except (ValueError, RecursionError):  # the former of an integer of thousands of digits too
        return text
    if isinstance(value, int | float) and not abs(value) <= LARGEST:
        raise BadInput(f"--model: {text[:40]}: a number of at most {LARGEST:g} is needed")
    return value


def _plain(value: Any) -> str:
    return value if isinstance(value, str) else json.dumps(value)


def items(text: str | None) -> list[str]:
    """The parts of a list as people write it: 5,9,17."""
    return [part.strip() for part in (text or "").split(",") if part.strip()]
