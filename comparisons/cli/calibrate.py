"""`sheetbench calibrate`: spring constants from E, ν, density, thickness, sides and grid."""

from __future__ import annotations

from dataclasses import replace
from typing import Annotated

import typer

from comparisons.cli.options import (
    Density,
    Export,
    Grading,
    Grid,
    Json,
    Large,
    LayerDistance,
    Out,
    Overwrite,
    Poisson,
    Side,
    Thickness,
    Young,
)
from comparisons.cli.quantity import quantity_in
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
    k: Annotated[
        float | None,
        typer.Option(
            metavar="N/M", parser=quantity_in("N/m"), help="Stiffness of every spring (uniform only)."
        ),
    ] = None,
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
    json: Json = False,
    out: Out = None,
    overwrite: Overwrite = False,
) -> None:
    """Find the spring constants of a lattice, and report which of the sheet's moduli they meet.

    Give a SCENE, or --young --poisson --thickness --side; with both, the options change the scene's values.
    The fitted methods train on the SCENE; without one, on the sheet under its own weight with one edge and
    with two adjacent edges clamped. --export is of the SCENE, or of the sheet with one edge clamped.
    """
    from comparisons.calibration import asked, tables
    from comparisons.cli.finish import finish
    from comparisons.models.candidate import Candidate
    from comparisons.models.grids import parse_grid
    from comparisons.models.quantities import sides
    from comparisons.models.sizes import require_room
    from comparisons.models.springs import calibrate
    from sheetbench.scenes.errors import BadInput
    from sheetbench.scenes.grid import MASSES, grid_of

    if toml and json:
        raise BadInput("--toml and --json: choose one")
    if simulators and export is None:
        raise BadInput("--for: goes with --export DIR")
    sheet, material = asked.sheet_and_material(
        scene,
        {"thickness": thickness, **sides(side)},
        {"young": young, "poisson": poisson, "density": density},
    )
    about = {"sheet": sheet.model_dump(mode="json"), "material": material.model_dump(mode="json")}
    with finish("calibrate", json, out, overwrite, about=about) as end:
        masses = parse_grid(sheet, grid) if grid is not None else grid_of(sheet, MASSES)
        if export is not None and not large:
            lattice = Candidate("lumped", {"grid": masses})
            require_room(asked.exported(scene, sheet, material), lattice, "--grid")
        own = {"k": k, "layer_distance": layer_distance}
        method, because = asked.method(scene, sheet, material, masses, method, grading, own)
        method = method or CALIBRATION
        graded, why = asked.grading(scene, sheet, material, masses, grading, {"calibration": method, **own})
        found = calibrate(
            sheet,
            material,
            grid=masses,
            calibration=method,
            k=k,
            layer_distance=layer_distance,
            grading=graded,
            training=asked.training(scene, sheet, material),
            large=large,
            progress=end.progress,
        )
        notes = [f"grading {graded:g}: {why}"] if why else []
        notes += [f"{method}: {because}"] if because else []
        notes += asked.foretold(scene, sheet, material, masses)
        found = replace(found, notes=(*notes, *found.notes))
        own_scale = k is not None or layer_distance is not None
        off = None if own_scale else asked.expected(scene, sheet, material, found, end.progress)
        report = tables.report(found, sheet, material, off)
        if export is not None:
            of = asked.exported(scene, sheet, material)
            report = end.export(export, of, found, report, overwrite, simulators or ())
        end(report, instead=tables.to_toml(found.as_dict()) if toml else None)
