"""`sheetbench crosscheck SCENE…`: lattice, references and external codes side by side."""

from __future__ import annotations

from typing import Annotated, Any

import typer

from comparisons.cli.lattice_options import SpringOptions
from comparisons.cli.options import Calibration, Large, option
from comparisons.cli.verb import CampaignOptions, OutputOptions
from sheetbench.choices import REFERENCES

SIZES = {"lumped": "9,13,17", "plate": "8,12,16", "shell": "8,12,16", "solid": "6,8,12"}


def _sizes(what: str, name: str, *names: str) -> Any:
    """The option of a model's sizes."""
    return option(f"{what} along the shorter side, in rising order. Default: {SIZES[name]}.", "N,N,N", *names)


def command(
    scenes: Annotated[
        list[str],
        typer.Argument(metavar="SCENES", help="Catalogue names or paths to TOML files; all: the catalogue."),
    ],
    lattice: SpringOptions,
    grid: Annotated[str | None, _sizes("Masses of the lattice", "lumped", "--lumped", "--grid")] = None,
    calibration: Calibration = None,
    plate: Annotated[str | None, _sizes("Elements of the linear plate", "plate")] = None,
    shell: Annotated[str | None, _sizes("Elements of the nonlinear shell", "shell")] = None,
    solid: Annotated[str | None, _sizes("Elements of the nonlinear solid", "solid")] = None,
    judges: Annotated[
        str | None,
        option("External codes, with commas, or FILE.py:OBJECT; default: all that are installed.", "NAMES"),
    ] = None,
    meshes: Annotated[
        str | None, option("Elements of external codes. Default: each code's own.", "N,N,N")
    ] = None,
    large: Large = False,
    *,
    campaign: CampaignOptions,
    output: OutputOptions,
) -> None:
    """Compare models with external finite-element codes, each with its mesh convergence.

    An empty list leaves a model, or all external codes, out: --solid "". An interrupted run is resumed.
    """
    from comparisons.crosscheck.candidates import candidates, load_scenes
    from comparisons.crosscheck.crosscheck import crosscheck
    from comparisons.external.installed import find_codes
    from comparisons.models.spec import items

    codes = find_codes(None if judges is None else items(judges))
    given = dict(zip(("lumped", *REFERENCES), (grid, plate, shell, solid), strict=True))
    sizes = {name: SIZES[name] if text is None else text for name, text in given.items()}
    models = candidates(sizes.pop("lumped"), lattice.spec.but(calibration=calibration), sizes, codes, meshes)
    chosen = load_scenes(scenes)
    with output.open(about={"scenes": [scene.document() for scene in chosen]}) as out:
        with out.campaign(campaign) as run:
            checked = crosscheck(chosen, **run, models=models, codes=codes)
        out.show(checked)
