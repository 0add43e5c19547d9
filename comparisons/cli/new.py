"""`sheetbench new FILE`: a commented scene to start from."""

from __future__ import annotations

import sys
import tomllib
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, TypeVar
from warnings import warn

import typer

from comparisons.cli.options import SheetOptions, option

if TYPE_CHECKING:
    from sheetbench.scenes import Material, Sheet

Answer = TypeVar("Answer")
SHEET = {"length_x": 0.3, "length_y": 0.2, "thickness": 0.002}
MATERIAL = {"young": 1.2e6, "poisson": 0.45, "density": 1100.0}
USUAL = SHEET | MATERIAL  # unless given or answered
QUESTIONS = {
    "length_x": ("Side along x [m], or as 300 mm", "m"),
    "length_y": ("Side along y [m]", "m"),
    "thickness": ("Thickness [m], or as 2 mm", "m"),
    "young": ("Young's modulus E [Pa], or as 1.2 MPa", "Pa"),
    "poisson": ("Poisson's ratio ν, below 0.5", ""),
    "density": ("Density [kg/m³], or as 1.1 g/cm³; water's is 1000", "kg/m³"),
    "pressure": ("Pressure besides the weight [Pa], upwards; 0 for none", "Pa"),
}


def command(
    file: Annotated[Path, typer.Argument(metavar="FILE", help="The TOML file to write.")],
    sheet: SheetOptions,
    *,
    clamped: Annotated[
        str | None, option("x0, x1, y0, y1; several with commas. Default: x0.", "EDGES", listed=True)
    ] = None,
    overwrite: Annotated[bool, option("Replace the file where there is one.")] = False,
) -> Path | None:
    """Write a commented scene to start from.

    The scene is a sheet under its own weight, with what can be added as comments. On a terminal,
    without options, it asks for each value. The JSON Schema is written beside the file, for editors.
    """
    from comparisons.cli import console
    from sheetbench.answers.files import to_json, write_text
    from sheetbench.errors import BadInput, Implausible
    from sheetbench.files import require_file
    from sheetbench.scenes import Pressure, Scene
    from sheetbench.scenes.language.schema import for_editors
    from sheetbench.scenes.meaning.plausibility import slips
    from sheetbench.scenes.template import SCHEMA, template

    require_file(file)
    if file.exists() and not overwrite:
        raise BadInput(f"{file}: exists already; --overwrite replaces it")
    if not file.parent.is_dir():
        raise BadInput(f"{file}: there is no folder {file.parent}")
    values = {key: value for key, value in sheet.values.items() if value is not None}
    pressure, asking = 0.0, False
    if not values and clamped is None and _at_a_terminal():
        values, clamped, pressure = _answers_from_terminal()
        asking = True
    loads = [Pressure(pressure)] if pressure else []
    text = template(file.stem, *_made({**USUAL, **values}), _edges(clamped or "x0"), loads)
    for slip in slips(Scene.model_validate(tomllib.loads(text))):
        warn(Implausible(f"{file}: {slip}"), stacklevel=2)
        if asking and not typer.confirm("Write it all the same?", default=True):
            return None
    write_text(file, text)
    write_text(file.parent / SCHEMA, to_json(for_editors(Scene)))
    console.note(f"{file} written, and {SCHEMA} beside it for editors")
    console.note(f"Next:  sheetbench check {file}")
    return file


def _made(values: dict[str, float]) -> tuple[Sheet, Material]:
    from comparisons.models.quantities import checked
    from sheetbench import scenes

    sheet = checked(scenes.Sheet, {key: values[key] for key in SHEET})
    return sheet, checked(scenes.Material, {key: values[key] for key in MATERIAL})


def _at_a_terminal() -> bool:
    return sys.stdin.isatty() and sys.stdout.isatty()


def _edges(text: str) -> list[str]:
    """Return the edges named, with commas between them. Raises BadInput for what is none."""
    from sheetbench.errors import require_choice
    from sheetbench.scenes.objects.sheet import EDGES

    edges = list(dict.fromkeys(edge.strip() for edge in text.split(",")))
    for edge in edges:
        require_choice("--clamped", edge, EDGES)
    return edges


def _answers_from_terminal() -> tuple[dict[str, float], str, float]:
    """Return values, clamped edges and a pressure [Pa] from the terminal, each prompted until it is valid."""
    from sheetbench import scenes

    def described(keys: dict[str, float], kind: Any) -> dict[str, float]:
        answers = {key: _quantity(key, usual) for key, usual in keys.items()}
        kind(**answers)  # refuses
        return answers

    def edges() -> str:
        question = f"Clamped edges, of {', '.join(scenes.EDGES)}; several with commas"
        return ",".join(_edges(typer.prompt(question, default="x0")))

    sheet = _until_valid(lambda: described(SHEET, scenes.Sheet))
    material = _until_valid(lambda: described(MATERIAL, scenes.Material))
    return sheet | material, _until_valid(edges), _quantity("pressure", 0.0)


def _quantity(key: str, usual: float) -> float:
    """Return the answer to a question, in SI units."""
    from sheetbench.scenes.language.units import quantity

    question, unit = QUESTIONS[key]
    return _until_valid(lambda: quantity(typer.prompt(question, default=f"{usual:g}"), unit))


def _until_valid(ask: Callable[[], Answer]) -> Answer:
    """Return the answer, with the question repeated while it is refused."""
    from comparisons.cli import console
    from sheetbench.errors import BadInput

    while True:
        try:
            return ask()
        except BadInput as error:
            console.warn(str(error))
