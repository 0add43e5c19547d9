"""Options of verbs from a function's signature and docstring, and groups of options shared by several verbs.

An option has the name, type and default of a parameter; its description is in the docstring, as

    Args:
        elements (N): Elements along the shorter side; default: {ELEMENTS}.

The parentheses contain the metavar, and `argument` for a positional argument. Words in braces are replaced by
values of the module or of `sheetbench.choices`, tables by their names. A parameter of the type
`LatticeOptions` adds --grid, --calibration, --k, --layer-distance and --grading to a command, `SpringOptions`
the last three, for commands with their own lists of grids and calibrations. `SheetOptions` are --young,
--poisson, --thickness, --density and --side, `CampaignOptions` the options of many runs. Output options are
in `comparisons.cli.output`. Options of several verbs are described here.

Args:
    scene (SCENE, argument): Catalogue name or path to a TOML file.
    grid (GRID): Masses of the lattice: 9, along the shorter side with near-square cells; 9x13, along x and y;
        9x13x3, with layers, else 2. Default: 9.
    calibration (NAME): Method for k from E, ν and h: {CALIBRATIONS}; auto: the consistent one that suits
        the scene. Default: {CALIBRATION}; auto with --grading auto.
    k (N/M): Stiffness of every spring; sets the calibration to uniform.
    layer_distance (M): Distance of the lattice's layers.
    grading (G): Refinement of the lattice at its edges, 0 (cells of one size) to 1; 0.5:x0 or 0.5:x0,x1: at
        some edges only; auto: by the scene's boundary layers. Default: 0.
    elements (N): The reference's elements along the shorter side, or 8x4 along x and y.
    law (NAME): Law of strain of a shell or solid: {STRAIN_LAWS}. Default: the material's own, else
        {STRAIN_LAW}.
    model (MODELS): Further models: a plug-in's NAME, FILE.py:CLASS or exec:PROGRAM of your own, or lumped,
        plate, shell, solid; settings after it, as NAME:grid=9x5,k=550.
    export (DIR): Write the lattice for another simulator: masses, springs, supports, loads, check values.
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
    """Constraints of an option beyond its type; unit: SI unit of a number that may be given with another
    unit, as `--thickness "2 mm"`; choices: valid values, checked before the command runs; least: smallest
    number; separator: regular expression between the items of a list."""

    unit: str | None = None
    choices: tuple[str, ...] = ()
    least: int | None = None
    separator: str = ","


Models = Annotated[list[str] | None, Kind(separator=r",(?!\w+=)")]  # a comma may precede another setting
Metres = Annotated[float | None, Kind("m")]
Seconds = Annotated[float | None, Kind("s")]
Share = Annotated[float | None, Kind("")]
Count = Annotated[int, Kind(least=1)]


@dataclass(frozen=True)
class Words:
    """Description of an option; metavar: name of its value; argument: whether it is positional."""

    text: str = ""
    metavar: str | None = None
    argument: bool = False


def words_of(*documented: Any) -> dict[str, Words]:
    """Return descriptions of options by name, from the docstrings of functions, classes and modules; the
    first description of a name counts."""
    out: dict[str, Words] = {}
    for source in documented:
        values = {**vars(choices), **vars(getmodule(source))}
        for name, metavar, text in ENTRY.findall(cleandoc(source.__doc__ or "").partition("\nArgs:")[2]):
            description = _ValueFormatter().vformat(" ".join(text.split()), (), values)
            argument = metavar.endswith("argument")
            out.setdefault(name, Words(description, metavar.removesuffix(", argument") or None, argument))
    return out


class _ValueFormatter(Formatter):
    """Formatter of values in descriptions; lists are written as enumerations."""

    def format_field(self, value: Any, format_spec: str) -> str:
        return str(value) if isinstance(value, str | int) else choices.listed(value)


class Group:
    """A dataclass whose described fields are options, except `left_out`; no_effect: see `verb.no_effect`."""

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
            Parameter(entry.name, Parameter.KEYWORD_ONLY, default=entry.default, annotation=hints[entry.name])
            for entry in fields(cls)  # type: ignore[arg-type]
            if entry.name in words and entry.name not in cls.left_out
        ]


@dataclass(frozen=True)
class LatticeOptions(Group):
    """The lattice of a verb; lattice: in Python, a lattice that the options change."""

    lattice: Any = None
    grid: str | None = None
    calibration: str | None = None
    k: Annotated[float | None, Kind("N/m")] = None
    layer_distance: Metres = None
    grading: str | None = None

    @property
    def spec(self) -> Lattice:
        """The requested lattice."""
        from comparisons.models.spec import Lattice  # slow import for help
        from sheetbench.errors import BadInput

        given = {name: value for name, value in vars(self).items() if name != "lattice" and value is not None}
        if not isinstance(self.lattice, Lattice | None):
            raise BadInput(f"lattice = {self.lattice!r}: a Lattice is needed")
        return replace(self.lattice or Lattice(), **given)


class SpringOptions(LatticeOptions):
    """Common settings of all lattices of a list."""

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
        """Values by the keys of a scene's sheet and material, None if not given."""
        from comparisons.models.quantities import sides

        return {key: value for key, value in vars(self).items() if key != "side"} | sides(self.side)


@dataclass(frozen=True)
class CampaignOptions(Group):
    """Options of a campaign's execution.

    Args:
        workers (N): Largest number of parallel runs, timed runs excepted; default: one per core, or per
            thread of the cluster.
        scheduler (ADDRESS): A dask scheduler, as tcp://host:8786, whose workers carry out the runs, timed
            runs all on one worker.
        retry: Repeat failed runs of an earlier command.
    """

    no_effect: ClassVar[dict[str, str]] = {"without_out": "retry"}
    workers: Annotated[int | None, Kind(least=1)] = None
    scheduler: str | None = None
    retry: bool = False
