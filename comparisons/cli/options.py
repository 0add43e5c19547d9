"""Options that several verbs share."""

from __future__ import annotations

from typing import Annotated

import typer

from comparisons.cli.quantity import quantity_in
from sheetbench.choices import CALIBRATION, CALIBRATIONS, STRAIN_LAW, STRAIN_LAWS, listed

Scene = Annotated[str, typer.Argument(metavar="SCENE", help="Catalogue name or path to a TOML file.")]
Json = Annotated[bool, typer.Option("--json", help="Print one JSON document instead of tables.")]
Out = Annotated[str | None, typer.Option("--out", metavar="DIR", help="Write files into this folder.")]
Export = Annotated[
    str | None,
    typer.Option(
        "--export",
        metavar="DIR",
        help="Write the lattice for another simulator: masses, springs, supports, loads, values to check by.",
    ),
]
Grid = Annotated[
    str | None,
    typer.Option(
        "--lumped",
        "--grid",
        metavar="GRID",
        help="Masses of the lattice: 9, along the shorter side with near-square cells; 9x13, along x and y; "
        "9x13x3, with layers, else 2. 9 unless given.",
    ),
]
Grading = Annotated[
    str | None,
    typer.Option(
        "--grading",
        metavar="G",
        help="How much finer the lattice is at its edges, 0 (cells of one size) to 1; 0.5:x0 or 0.5:x0,x1: "
        "at these edges alone; auto: as the scene's layers need. 0 unless given.",
    ),
]
Figure = Annotated[
    str | None,
    typer.Option(
        "--figure",
        metavar="FORMAT",
        help="With --out: pictures for a paper, without a title, as pdf, svg or png, several with commas; "
        "pdf:single as wide as one column (89 mm), else as both (183 mm).",
    ),
]
NoPictures = Annotated[bool, typer.Option("--no-pictures", help="With --out: all files but the pictures.")]
NoPicturesAnyway = Annotated[  # of verbs that draw none, for scripts that give it to all
    bool, typer.Option("--no-pictures", hidden=True)
]
Quiet = Annotated[
    bool,
    typer.Option(
        "--quiet", help="No progress and no notes on standard error; results, warnings and errors stay."
    ),
]
Overwrite = Annotated[
    bool,
    typer.Option(
        "--overwrite", help="With --out: first remove what an earlier run left there; its manifest lists it."
    ),
]
Scheduler = Annotated[
    str | None, typer.Option("--scheduler", metavar="ADDRESS", help="A dask scheduler, as tcp://host:8786.")
]
Wait = Annotated[
    bool, typer.Option("--wait", help="With --scheduler: wait where there is no worker, instead of stopping.")
]


def _let_through(context: typer.Context, value: bool) -> bool:
    """Hold --large for all that the command does."""
    if value:
        from comparisons.models.context import running

        context.with_resource(running(large=True))
    return value


Large = Annotated[
    bool,
    typer.Option(
        "--large",
        callback=_let_through,
        help="Go on where a model takes more memory than is free, instead of refusing it.",
    ),
]
Workers = Annotated[
    int | None,
    typer.Option(
        "--workers", min=1, metavar="N", help="Processes for what is not timed; one a core unless given."
    ),
]
Retry = Annotated[bool, typer.Option("--retry", help="Run again what failed in an earlier run.")]
Calibration = Annotated[
    str | None,
    typer.Option(
        "--calibration",
        metavar="NAME",
        help=f"How k is found from E, ν and h: {listed(CALIBRATIONS)}; auto: consistent ones by the scene. "
        f"{CALIBRATION} unless given, with --grading auto as auto has it.",
    ),
]
K = Annotated[
    float | None,
    typer.Option(
        "--k", metavar="N/M", parser=quantity_in("N/m"), help="Stiffness of every spring; means uniform."
    ),
]
LayerDistance = Annotated[
    float | None,
    typer.Option(
        "--layer-distance", metavar="M", parser=quantity_in("m"), help="Distance of the lattice's layers."
    ),
]
Side = Annotated[
    str | None, typer.Option("--side", metavar="M", help="Sides: 0.188, 0.188x0.3 (x by y) or 12cmx4cm.")
]
Thickness = Annotated[
    float | None,
    typer.Option("--thickness", metavar="M", parser=quantity_in("m"), help="Thickness: 0.002 or 2mm."),
]
Young = Annotated[
    float | None,
    typer.Option("--young", metavar="PA", parser=quantity_in("Pa"), help="Young's modulus E: 6e5 or 0.6MPa."),
]
Poisson = Annotated[
    float | None, typer.Option("--poisson", metavar="NU", parser=quantity_in(""), help="Poisson's ratio ν.")
]
Density = Annotated[
    float | None,
    typer.Option(
        metavar="KG/M3",
        parser=quantity_in("kg/m³"),
        help="Density: 1100 or 1.1g/cm3; 1000 kg/m³ unless given.",
    ),
]
Elements = Annotated[
    str,
    typer.Option(
        "--elements",
        metavar="N",
        help="The reference's elements along the shorter side, or 8x4 along x and y.",
    ),
]
Law = Annotated[
    str | None,
    typer.Option(
        "--law",
        metavar="NAME",
        help=f"Law of strain of a shell or solid: {listed(STRAIN_LAWS)}. The material's own unless given, "
        f"{STRAIN_LAW} where it has none.",
    ),
]
Symmetry = Annotated[
    bool,
    typer.Option(
        "--symmetry",
        help="Solve a half or a quarter where scene and grid mirror themselves; solids are solved whole.",
    ),
]
Models = Annotated[
    list[str] | None,
    typer.Option(
        "--model",
        metavar="MODEL",
        help="A model more: a plug-in's NAME, FILE.py:CLASS or exec:PROGRAM of your own, or lumped, "
        "lumped-pair, plate, shell, solid; settings after it, as NAME:grid=9x5. May be repeated.",
    ),
]
