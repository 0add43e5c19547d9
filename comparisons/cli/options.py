"""What verbs take: options from a function's signature and docstring, and groups that several verbs share.

An option has the name, type and default of a parameter; what it is for stands in the docstring, as

    Args:
        elements (N): Elements along the shorter side; default: {ELEMENTS}.

In brackets stands what a value is called, and `argument` where no option's name goes before it. Words in
braces are values of the module or of `sheetbench.choices`, of a table its names. A command whose parameter is
of the type `LatticeOptions` has --grid, --calibration, --k, --layer-distance and --grading; with
`SpringOptions` the last three, beside lists of grids and calibrations of its own. `SheetOptions` are --young,
--poisson, --thickness, --density and --side; `CampaignOptions` those of many runs. Those of the output stand
in `comparisons.cli.output`. What several have in common is described here.

Args:
    scene (SCENE, argument): Catalogue name or path to a TOML file.
    grid (GRID): Masses of the lattice: 9, along the shorter side with near-square cells; 9x13, along x and y;
        9x13x3, with layers, else 2. Default: 9.
    calibration (NAME): How k is found from E, ν and h: {CALIBRATIONS}; auto: the consistent one that suits
        the scene. Default: {CALIBRATION}; auto with --grading auto.
    k (N/M): Stiffness of every spring; implies uniform.
    layer_distance (M): Distance of the lattice's layers.
    grading (G): How much finer the lattice is at its edges, 0 (cells of one size) to 1; 0.5:x0 or 0.5:x0,x1:
        at these edges only; auto: by the scene's boundary layers. Default: 0.
    elements (N): The reference's elements along the shorter side, or 8x4 along x and y.
    law (NAME): Law of strain of a shell or solid: {STRAIN_LAWS}. Default: the material's own, else
        {STRAIN_LAW}.
    model (MODELS): Further models: a plug-in's NAME, FILE.py:CLASS or exec:PROGRAM of your own, or lumped,
        plate, shell, solid; settings after it, as NAME:grid=9x5,k=550.
    export (DIR): Write the lattice for another simulator: masses, springs, supports, loads, values to check
        by.
    large: Solve models that need more memory than is free, instead of refusing them.
    json: Print one JSON document instead of tables.
    quiet: No progress and no notes on standard error; results, warnings and errors stay.
    verbose: All notes on the answer, not only the first three.
"""

from __future__ import annotations

import re
import sys
from dataclasses import dataclass, fields, replace
from inspect import Parameter, cleandoc, getmodule
from string import Formatter
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, get_type_hints

from sheetbench import choices

if TYPE_CHECKING:
    from comparisons.models.spec import Lattice

ENTRY = re.compile(r"\n    (\w+)(?: \(([^)]*)\))?: (.*(?:\n {8}.*)*)")


@dataclass(frozen=True)
class Kind:
    """What an option takes beyond its type. unit: SI, of a number that may have a unit of its own, as
    `--thickness "2 mm"`; choices: these alone, checked before the command runs; least: of a number;
    separator: a regular expression of what stands between the items of a list."""

    unit: str | None = None
    choices: tuple[str, ...] = ()
    least: int | None = None
    separator: str = ","


Models = Annotated[list[str] | None, Kind(separator=r",(?!\w+=)")]  # settings go on after a comma
Metres = Annotated[float | None, Kind("m")]
Seconds = Annotated[float | None, Kind("s")]
Share = Annotated[float | None, Kind("")]
Count = Annotated[int, Kind(least=1)]


@dataclass(frozen=True)
class Words:
    """What an option is for; metavar: what its value is called; argument: whether it has no option's name."""

    text: str = ""
    metavar: str | None = None
    argument: bool = False


def words_of(*documented: Any) -> dict[str, Words]:
    """Return the words of options by name, from the docstrings of functions, classes and modules; the first
    that describes one counts."""
    found: dict[str, Words] = {}
    for one in documented:
        values = {**vars(choices), **vars(getmodule(one))}
        for name, metavar, text in ENTRY.findall(cleandoc(one.__doc__ or "").partition("\nArgs:")[2]):
            shown = _Shown().vformat(" ".join(text.split()), (), values)
            called, argument = metavar.removesuffix(", argument"), metavar.endswith("argument")
            found.setdefault(name, Words(shown, called or None, argument))
    return found


class _Shown(Formatter):
    """Values in words: of several, all of them."""

    def format_field(self, value: Any, format_spec: str) -> str:
        return str(value) if isinstance(value, str | int) else choices.listed(value)


class Group:
    """A dataclass whose fields with words are options; no_effect: see `verb.no_effect`; left_out: fields that
    are none."""

    no_effect: ClassVar[dict[str, str]] = {}
    left_out: ClassVar[tuple[str, ...]] = ()

    @classmethod
    def parameters(cls) -> list[Parameter]:
        """Return the options as keyword parameters of a command."""
        hints, words = (
            get_type_hints(cls, include_extras=True),
            words_of(*cls.__mro__[:-1], sys.modules[__name__]),
        )
        return [
            Parameter(one.name, Parameter.KEYWORD_ONLY, default=one.default, annotation=hints[one.name])
            for one in fields(cls)  # type: ignore[arg-type]
            if one.name in words and one.name not in cls.left_out
        ]


@dataclass(frozen=True)
class LatticeOptions(Group):
    """The lattice of a verb; lattice: one that the options change, in Python."""

    lattice: Any = None
    grid: str | None = None
    calibration: str | None = None
    k: Annotated[float | None, Kind("N/m")] = None
    layer_distance: Metres = None
    grading: str | None = None

    @property
    def spec(self) -> Lattice:
        """The lattice that is requested."""
        from comparisons.models.spec import Lattice  # help does not wait for models
        from sheetbench.errors import BadInput

        own = {name: value for name, value in vars(self).items() if name != "lattice" and value is not None}
        if not isinstance(self.lattice, Lattice | None):
            raise BadInput(f"lattice = {self.lattice!r}: a Lattice is needed")
        return replace(self.lattice or Lattice(), **own)


class SpringOptions(LatticeOptions):
    """Settings that all lattices of a list have in common."""

    left_out = ("grid", "calibration")


@dataclass(frozen=True)
class SheetOptions(Group):
    """A sheet and its material.

    Args:
        young (PA): Young's modulus E: 6e5 or 0.6MPa.
        poisson (NU): Poisson's ratio ν.
        thickness (M): Thickness: 0.002 or 2mm.
        density (KG/M3): Density: 1100 or 1.1g/cm3; default: 1000 kg/m³.
        side (M): Sides: 0.188, 0.188x0.3 (x by y) or 12x4cm.
    """

    young: Annotated[float | None, Kind("Pa")] = None
    poisson: Share = None
    thickness: Metres = None
    density: Annotated[float | None, Kind("kg/m³")] = None
    side: str | None = None

    @property
    def values(self) -> dict[str, Any]:
        """Values by the keys of a scene's sheet and material, None where they are not given."""
        from comparisons.models.quantities import sides

        return {key: value for key, value in vars(self).items() if key != "side"} | sides(self.side)


@dataclass(frozen=True)
class CampaignOptions(Group):
    """How a campaign's runs are carried out.

    Args:
        workers (N): Runs that are not timed go side by side, so many at most; default: one per core, or per
            thread of the cluster.
        scheduler (ADDRESS): A dask scheduler, as tcp://host:8786, whose workers carry out the runs; timed
            ones all on one worker.
        retry: Run again what failed in an earlier run.
    """

    no_effect: ClassVar[dict[str, str]] = {"without_out": "retry"}
    workers: Annotated[int | None, Kind(least=1)] = None
    scheduler: str | None = None
    retry: bool = False
