"""Options that several verbs share, alone and in groups, each declared once.

A command whose parameter is of the type `LatticeOptions` has --grid, --calibration, --k, --layer-distance and
--grading; with `SpringOptions` the last three, beside lists of grids and calibrations of its own.
`SheetOptions` are --young, --poisson, --thickness, --density and --side; `CampaignOptions` those of many
runs. Those of the output stand in `comparisons.cli.output`.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, fields, replace
from inspect import Parameter
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, get_type_hints

import typer

from sheetbench.choices import CALIBRATION, CALIBRATIONS, STRAIN_LAW, STRAIN_LAWS, listed

if TYPE_CHECKING:
    from comparisons.models.spec import Lattice


def option(
    help: str,
    metavar: str | None = None,
    *names: str,
    unit: str | None = None,
    listed: bool = False,
    choices: Iterable[str] = (),
    **settings: Any,
) -> Any:
    """Return an option of typer's; names: where they do not follow from the parameter; unit: SI, of a number
    that may have a unit of its own, as `--thickness "2 mm"`; listed: a text of several with commas;
    choices: what alone it takes, checked before the command runs."""
    if unit is not None:
        settings["parser"] = quantity_in(unit)
    made = typer.Option(*names, help=help, metavar=metavar, **settings)
    made.unit, made.listed, made.choices = unit, listed, tuple(choices)
    return made


def quantity_in(unit: str) -> Callable[[str], float]:
    """Return a parser of an option's text, a number in an SI unit or a quantity with a unit of its own."""

    def parse(text: str) -> float:
        from sheetbench.errors import BadInput  # with numpy and pydantic: help must not wait for them
        from sheetbench.scenes.language.units import quantity

        try:
            return quantity(str(text), unit)
        except BadInput as error:
            raise typer.BadParameter(str(error)) from None

    return parse


def _let_through(context: typer.Context, value: bool) -> bool:
    """Hold --large for all that the command does."""
    if value:
        from comparisons.models.context import running

        context.with_resource(running(large=True))
    return value


Scene = Annotated[str, typer.Argument(metavar="SCENE", help="Catalogue name or path to a TOML file.")]
Json = Annotated[bool, option("Print one JSON document instead of tables.")]
Export = Annotated[
    str | None,
    option(
        "Write the lattice for another simulator: masses, springs, supports, loads, values to check by.",
        "DIR",
    ),
]
Grid = Annotated[
    str | None,
    option(
        "Masses of the lattice: 9, along the shorter side with near-square cells; 9x13, along x and y; "
        "9x13x3, with layers, else 2. Default: 9.",
        "GRID",
        "--lumped",
        "--grid",
    ),
]
Grading = Annotated[
    str | None,
    option(
        "How much finer the lattice is at its edges, 0 (cells of one size) to 1; 0.5:x0 or 0.5:x0,x1: "
        "at these edges only; auto: by the scene's boundary layers. Default: 0.",
        "G",
    ),
]
NoPictures = Annotated[bool, option("With --out: all files but the pictures.")]
Large = Annotated[
    bool,
    option(
        "Solve models that need more memory than is free, instead of refusing them.", callback=_let_through
    ),
]
Calibration = Annotated[
    str | None,
    option(
        f"How k is found from E, ν and h: {listed(CALIBRATIONS)}; auto: the consistent one that suits "
        f"the scene. Default: {CALIBRATION}; auto with --grading auto.",
        "NAME",
    ),
]
K = Annotated[float | None, option("Stiffness of every spring; implies uniform.", "N/M", unit="N/m")]
LayerDistance = Annotated[float | None, option("Distance of the lattice's layers.", "M", unit="m")]
Elements = Annotated[
    str, option("The reference's elements along the shorter side, or 8x4 along x and y.", "N")
]
Law = Annotated[
    str | None,
    option(
        f"Law of strain of a shell or solid: {listed(STRAIN_LAWS)}. Default: the material's own, "
        f"else {STRAIN_LAW}.",
        "NAME",
    ),
]
Symmetry = Annotated[
    bool, option("Solve a half or a quarter where scene and grid are symmetric; solids are solved whole.")
]
Models = Annotated[
    list[str] | None,
    option(
        "A further model: a plug-in's NAME, FILE.py:CLASS or exec:PROGRAM of your own, or lumped, "
        "lumped-pair, plate, shell, solid; settings after it, as NAME:grid=9x5. May be repeated.",
        "MODEL",
    ),
]


class Group:
    """A dataclass whose fields with typer's annotations are options; no_effect: see `verb.no_effect`."""

    no_effect: ClassVar[dict[str, str]] = {}

    @classmethod
    def parameters(cls) -> list[Parameter]:
        """Return the options as keyword parameters of a command."""
        hints = get_type_hints(cls, include_extras=True)
        return [
            Parameter(one.name, Parameter.KEYWORD_ONLY, default=one.default, annotation=hints[one.name])
            for one in fields(cls)  # type: ignore[arg-type]
            if hasattr(hints[one.name], "__metadata__")
        ]


class LatticeGroup(Group):
    """Options by the names of a lattice's settings; lattice: one that they change, in Python."""

    lattice: Any

    @property
    def spec(self) -> Lattice:
        """The lattice that is requested."""
        from comparisons.models.spec import Lattice  # help does not wait for models
        from sheetbench.errors import BadInput

        own = {name: value for name, value in vars(self).items() if name != "lattice" and value is not None}
        if not isinstance(self.lattice, Lattice | None):
            raise BadInput(f"lattice = {self.lattice!r}: a Lattice is needed")
        return replace(self.lattice or Lattice(), **own)


@dataclass(frozen=True)
class SpringOptions(LatticeGroup):
    """Settings that all lattices of a list have in common."""

    lattice: Any = None
    k: K = None
    layer_distance: LayerDistance = None
    grading: Grading = None


@dataclass(frozen=True)
class LatticeOptions(LatticeGroup):
    """The lattice of a verb."""

    lattice: Any = None
    grid: Grid = None
    calibration: Calibration = None
    k: K = None
    layer_distance: LayerDistance = None
    grading: Grading = None


@dataclass(frozen=True)
class MethodOptions(LatticeOptions):
    """The lattice that is calibrated, with a line about every calibration."""

    calibration: Annotated[
        str | None,
        option(
            "; ".join(f"{n}: {m.summary}" for n, m in CALIBRATIONS.items())
            + f"; auto: by the SCENE, as with --grading auto. Default: {CALIBRATION}.",
            "NAME",
        ),
    ] = None


@dataclass(frozen=True)
class SheetOptions(Group):
    """A sheet and its material."""

    young: Annotated[float | None, option("Young's modulus E: 6e5 or 0.6MPa.", "PA", unit="Pa")] = None
    poisson: Annotated[float | None, option("Poisson's ratio ν.", "NU", unit="")] = None
    thickness: Annotated[float | None, option("Thickness: 0.002 or 2mm.", "M", unit="m")] = None
    density: Annotated[
        float | None,
        option("Density: 1100 or 1.1g/cm3; default: 1000 kg/m³, of new 1100.", "KG/M3", unit="kg/m³"),
    ] = None
    side: Annotated[str | None, option("Sides: 0.188, 0.188x0.3 (x by y) or 12x4cm.", "M")] = None

    @property
    def values(self) -> dict[str, Any]:
        """Values by the keys of a scene's sheet and material, None where they are not given."""
        from comparisons.models.quantities import sides

        return {key: value for key, value in vars(self).items() if key != "side"} | sides(self.side)


@dataclass(frozen=True)
class CampaignOptions(Group):
    """How a campaign's runs are carried out."""

    no_effect: ClassVar[dict[str, str]] = {"without_out": "retry"}
    workers: Annotated[
        int | None, option("Processes for runs that are not timed; default: one per core.", "N", min=1)
    ] = None
    scheduler: str | None = None
    wait: bool = False
    retry: Annotated[bool, option("Run again what failed in an earlier run.")] = False


@dataclass(frozen=True)
class ClusterOptions(CampaignOptions):
    """The options of a campaign whose runs may go to a cluster."""

    no_effect: ClassVar[dict[str, str]] = {
        "without_out": "retry",
        "without_scheduler": "wait",
        "with_scheduler": "workers",
    }
    scheduler: Annotated[str | None, option("A dask scheduler, as tcp://host:8786.", "ADDRESS")] = None
    wait: Annotated[bool, option("With --scheduler: wait where there is no worker, instead of stopping.")] = (
        False
    )
