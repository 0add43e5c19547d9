"""`sheetbench modes SCENE`: the natural frequencies of the lattice and of a reference."""

from __future__ import annotations

from typing import Annotated

import typer

from comparisons.cli.options import Grid, Json, Large, Out, Overwrite, Scene


def command(
    scene: Scene,
    count: Annotated[int, typer.Option(metavar="N", help="How many modes, lowest first.")] = 10,
    lumped: Grid = None,
    calibration: Annotated[
        str | None, typer.Option(metavar="NAME", help="How k is found; consistent unless given.")
    ] = None,
    reference: Annotated[
        list[str] | None,
        typer.Option(metavar="MODEL", help="plate, shell or solid; may be repeated. The shell unless given."),
    ] = None,
    elements: Annotated[
        int, typer.Option(metavar="N", help="The reference's elements along the shorter side.")
    ] = 16,
    about: Annotated[
        str,
        typer.Option(
            metavar="flat|deformed",
            help="About the flat, stress-free sheet, or its equilibrium under its loads (lattice and shell).",
        ),
    ] = "flat",
    large: Large = False,
    json: Json = False,
    out: Out = None,
    overwrite: Overwrite = False,
) -> None:
    """List the natural frequencies of the lattice and a reference, about the flat sheet or the deformed."""
    from comparisons.cli.finish import finish
    from comparisons.modes.spectra import spectra
    from sheetbench.scenes import load
    from sheetbench.scenes.errors import NoEquilibrium

    asked = load(scene)
    with finish("modes", json, out, overwrite, scene=asked) as end:
        try:
            found = spectra(
                asked,
                count=count,
                grid=lumped,
                calibration=calibration,
                references=reference or ["shell"],
                elements=elements,
                about=about,
                large=large,
                starting=lambda model: end.progress(f"modes of {model} …"),
            )
        except NoEquilibrium as error:
            end.stop(f"no modes about the deformed sheet: {error}")
        end(found.report())
