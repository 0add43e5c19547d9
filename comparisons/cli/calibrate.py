"""`sheetbench calibrate`: spring constants from E, ν, density, thickness, sides and grid."""

from __future__ import annotations

from typing import Annotated

import typer

from comparisons.cli.options import (
    Density,
    Export,
    Grading,
    Grid,
    K,
    Large,
    LayerDistance,
    Poisson,
    Side,
    Thickness,
    Young,
)
from comparisons.cli.verb import OutputOptions
from sheetbench.choices import CALIBRATION, CALIBRATIONS


def command(
    scene: Annotated[
        str | None,
        typer.Argument(metavar="[SCENE]", help="Take sheet and material from here.", show_default=False),
    ] = None,
    young: Young = None,
    poisson: Poisson = None,
    thickness: Thickness = None,
    density: Density = None,
    side: Side = None,
    grid: Grid = None,
    grading: Grading = None,
    method: Annotated[
        str | None,
        typer.Option(
            metavar="NAME",
            help="; ".join(f"{n}: {m.summary}" for n, m in CALIBRATIONS.items())
            + f"; auto: by the SCENE, as with --grading auto. {CALIBRATION} unless given.",
            show_default=False,
        ),
    ] = None,
    k: K = None,
    layer_distance: LayerDistance = None,
    toml: Annotated[
        bool, typer.Option("--toml", help="Print the \\[springs] table for a scene file.")
    ] = False,
    export: Export = None,
    simulators: Annotated[
        list[str] | None,
        typer.Option(
            "--for",
            metavar="NAME",
            help="With --export, also a file for this simulator, of springs without cells (--method "
            "central): mujoco (MJCF), sofa (a scene). May be repeated.",
            show_default=False,
        ),
    ] = None,
    large: Large = False,
    *,
    output: OutputOptions,
) -> None:
    """Find the spring constants of a lattice, and report which of the sheet's moduli they meet.

    Give a SCENE, or --young --poisson --thickness --side; with both, the options change the scene's values.
    The fitted methods train on the SCENE; without one, on the sheet under its own weight with one edge and
    with two adjacent edges clamped. --export is of the SCENE, or of the sheet with one edge clamped.
    """
    from comparisons.calibration import tables
    from comparisons.calibration.calibrate import calibrate, expected, subject
    from comparisons.models.candidate import Candidate
    from comparisons.models.quantities import sides
    from comparisons.models.sizes import require_room
    from comparisons.models.springs import LatticeSpec
    from sheetbench.errors import BadInput

    if toml and output.json:
        raise BadInput("--toml and --json: choose one")
    if simulators and export is None:
        raise BadInput("--for: goes with --export DIR")
    values = {"young": young, "poisson": poisson, "thickness": thickness, "density": density, **sides(side)}
    of = subject(scene, values, "--")
    about = {"sheet": of.sheet.model_dump(mode="json"), "material": of.material.model_dump(mode="json")}
    with output.open(about=about) as out:
        if export is not None and not large:
            require_room(of, Candidate("lumped", {"grid": grid}), "--grid")
        lattice = LatticeSpec(grid, method, k, layer_distance, grading)
        found = calibrate(of, lattice, scene is not None, large, out.progress)
        foretold = scene is not None and k is None and layer_distance is None
        off = expected(of, found, out.progress) if foretold else None
        report = tables.report(found, of.sheet, of.material, off)
        if export is not None:
            report = out.export(export, of, found, report, simulators or ())
        out.show(report, instead=tables.to_toml(found.as_dict()) if toml else None)
