"""Specifications of models: a lattice, finite elements, or an external model.

A spec is frozen and independent of a scene; `comparisons.models.resolve` chooses settings that are None. It
is read and written as text, `NAME:key=value,key=value`, and as JSON, a name and settings. Sizes are numbers
of masses or elements along the shorter side, with nearly square cells, or in full `NxM` and `NxMxL`
(`comparisons.models.grids`).
"""

from __future__ import annotations

import json
import re
from abc import ABC, abstractmethod
from collections.abc import Collection, Iterable, Mapping
from dataclasses import dataclass, field, fields, replace
from typing import Any, ClassVar, Self

import numpy as np

from comparisons.external import plugins
from comparisons.external.program import PREFIX, written
from comparisons.models.grids import Elements as Count
from comparisons.models.grids import GridLike, parse_elements, scene_grid
from sheetbench.choices import ELEMENTS, REFERENCES
from sheetbench.errors import BadInput
from sheetbench.scenes import Scene
from sheetbench.scenes.objects.grading import Graded, Grading
from sheetbench.scenes.objects.grid import LAYERS, elements_of
from sheetbench.scenes.objects.quantities import LARGEST

GradingLike = Graded | str | None
SIZES = ("grid", "elements")
_PROGRAM = re.compile(rf"(?P<file>{PREFIX}[^:]+)(:(?P<rest>.*))?")
_FROM_FILE = re.compile(r"(?P<file>.+\.py)(:(?P<object>\w+)(?![\w=]))?(:(?P<rest>.*=.*))?")
_COUNTS = re.compile(r"\d{1,9}(x\d{1,9})+")


@dataclass(frozen=True)
class Spec(ABC):
    """Base class of specs; its fields are the settings of the model. IS_LATTICE: whether its size is a number
    of masses, and not of elements."""

    IS_LATTICE: ClassVar = False

    @property
    @abstractmethod
    def model(self) -> str:
        """The model's name."""

    @property
    def settings(self) -> dict[str, Any]:
        """Settings that differ from their defaults, as plain JSON data under the users' names."""
        values = {entry: getattr(self, entry.name) for entry in fields(self)}
        return {
            str(entry.metadata.get("key", entry.name)): _data(value)
            for entry, value in values.items()
            if type(value) is not type(entry.default) or value != entry.default
        }

    def but(self, **settings: Any) -> Self:
        """Return the spec with other values of some settings."""
        return replace(self, **settings)

    def counts(self, scene: Scene) -> list[int]:
        """Return masses (nx, ny, layers) on a scene, or elements (nx, ny) and bricks through the thickness;
        an empty list for a program."""
        return []

    def __str__(self) -> str:
        """Return the text that `parse` reads as this spec."""
        parts = ",".join(f"{key}={written(value)}" for key, value in self.settings.items())
        return f"{self.model}:{parts}" if parts else self.model

    @property
    def label(self) -> str:
        """The model and its settings in words."""
        parts = ", ".join(f"{name} {counted(value)}" for name, value in self.settings.items())
        return f"{plugins.shown_name(self.model)} {parts}"

    @property
    def size(self) -> str:
        """The grid or the elements as text, "" if open."""
        return "".join(counted(self.settings[name]) for name in SIZES if name in self.settings)

    @property
    def series(self) -> str:
        """Label of a mesh refinement series: the model's name and settings without its size."""
        settings = self.settings
        grid = settings.get("grid")
        parts = [str(settings.get("calibration", ""))]
        parts += [f"{n} layers" for n in (grid[2:] if isinstance(grid, list) else []) if n != LAYERS]
        parts += [
            name if value is True else f"{name} {counted(value)}"
            for name, value in sorted(settings.items())
            if name not in (*SIZES, "calibration") and value is not False
        ]
        return " ".join(part for part in (plugins.shown_name(self.model), *parts) if part)


@dataclass(frozen=True)
class Lattice(Spec):
    """The lumped lattice as a model.

    Parameters
    ----------
    grid : int, tuple of int or str, optional
        Masses along the shorter side, along x and y, or with layers: 9, (9, 13), "9x13x3".
    calibration : str, optional
        One of `choices.CALIBRATIONS`, or "auto".
    k : float [N/m], optional
        Stiffness of every spring, for the calibration "uniform".
    layer_distance : float [m], optional
        Distance of the layers.
    grading : float, Grading or str, optional
        Grading from 0 (equal cells) to 1, towards some edges as "0.5:x0", or "auto".
    linear : bool, optional
        One step with the flat sheet's tangent.
    branch : {"path", "buckled"}, optional
        The equilibrium on the load path, or a stable one along its buckling mode.
    masses : str, optional
        Distribution of the mass for modes, one of `choices.MASS_DISTRIBUTIONS`.
    """

    NAME: ClassVar = "lumped"
    IS_LATTICE: ClassVar = True
    grid: GridLike = None
    calibration: str | None = None
    k: float | None = None
    layer_distance: float | None = None
    grading: GradingLike = None
    linear: bool = False
    branch: str = "path"
    masses: str | None = None

    @property
    def model(self) -> str:
        return self.NAME

    def counts(self, scene: Scene) -> list[int]:
        return list(scene_grid(scene, self.grid))


@dataclass(frozen=True)
class Elements(Spec):
    """A finite-element reference as a model.

    Parameters
    ----------
    kind : {"shell", "plate", "solid"}, optional
        The reference.
    count : int or (int, int), optional
        Elements along the shorter side, or along x and y.
    law : str, optional
        Law of strain of a shell or solid, one of `choices.STRAIN_LAWS`.
    graded : bool, optional
        Elements of plate or shell finer towards the edges.
    layers : int, optional
        Bricks of a solid through the thickness.
    clamp : str, optional
        Clamp of a solid, one of `fem_reference.solid.supports.CLAMPS`.
    grading : {"edges", "uniform"}, optional
        Bricks finer towards the edges, or equal.
    branch : {"path", "buckled"}, optional
        The equilibrium on the load path, or a stable one along its buckling mode.
    """

    kind: str = "shell"
    count: Count | None = field(default=None, metadata={"key": "elements"})
    law: str | None = None
    graded: bool | None = None
    layers: int | None = None
    clamp: str | None = None
    grading: str | None = None
    branch: str | None = None

    @property
    def model(self) -> str:
        return self.kind

    @classmethod
    def given(cls, reference: Elements | str, keywords: Mapping[str, Any]) -> Elements:
        """Return a function's reference with the values of its flat keywords; the value None and the branch
        "path" change nothing."""
        spec = reference if isinstance(reference, Elements) else cls(reference)
        changes = {name: value for name, value in keywords.items() if value not in (None, "path")}
        return spec.but(**{"count" if name == "elements" else name: value for name, value in changes.items()})

    @property
    def settings(self) -> dict[str, Any]:
        return {name: value for name, value in super().settings.items() if name != "kind"}

    @property
    def options(self) -> dict[str, Any]:
        """Keywords of the reference's solver, without the number of elements."""
        return {name: v for name, v in self.settings.items() if name != "elements"}

    @property
    def elements(self) -> Count:
        """Number of elements along the shorter side, or (nx, ny)."""
        return ELEMENTS if self.count is None else self.count

    def counts(self, scene: Scene) -> list[int]:
        given = [self.elements] if isinstance(self.elements, int) else list(self.elements)
        plan = elements_of(scene.sheet, given[0]) if len(given) == 1 else given
        return [*plan, *([self.layers or 1] if self.kind == "solid" else [])]


@dataclass(frozen=True)
class External(Spec):
    """An external model.

    Parameters
    ----------
    name : str
        Name of an installed plug-in, `FILE.py:OBJECT` or `exec:PROGRAM`.
    own : mapping, optional
        The model's settings, plain JSON data.
    """

    name: str
    own: Mapping[str, Any] = field(default_factory=dict)

    @property
    def model(self) -> str:
        return self.name

    @property
    def settings(self) -> dict[str, Any]:
        return dict(self.own)

    def but(self, **settings: Any) -> External:
        return External(self.name, {**self.own, **settings})


def spec_of(model: str, settings: Mapping[str, Any]) -> Spec:
    """Return the spec of a name and JSON settings. Raises BadInput for an unknown setting."""
    if model not in (Lattice.NAME, *REFERENCES):
        return External(model, settings)
    values: dict[str, Any] = {
        key: tuple(value) if isinstance(value, list) else value for key, value in settings.items()
    }
    names = [entry.name for entry in fields(Lattice if model == Lattice.NAME else Elements)]
    if model == Lattice.NAME:
        if unknown := [key for key in values if key not in names]:
            raise BadInput(f"{model}: no setting '{unknown[0]}'; it has {', '.join(names)}")
        return Lattice(**values)
    if set(values) - {"elements", *names[1:]}:
        import fem_reference

        fem_reference.check(model, settings)
    return Elements(model, values.pop("elements", None), **values)


def lattices(
    scene: Scene, grids: Iterable[GridLike], calibrations: Iterable[str], base: Lattice | None = None
) -> list[Lattice]:
    """Return every calibration on every grid; base: other settings. Raises BadInput for an invalid grid."""
    shapes = [scene_grid(scene, grid) for grid in grids]
    return [(base or Lattice()).but(grid=n, calibration=name) for name in calibrations for n in shapes]


def references(kind: str, elements: Iterable[str]) -> list[Elements]:
    """Return a finite-element model on several meshes. Raises BadInput for an invalid number of elements."""
    return [Elements(kind, parse_elements(text, f"--{kind}")) for text in elements]


def parse(text: Spec | str) -> Spec:
    """Return the spec of `NAME`, `FILE.py`, `FILE.py:OBJECT` or `exec:PROGRAM`, followed by
    `:key=value,key=value`; a spec passes unchanged.

    Values are JSON, lists of numbers as `8x4`, or plain text. Raises BadInput.
    """
    if isinstance(text, Spec):
        return text
    if (match := _PROGRAM.fullmatch(text)) is not None:
        name, rest = match["file"], match["rest"] or ""
    elif (match := _FROM_FILE.fullmatch(text)) is not None:
        name, rest = f"{match['file']}:{match['object'] or plugins.OBJECT}", match["rest"] or ""
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
    return spec_of(name, settings)


def unique_name(name: str, taken: Collection[str]) -> str:
    """Return a name that is not taken: the given one, or one with the first free number as suffix."""
    return next(n for n in (name, *(f"{name}-{i}" for i in range(2, len(taken) + 3))) if n not in taken)


def items(text: str | None) -> list[str]:
    """Return the parts of a comma-separated list."""
    return [part.strip() for part in (text or "").split(",") if part.strip()]


def counted(value: Any) -> str:
    """Return a setting as text for labels, a size as 9×13."""
    if isinstance(value, float):
        return f"{value:g}"
    return "×".join(map(str, value)) if isinstance(value, list | tuple) else str(value)


def _value(text: str) -> Any:
    if _COUNTS.fullmatch(text):
        return [int(part) for part in text.split("x")]
    try:
        value = json.loads(text)
    except (ValueError, RecursionError):  # ValueError also for an integer of thousands of digits
        return text
    if isinstance(value, int | float) and not abs(value) <= LARGEST:
        raise BadInput(f"--model: {text[:40]}: a number of at most {LARGEST:g} is needed")
    return value


def _data(value: Any) -> Any:
    """Return a field's value as JSON data."""
    if isinstance(value, Grading):
        return str(value)
    if isinstance(value, np.ndarray | np.generic):
        return value.tolist()
    return list(value) if isinstance(value, tuple) else value
