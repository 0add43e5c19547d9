"""`sheetbench calibrate`: spring constants from E, ν, density, thickness, sides and grid."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Any
from warnings import warn

import typer

from comparisons.cli.options import Grid, Json, Large, Out, Overwrite
from comparisons.cli.quantities import checked, sides

if TYPE_CHECKING:
    from sheetbench.scenes import Material, Scene, Sheet

DENSITY = 1000.0  # kg/m³


def command(
    scene: Annotated[
        str | None,
        typer.Argument(metavar="[SCENE]", help="Take sheet and material from here.", show_default=False),
    ] = None,
    young: Annotated[float | None, typer.Option(metavar="PA", help="Young's modulus E.")] = None,
    poisson: Annotated[float | None, typer.Option(metavar="NU", help="Poisson's ratio ν.")] = None,
    thickness: Annotated[float | None, typer.Option(metavar="M", help="Thickness of the sheet.")] = None,
    density: Annotated[
        float | None,
        typer.Option(metavar="KG/M3", help="Density; 1000 kg/m³ unless given.", show_default=False),
    ] = None,
    side: Annotated[str | None, typer.Option(metavar="M", help="Sides: 0.188 or 0.188x0.3 (x by y).")] = None,
    grid: Grid = None,
    method: Annotated[str, typer.Option(metavar="NAME", help="consistent, uniform, …")] = "consistent",
    k: Annotated[
        float | None, typer.Option(metavar="N/M", help="Stiffness of every spring (uniform only).")
    ] = None,
    layer_distance: Annotated[
        float | None, typer.Option(metavar="M", help="Distance of the lattice's layers.")
    ] = None,
    toml: Annotated[
        bool, typer.Option("--toml", help="Print the \\[springs] table for a scene file.")
    ] = False,
    large: Large = False,
    json: Json = False,
    out: Out = None,
    overwrite: Overwrite = False,
) -> None:
    """Find the spring constants of a lattice, and report which of the sheet's moduli they meet.

    Give a SCENE, or --young --poisson --thickness --side; with both, the options change the scene's values.
    The fitted methods train on the SCENE; without one, on the sheet under its own weight with one edge and
    with two adjacent edges clamped.
    """
    from comparisons.calibration import tables
    from comparisons.cli.finish import finish
    from comparisons.models.grids import parse_grid
    from comparisons.models.registry import calibrate
    from sheetbench.scenes.errors import BadInput
    from sheetbench.scenes.grid import MASSES

    if toml and json:
        raise BadInput("--toml and --json: choose one")
    sheet, material = _sheet_and_material(
        scene,
        {"thickness": thickness, **sides(side)},
        {"young": young, "poisson": poisson, "density": density},
    )
    about = {"sheet": sheet.model_dump(mode="json"), "material": material.model_dump(mode="json")}
    with finish("calibrate", json, out, overwrite, about=about) as end:
        found = calibrate(
            sheet,
            material,
            grid=parse_grid(sheet, grid) if grid is not None else MASSES,
            calibration=method,
            k=k,
            layer_distance=layer_distance,
            training=_training(scene, sheet, material) if scene is not None else None,
            large=large,
        )
        end(tables.report(found, sheet, material), instead=tables.to_toml(found.as_dict()) if toml else None)


def _training(name: str, sheet: Sheet, material: Material) -> list[Scene]:
    """The named scene with this sheet and material, for a fitted method to train on."""
    from comparisons.comparison.comparison import load_static
    from sheetbench import scenes

    scene = load_static(name)
    changed = {"sheet": sheet.model_dump(), "material": material.model_dump(), "probes": {}}
    return [checked(scenes.Scene, {**scene.model_dump(by_alias=True, exclude_none=True), **changed})]


def _sheet_and_material(
    scene: str | None, sheet: dict[str, float | None], material: dict[str, float | None]
) -> tuple[Sheet, Material]:
    """The scene's sheet and material with what is given put in its place, or those of the options alone.

    Warns of what the options make implausible.
    """
    from sheetbench import scenes
    from sheetbench.scenes.errors import BadInput, Implausible
    from sheetbench.scenes.plausibility import material_slips, sheet_slips

    sheet_data: dict[str, Any] = {}
    material_data: dict[str, Any] = {"density": DENSITY}
    known: list[str] = []  # slips of the scene's own, which loading it has told
    if scene is not None:
        loaded = scenes.load(scene)
        known = [*sheet_slips(loaded.sheet), *material_slips(loaded.material)]
        sheet_data, material_data = loaded.sheet.model_dump(), loaded.material.model_dump()
    sheet_data |= {key: value for key, value in sheet.items() if value is not None}
    material_data |= {key: value for key, value in material.items() if value is not None}
    missing = [
        f"--{option}"
        for option, key, data in (
            ("young", "young", material_data),
            ("poisson", "poisson", material_data),
            ("thickness", "thickness", sheet_data),
            ("side", "length_x", sheet_data),
        )
        if key not in data
    ]
    if missing:
        raise BadInput(f"missing {', '.join(missing)}; give them, or a SCENE to take them from")
    changed = checked(scenes.Sheet, sheet_data), checked(scenes.Material, material_data)
    for said in [*sheet_slips(changed[0]), *material_slips(changed[1])]:
        if said not in known:
            warn(Implausible(said), stacklevel=2)
    return changed
