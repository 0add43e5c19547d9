"""`sheetbench modes SCENE`: the natural frequencies of the lattice and of a reference."""

from __future__ import annotations

from typing import Annotated

import typer

from comparisons.cli.options import Grid, Json, Out, Scene, command_line


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
    json: Json = False,
    out: Out = None,
) -> None:
    """List the natural frequencies of the lattice and of a reference about the undeformed sheet."""
    from comparisons.cli import console
    from comparisons.modes import spectra as modes
    from comparisons.report.files import folder, to_json, write_text
    from comparisons.runs.manifest import manifest
    from sheetbench.scenes import load

    asked = load(scene)
    target = folder(out) if out is not None else None
    with console.progress() as progress:
        found = modes.spectra(
            asked,
            count=count,
            grid=lumped,
            calibration=calibration,
            references=reference or ["shell"],
            elements=elements,
            starting=lambda model: progress(f"modes of {model} …"),
        )
    document, table = modes.as_dict(asked, found), modes.table(found)
    if target is not None:
        settings = {spectrum.model: spectrum.settings for spectrum in found}
        write_text(target / "modes.json", to_json(document))
        write_text(target / "modes.csv", table.to_csv())
        write_text(target / "modes.md", table.to_markdown())
        write_text(target / "manifest.json", to_json(manifest(asked, settings, command_line())))
    if json:
        print(to_json(document), end="")
    else:
        console.heading(asked.name, asked.title)
        console.show(table)
        for said in modes.notes(asked, found):
            console.note(said)
    if asked.actuators and json:
        console.warn(modes.notes(asked, found)[-1])
