"""`sheetbench new FILE`: a commented scene to start from."""

from __future__ import annotations

import tomllib
from pathlib import Path

from comparisons.cli.options import SheetOptions

SHEET = {"length_x": 0.3, "length_y": 0.2, "thickness": 0.002}  # unless given
MATERIAL = {"young": 1.2e6, "poisson": 0.45, "density": 1100.0}


def command(
    file: Path,
    sheet: SheetOptions,
    *,
    clamped: list[str] | None = None,
    overwrite: bool = False,
) -> Path:
    """Write a commented scene to start from.

    The scene is a sheet under its own weight, with what can be added as comments. The JSON Schema is written
    beside the file, for editors.

    Args:
        file (FILE, argument): The TOML file to write.
        density (KG/M3): Density: 1100 or 1.1g/cm3; default: 1100 kg/m³.
        clamped (EDGES): x0, x1, y0, y1. Default: x0.
        overwrite: Replace the file where there is one.
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
    given = {key: value for key, value in sheet.values.items() if value is not None}
    of_sheet, of_material = (
        {key: given.get(key, usual[key]) for key in usual} for usual in (SHEET, MATERIAL)
    )
    edges = list(dict.fromkeys(clamped or ["x0"]))
    for edge in edges:
        require_choice("--clamped", edge, EDGES)
    text = template(file.stem, checked(Sheet, of_sheet), checked(Material, of_material), edges)
    if found := slips(Scene.model_validate(tomllib.loads(text))):
        raise BadInput(f"{file} is not written: {'; '.join(found)}")
    write_text(file.parent / SCHEMA, to_json(for_editors(Scene)))  # a disk that is full leaves no scene
    write_text(file, text)
    console.note(f"{file} written, and {SCHEMA} beside it for editors")
    console.note(f"Next:  sheetbench check {file}")
    return file
