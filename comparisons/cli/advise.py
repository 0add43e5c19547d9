"""`sheetbench advise SCENE`: the cheapest model that is good enough."""

from __future__ import annotations

from typing import Annotated

import typer

from comparisons.cli.options import Json, Out, Scene, command_line


def command(
    scene: Scene,
    tolerance: Annotated[
        float | None,
        typer.Option(metavar="FRACTION", help="Error allowed; 0.01 unless a budget alone is given."),
    ] = None,
    budget: Annotated[
        float | None, typer.Option(metavar="SECONDS", help="Time that a solve may take; setting up apart.")
    ] = None,
    json: Json = False,
    out: Out = None,
) -> None:
    """Name the cheapest model that meets a tolerance, or the most accurate one within a budget.

    A few quick solves measure this machine and this scene. Exit status 3 where what is asked cannot be had.
    """
    from comparisons.advice import tables
    from comparisons.advice.advisor import advise, checked_tolerance
    from comparisons.cli import console
    from comparisons.cli.app import NOT_CONVERGED
    from comparisons.comparison.comparison import load_static
    from comparisons.report.files import folder, to_json, write_text
    from comparisons.runs.manifest import manifest
    from sheetbench.scenes.errors import BadInput

    asked = load_static(scene)
    if budget is not None and not budget > 0.0:
        raise BadInput(f"--budget = {budget:g}: seconds, more than 0")
    if tolerance is None and budget is None:
        tolerance = 0.01
    if tolerance is not None:
        checked_tolerance(tolerance)
    with console.progress() as progress:
        progress("probing …")
        advice = advise(asked, tolerance, budget)
    if out is not None:
        files = {
            "advice.json": to_json(advice.as_dict()),
            "tried.csv": tables.tried(advice).to_csv(),
            "manifest.json": to_json(manifest(asked, {}, command_line())),
        }
        for name, text in files.items():
            write_text(folder(out) / name, text)
    if json:
        print(to_json(advice.as_dict()), end="")
    else:
        console.heading(asked.name, asked.title)
        console.show(tables.tried(advice))
        for said in tables.sentences(advice):
            console.note(said)
    if not advice.met:
        console.warn(advice.reason)
        raise typer.Exit(NOT_CONVERGED)
