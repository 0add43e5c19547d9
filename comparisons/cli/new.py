"""`sheetbench new FILE`: a commented scene to start from."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from comparisons.cli.options import Poisson, Side, Thickness, Young

if TYPE_CHECKING:
    from sheetbench.scenes import Material, Sheet

SHEET = {"length_x": 0.3, "length_y": 0.2, "thickness": 0.002}
MATERIAL = {"young": 1.2e6, "poisson": 0.45, "density": 1100.0}
USUAL = SHEET | MATERIAL  # unless given or answered
QUESTIONS = {
    "length_x": "Side along x [m]",
    "length_y": "Side along y [m]",
    "thickness": "Thickness [m]",
    "young": "Young's modulus E [Pa]; 1 MPa is 1e6",
    "poisson": "Poisson's ratio ν, below 0.5",
    "density": "Density [kg/m³]; water's is 1000",
}


def command(
    file: Annotated[Path, typer.Argument(metavar="FILE", help="The TOML file to write.")],
    side: Side = None,
    thickness: Thickness = None,
    young: Young = None,
    poisson: Poisson = None,
    density: Annotated[float | None, typer.Option(metavar="KG/M3", help="Density.")] = None,
    clamped: Annotated[
        str | None,
        typer.Option(metavar="EDGES", help="x0, x1, y0, y1; several with commas. x0 unless given."),
    ] = None,
    overwrite: Annotated[
        bool, typer.Option("--overwrite", help="Replace the file where there is one.", show_default=False)
    ] = False,
) -> None:
    """Write a commented scene to start from: a sheet under its own weight, and what else there may be.

    On a terminal, without options, it asks. Beside the file it leaves the JSON Schema, for editors.
    """
    from comparisons.cli import console
    from comparisons.models.quantities import sides
    from comparisons.report.files import to_json, write_text
    from sheetbench.files import require_file
    from sheetbench.scenes import Scene, load
    from sheetbench.scenes.errors import BadInput, require_choice
    from sheetbench.scenes.schema import for_editors
    from sheetbench.scenes.sheet import EDGES
    from sheetbench.scenes.template import SCHEMA, template

    require_file(file)
    if file.exists() and not overwrite:
        raise BadInput(f"{file}: exists already; --overwrite replaces it")
    if not file.parent.is_dir():
        raise BadInput(f"{file}: there is no folder {file.parent}")
    given = {"thickness": thickness, "young": young, "poisson": poisson, "density": density}
    values = {key: value for key, value in {**given, **sides(side)}.items() if value is not None}
    if not values and clamped is None and sys.stdin.isatty() and sys.stdout.isatty():
        values, clamped = _asked()
    edges = list(dict.fromkeys(edge.strip() for edge in (clamped or "x0").split(",")))
    for edge in edges:
        require_choice("--clamped", edge, EDGES)
    text = template(file.stem, *_made({**USUAL, **values}), edges)
    write_text(file, text)
    write_text(file.parent / SCHEMA, to_json(for_editors(Scene)))
    load(file)  # warns of what is hardly meant
    console.note(f"{file} written, and {SCHEMA} beside it for editors")
    console.note(f"Next:  sheetbench check {file}")


def _made(values: dict[str, float]) -> tuple[Sheet, Material]:
    from comparisons.models.quantities import checked
    from sheetbench import scenes

    sheet = checked(scenes.Sheet, {key: values[key] for key in SHEET})
    return sheet, checked(scenes.Material, {key: values[key] for key in MATERIAL})


def _asked() -> tuple[dict[str, float], str]:
    """The answers of whoever sits at the terminal, asked again until they make sense."""
    from comparisons.cli import console
    from sheetbench import scenes
    from sheetbench.scenes.errors import BadInput

    values: dict[str, float] = {}
    for keys, kind in ((SHEET, scenes.Sheet), (MATERIAL, scenes.Material)):
        while True:
            answers = {key: typer.prompt(QUESTIONS[key], default=keys[key], type=float) for key in keys}
            try:
                kind(**answers)
            except BadInput as error:
                console.warn(str(error))
            else:
                values |= answers
                break
    edges = ", ".join(scenes.EDGES)
    return values, typer.prompt(f"Clamped edges, of {edges}; several with commas", default="x0")
