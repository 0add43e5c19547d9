"""`sheetbench crosscheck SCENE…`: lattice, references and external codes side by side."""

from __future__ import annotations

from typing import Annotated

import typer

from comparisons.cli.lattice_options import SpringOptions
from comparisons.cli.options import Calibration, Large, option
from comparisons.cli.verb import CampaignOptions, OutputOptions
from sheetbench.choices import REFERENCES


def command(
    scenes: Annotated[
        list[str],
        typer.Argument(metavar="SCENES", help="Catalogue names or paths to TOML files; all: the catalogue."),
    ],
    lattice: SpringOptions,
    grid: Annotated[
        str, option("Masses of the lattice along the shorter side, rising.", "N,N,N", "--lumped", "--grid")
    ] = "9,13,17",
    calibration: Calibration = None,
    plate: Annotated[str, option("Elements of the linear plate, rising.", "N,N,N")] = "8,12,16",
    shell: Annotated[str, option("Elements of the nonlinear shell.", "N,N,N")] = "8,12,16",
    solid: Annotated[str, option("Elements of the nonlinear solid.", "N,N,N")] = "6,8,12",
    judges: Annotated[
        str | None,
        option(
            "External codes, with commas, or FILE.py:OBJECT; all that are installed unless given.", "NAMES"
        ),
    ] = None,
    meshes: Annotated[
        str | None, option("Elements of external codes; each one's own unless given.", "N,N,N")
    ] = None,
    large: Large = False,
    *,
    campaign: CampaignOptions,
    output: OutputOptions,
) -> None:
    """Compare models with external finite-element codes, each with its mesh convergence.

    Give an empty list to leave a model or all external codes out (--solid ""). Interrupted runs resume.
    """
    from comparisons.crosscheck.candidates import candidates, load_scenes
    from comparisons.crosscheck.crosscheck import crosscheck
    from comparisons.external.installed import find_codes
    from comparisons.models.spec import items

    chosen = load_scenes(scenes)
    codes = find_codes(None if judges is None else items(judges))
    references = dict(zip(REFERENCES, (plate, shell, solid), strict=True))
    models = candidates(grid, lattice.spec.but(calibration=calibration), references, codes, meshes)
    about = {"scenes": [scene.document() for scene in chosen]}
    with output.open(about=about) as out:
        with out.campaign(campaign) as run:
            checked = crosscheck(chosen, **run, models=models, codes=codes)
        out.show(checked)
