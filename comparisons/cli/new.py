"""`sheetbench new FILE`: a commented scene to start from."""

from __future__ import annotations

import tomllib
from pathlib import Path
from typing import Any

from comparisons.cli.options import SheetOptions

SHEET = {"length_x": 0.3, "length_y": 0.2, "thickness": 0.002}  # defaults
MATERIAL = {"young": 1.2e6, "poisson": 0.45, "density": 1100.0}
NAMES = {"length_x": "side along x", "length_y": "side along y", "thickness": "thickness"}
NAMES |= {"young": "E", "poisson": "ν", "density": "ρ"}
UNITS = dict.fromkeys(SHEET, "m") | {"young": "Pa", "poisson": "", "density": "kg/m³"}
QUESTIONS = {  # with the default answers
    "side": ("Sides, x by y", "300x200mm"),
    "thickness": ("Thickness", "2mm"),
    "young": ("Young's modulus E", "1.2MPa"),
    "poisson": ("Poisson's ratio ν (rubber 0.45 to 0.4999)", "0.45"),
    "density": ("Density ρ", "1100kg/m3"),
    "clamped": ("Clamped edges, of x0, x1, y0, y1", "x0"),
    "pressure": ("Pressure besides its weight, 0 for none", "0Pa"),
}


def command(
    file: Path,
    sheet: SheetOptions,
    *,
    clamped: list[str] | None = None,
    overwrite: bool = False,
) -> Path:
    """Write a commented scene to start from.

    The scene is a sheet under its own weight, with optional parts as comments. Without options on a terminal,
    the command prompts for values. The JSON Schema is written next to the file, for editors.

    Args:
        file (FILE, argument): The TOML file to write.
        density (KG/M3): Density: 1100 or 1.1g/cm3; default: 1100 kg/m³.
        clamped (EDGES): x0, x1, y0, y1. Default: x0.
        overwrite: Replace an existing file.
    """
    from comparisons.cli import console
    from comparisons.models.quantities import checked
    from comparisons.models.template import SCHEMA, template
    from sheetbench.answers.files import to_json, write_text
    from sheetbench.errors import BadInput, require_choice
    from sheetbench.files import require_file
    from sheetbench.scenes import EDGES, Material, Scene, Sheet
    from sheetbench.scenes.language.schema import for_editors
    from sheetbench.scenes.meaning.plausibility import slips

    require_file(file)
    if file.exists() and not overwrite:
        raise BadInput(f"{file}: exists already; --overwrite replaces it")
    if not file.parent.is_dir():
        raise BadInput(f"{file}: there is no folder {file.parent}")
    given, pressure = {key: value for key, value in sheet.values.items() if value is not None}, 0.0
    if not given and not clamped and console.is_interactive():
        given, clamped, pressure = _prompted()
    sheet_values, material_values = (
        {key: given.get(key, defaults[key]) for key in defaults} for defaults in (SHEET, MATERIAL)
    )
    edges = list(dict.fromkeys(clamped or ["x0"]))
    for edge in edges:
        require_choice("--clamped", edge, EDGES)
    text = template(
        file.stem, checked(Sheet, sheet_values), checked(Material, material_values), edges, pressure
    )
    if mistakes := slips(Scene.model_validate(tomllib.loads(text))):
        raise BadInput(f"{file} is not written: {'; '.join(mistakes)}")
    write_text(file.parent / SCHEMA, to_json(for_editors(Scene)))  # first: a full disk then leaves no scene
    write_text(file, text)
    console.note(f"{file} written, and {SCHEMA} next to it for editors")
    defaults = {key: value for key, value in (sheet_values | material_values).items() if key not in given}
    assumed = [f"{NAMES[key]} = {value:g} {UNITS[key]}".rstrip() for key, value in defaults.items()]
    assumed += [] if clamped else ["clamped at x0"]
    if assumed:
        console.note(f"Assumed, to be changed in the file: {', '.join(assumed)}; weight along −z.")
    console.note(f"Next:  sheetbench check {file}")
    return file


def _prompted() -> tuple[dict[str, Any], list[str], float]:
    """Prompt for values of sheet and material by key, edges, and a pressure [Pa]; repeat invalid ones."""
    import typer

    from comparisons.cli import console
    from comparisons.models.quantities import sides
    from sheetbench.errors import BadInput, require_choice
    from sheetbench.scenes import EDGES
    from sheetbench.scenes.language.units import amount

    def parsed(key: str, text: str) -> Any:
        if key == "side":
            return sides(text)
        if key == "clamped":
            edges = text.replace(",", " ").split()
            for edge in edges:
                require_choice("edge", edge, EDGES)
            return edges
        return amount(key, text, UNITS.get(key, "Pa"))

    values: dict[str, Any] = {}
    for key, (question, default) in QUESTIONS.items():
        while key not in values:
            try:
                values[key] = parsed(key, typer.prompt(question, default=default))
            except BadInput as error:
                console.warn(str(error))
    size, edges, pressure = values.pop("side"), values.pop("clamped"), values.pop("pressure")
    return {**size, **values}, edges, pressure
