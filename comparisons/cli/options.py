"""Options that several verbs share."""

from __future__ import annotations

from collections.abc import Callable
from typing import Annotated, Any

import typer

from sheetbench.choices import CALIBRATION, CALIBRATIONS, STRAIN_LAW, STRAIN_LAWS, listed


def option(
    help: str, metavar: str | None = None, *names: str, unit: str | None = None, **settings: Any
) -> Any:
    """Return an option of typer's; names: where they do not follow from the parameter; unit: SI, of a number
    that may have a unit of its own, as `--thickness "2 mm"`."""
    if unit is not None:
        settings["parser"] = quantity_in(unit)
    return typer.Option(*names, help=help, metavar=metavar, **settings)


def quantity_in(unit: str) -> Callable[[str], float]:
    """Return a parser of an option's text, a number in an SI unit or a quantity with a unit of its own."""

    def parse(text: str) -> float:
        from sheetbench.errors import BadInput  # with numpy and pydantic: help must not wait for them
        from sheetbench.scenes.units import quantity

        try:
            return quantity(str(text), unit)
        except BadInput as error:
            raise typer.BadParameter(str(error)) from None

    return parse


Scene = Annotated[str, typer.Argument(metavar="SCENE", help="Catalogue name or path to a TOML file.")]
Json = Annotated[bool, option("Print one JSON document instead of tables.", None, "--json")]
Out = Annotated[str | None, option("Write files into this folder.", "DIR", "--out")]
Export = Annotated[
    str | None,
    option(
        "Write the lattice for another simulator: masses, springs, supports, loads, values to check by.",
        "DIR",
        "--export",
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
        "--grading",
    ),
]
Figure = Annotated[
    str | None,
    option(
        "With --out: pictures for a paper, without a title, as pdf, svg or png, several with commas; "
        "pdf:single as wide as one column (89 mm), else as both (183 mm).",
        "FORMAT",
        "--figure",
    ),
]
NoPictures = Annotated[bool, option("With --out: all files but the pictures.", None, "--no-pictures")]
NoPicturesAnyway = Annotated[  # of verbs that draw none, for scripts that give it to all
    bool, typer.Option("--no-pictures", hidden=True)
]
Quiet = Annotated[
    bool,
    option("No progress and no notes on standard error; results, warnings and errors stay.", None, "--quiet"),
]
Overwrite = Annotated[
    bool,
    option(
        "With --out: first remove what an earlier run left there; its manifest lists it.", None, "--overwrite"
    ),
]
Scheduler = Annotated[str | None, option("A dask scheduler, as tcp://host:8786.", "ADDRESS", "--scheduler")]
Wait = Annotated[
    bool, option("With --scheduler: wait where there is no worker, instead of stopping.", None, "--wait")
]


def _let_through(context: typer.Context, value: bool) -> bool:
    """Hold --large for all that the command does."""
    if value:
        from comparisons.models.context import running

        context.with_resource(running(large=True))
    return value


Large = Annotated[
    bool,
    option(
        "Solve models that need more memory than is free, instead of refusing them.",
        None,
        "--large",
        callback=_let_through,
    ),
]
Workers = Annotated[
    int | None,
    option("Processes for runs that are not timed; default: one per core.", "N", "--workers", min=1),
]
Retry = Annotated[bool, option("Run again what failed in an earlier run.", None, "--retry")]
Calibration = Annotated[
    str | None,
    option(
        f"How k is found from E, ν and h: {listed(CALIBRATIONS)}; auto: the consistent one that suits "
        f"the scene. Default: {CALIBRATION}; auto with --grading auto.",
        "NAME",
        "--calibration",
    ),
]
K = Annotated[float | None, option("Stiffness of every spring; implies uniform.", "N/M", "--k", unit="N/m")]
LayerDistance = Annotated[
    float | None, option("Distance of the lattice's layers.", "M", "--layer-distance", unit="m")
]
Side = Annotated[str | None, option("Sides: 0.188, 0.188x0.3 (x by y) or 12cmx4cm.", "M", "--side")]
Thickness = Annotated[float | None, option("Thickness: 0.002 or 2mm.", "M", "--thickness", unit="m")]
Young = Annotated[float | None, option("Young's modulus E: 6e5 or 0.6MPa.", "PA", "--young", unit="Pa")]
Poisson = Annotated[float | None, option("Poisson's ratio ν.", "NU", "--poisson", unit="")]
Density = Annotated[
    float | None, option("Density: 1100 or 1.1g/cm3; default: 1000 kg/m³.", "KG/M3", unit="kg/m³")
]
Elements = Annotated[
    str, option("The reference's elements along the shorter side, or 8x4 along x and y.", "N", "--elements")
]
Law = Annotated[
    str | None,
    option(
        f"Law of strain of a shell or solid: {listed(STRAIN_LAWS)}. Default: the material's own, "
        f"else {STRAIN_LAW}.",
        "NAME",
        "--law",
    ),
]
Symmetry = Annotated[
    bool,
    option(
        "Solve a half or a quarter where scene and grid are symmetric; solids are solved whole.",
        None,
        "--symmetry",
    ),
]
Models = Annotated[
    list[str] | None,
    option(
        "A further model: a plug-in's NAME, FILE.py:CLASS or exec:PROGRAM of your own, or lumped, "
        "lumped-pair, plate, shell, solid; settings after it, as NAME:grid=9x5. May be repeated.",
        "MODEL",
        "--model",
    ),
]
