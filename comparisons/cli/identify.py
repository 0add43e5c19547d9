"""`sheetbench identify SCENE`: material and support parameters from measured displacements."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from comparisons.cli.options import Grid, Json, Out, Scene, command_line


def command(
    scene: Scene,
    measured: Annotated[
        Path,
        typer.Option(
            metavar="FILE",
            help="CSV with the header x,y,ux,uy,uz (metres; with a column time [s], a motion), or a VTP or "
            "PLY point cloud of the deformed surface.",
        ),
    ],
    unknown: Annotated[
        str,
        typer.Option(
            metavar="NAMES",
            help="young, poisson, density, thickness, curvature_EDGE, tilt_EDGE (of a clamp), damping_time, "
            "damping_rate; several with commas.",
        ),
    ] = "young",
    model: Annotated[str, typer.Option(metavar="MODEL", help="lumped, shell or solid.")] = "lumped",
    lumped: Grid = None,
    calibration: Annotated[
        str | None,
        typer.Option(metavar="NAME", help="How k follows from E, ν and h; consistent unless given."),
    ] = None,
    elements: Annotated[
        int, typer.Option(metavar="N", help="The reference's elements along the shorter side.")
    ] = 16,
    offset: Annotated[
        float,
        typer.Option(
            metavar="M",
            help="Where a point cloud was taken, along the surface's normal: half the thickness for its top.",
        ),
    ] = 0.0,
    json: Json = False,
    out: Out = None,
) -> None:
    """Find the values with which a model comes nearest to what was measured, with 95 % intervals.

    The search starts from the scene's own values. All lengths are in metres and in the scene's axes.
    """
    from comparisons.cli import console
    from comparisons.cli.app import NOT_CONVERGED
    from comparisons.comparison.comparison import load_static
    from comparisons.identification import tables
    from comparisons.identification.identification import identify
    from comparisons.identification.measurements import read
    from comparisons.identification.prediction import NotReached
    from comparisons.report.files import folder, to_json, write_text
    from comparisons.runs.manifest import manifest

    asked = load_static(scene)
    data = read(measured, asked)
    target = folder(out) if out is not None else None
    with console.progress() as progress:
        try:
            found = identify(
                asked,
                data,
                [name.strip() for name in unknown.split(",")],
                model=model,
                grid=lumped,
                calibration=calibration,
                elements=elements,
                offset=offset,
                progress=progress,
            )
        except NotReached as error:
            console.warn(f"no answer with the scene's own values: {error}")
            raise typer.Exit(NOT_CONVERGED) from None
    values, residuals = tables.unknowns(found), tables.residuals(found)
    files = {}
    if target is not None:
        files = {
            "identification.json": to_json(found.as_dict()),
            "unknowns.csv": values.to_csv(),
            "residuals.csv": residuals.to_csv(),
            "identification.md": f"{values.to_markdown()}\n{residuals.to_markdown()}\n"
            f"{tables.explanation(found)}\n",
            "manifest.json": to_json(
                manifest(asked, {**found.settings, "measured": str(measured)}, command_line())
            ),
        }
        for name, text in files.items():
            write_text(target / name, text)
    if json:
        print(to_json(found.as_dict()), end="")
    else:
        console.heading(asked.name, asked.title)
        console.show(values)
        console.show(tables.worst(found))
        console.note(tables.explanation(found))
        if files:
            console.note(f"Files in {target}: {', '.join(files)}")
    for said in found.warnings:
        console.warn(said)
    if not found.converged:
        console.warn(f"the search did not end within {found.evaluations} evaluations")
        raise typer.Exit(NOT_CONVERGED)
