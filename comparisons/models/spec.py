"""Models as users name them: a lattice, finite elements, or a program from outside.

A spec is frozen, says nothing of a scene, and leaves open (None) what `comparisons.models.resolve` is to
choose. It reads and writes itself as text, `NAME:key=value,key=value`, and as JSON, a name and settings.
Sizes are numbers of masses or of elements along the shorter side, with cells as square as that allows; `NxM`
and `NxMxL` say it in full (`comparisons.models.grids`).
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
    """What all specs have in common; its fields are the settings of the model. MASSES: whether its size is a
    number of masses, and not of elements."""

    MASSES: ClassVar = False

    @property
    @abstractmethod
    def model(self) -> str:
        """The model's name."""

    @property
    def settings(self) -> dict[str, Any]:
        """What is not left open, as plain JSON data by the names that users write."""
        given = {one: getattr(self, one.name) for one in fields(self)}
        return {
            str(one.metadata.get("key", one.name)): _data(value)
            for one, value in given.items()
            if type(value) is not type(one.default) or value != one.default
        }

    def but(self, **settings: Any) -> Self:
        """Return the same model with other values of some settings."""
        return replace(self, **settings)

    def counts(self, scene: Scene) -> list[int]:
        """Return masses (nx, ny, layers) on a scene, or elements (nx, ny) and bricks through the thickness;
        none of a program."""
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
        """The grid or the elements; nothing where they are left open."""
        return "".join(counted(self.settings[name]) for name in SIZES if name in self.settings)

    @property
    def series(self) -> str:
        """What stays the same as the grid is refined: the model's name, calibration and other settings."""
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
        From 0 (equal cells) to 1, towards some edges as "0.5:x0", or "auto".
    linear : bool, optional
        One step with the flat sheet's tangent.
    branch : {"path", "buckled"}, optional
        The equilibrium on the load path, or a stable one along its buckling mode.
    masses : str, optional
        Distribution of the mass for modes, one of `choices.MASSES`.
    """

    NAME: ClassVar = "lumped"
    MASSES: ClassVar = True
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
        """Return the reference that a function is called with, changed by what flat keywords say; "path" is
        the usual branch."""
        spec = reference if isinstance(reference, Elements) else cls(reference)
        known = {name: value for name, value in keywords.items() if value not in (None, "path")}
        return spec.but(**{"count" if name == "elements" else name: value for name, value in known.items()})

    @property
    def settings(self) -> dict[str, Any]:
        return {name: value for name, value in super().settings.items() if name != "kind"}

    @property
    def options(self) -> dict[str, Any]:
        """What the reference's own solver takes, beside the number of elements."""
        return {name: v for name, v in self.settings.items() if name != "elements"}

    @property
    def elements(self) -> Count:
        """Along the shorter side, or (nx, ny)."""
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
        """Return the same model with other values of some settings."""
        return External(self.name, {**self.own, **settings})


def spec_of(model: str, settings: Mapping[str, Any]) -> Spec:
    """Return the spec of a name and settings as JSON has them. Raises BadInput for a setting that a lattice
    or a reference does not have."""
    if model not in (Lattice.NAME, *REFERENCES):
        return External(model, settings)
    own: dict[str, Any] = {
        key: tuple(value) if isinstance(value, list) else value for key, value in settings.items()
    }
    names = [one.name for one in fields(Lattice if model == Lattice.NAME else Elements)]
    if model == Lattice.NAME:
        if unknown := [key for key in own if key not in names]:
            raise BadInput(f"{model}: no setting '{unknown[0]}'; it has {', '.join(names)}")
        return Lattice(**own)
    if set(own) - {"elements", *names[1:]}:
        import fem_reference

        fem_reference.check(model, settings)
    return Elements(model, own.pop("elements", None), **own)


def lattices(
    scene: Scene, grids: Iterable[GridLike], calibrations: Iterable[str], usual: Lattice | None = None
) -> list[Lattice]:
    """Return every calibration on every grid, in their order; usual: what else they have. Raises BadInput for
    what is not a grid."""
    shapes = [scene_grid(scene, grid) for grid in grids]
    return [(usual or Lattice()).but(grid=n, calibration=name) for name in calibrations for n in shapes]


def references(kind: str, elements: Iterable[str]) -> list[Elements]:
    """Return a finite-element model on several meshes. Raises BadInput for what is not a number of
    elements."""
    return [Elements(kind, parse_elements(text, f"--{kind}")) for text in elements]


def parse(text: Spec | str) -> Spec:
    """Return a spec as it is, or that of `NAME`, `FILE.py`, `FILE.py:OBJECT` or `exec:PROGRAM`, and
    `:key=value,key=value`.

    Values are as in JSON, `8x4` is a list of numbers, anything else plain text. Raises BadInput.
    """
    if isinstance(text, Spec):
        return text
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
    return spec_of(name, settings)


def unlike(name: str, taken: Collection[str]) -> str:
    """Return the name, or with the first number after it that makes it a new one."""
    return next(n for n in (name, *(f"{name}-{i}" for i in range(2, len(taken) + 3))) if n not in taken)


def items(text: str | None) -> list[str]:
    """Return the parts of a list as people write it: 5,9,17."""
    return [part.strip() for part in (text or "").split(",") if part.strip()]


def counted(value: Any) -> str:
    """Return a setting as people write it, a size 9×13."""
    if isinstance(value, float):
        return f"{value:g}"
    return "×".join(map(str, value)) if isinstance(value, list | tuple) else str(value)


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


def _data(value: Any) -> Any:
    """Return a field's value as JSON has it."""
    if isinstance(value, Grading):
        return str(value)
    if isinstance(value, np.ndarray | np.generic):
        return value.tolist()
    return list(value) if isinstance(value, tuple) else value
