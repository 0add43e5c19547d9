"""`sheetbench study transfer`: calibrations judged on scenes that they were not made on."""

from __future__ import annotations

from typing import Annotated

import typer

from comparisons.cli.options import Grading, Large
from comparisons.cli.verb import CampaignOptions, OutputOptions
from studies.transfer import parse
from studies.transfer.study import transfer


def command(
    methods: Annotated[
        str | None,
        typer.Option(
            metavar="NAMES", help="Calibrations, with commas; all unless given."
        ),
    ] = None,
    grids: Annotated[
        str,
        typer.Option(
            "--grids",
            "--grid",
            "--lumped",
            metavar="N,N,…",
            help="Masses along the shorter side, 4 n + 1, coarsest first."
        ),
    ] = "9,17,33",
    grading: Grading = None,
    scenes: Annotated[
        str | None,
        typer.Option(metavar="NAMES", help="Scenes of the study; all unless given."),
    ] = None,
    part: Annotated[
        list[str] | None,
        typer.Option(
            metavar="NAME",
            help="static, limits, modal, aspect or left-out; may be repeated. All unless given."
        ),
    ] = None,
    elements: Annotated[
        int, typer.Option(min=1, metavar="N", help="Elements of the shell along a side.")
    ] = 24,
    large: Large = False,
    *,
    campaign: CampaignOptions,
    output: OutputOptions,
) -> None:
    """Measure every calibration on many scenes, statics and frequencies, as the grid is refined.

    With --out an interrupted study is resumed.
    """
    calibrations, named = parse.methods(methods), parse.scenes(scenes)
    parts, sizes = parse.parts(part), parse.grids(grids)
    with output.open() as out:
        with out.campaign(campaign) as run:
            result = transfer(
                **run,
                methods=calibrations,
                grids=sizes,
                grading=grading,
                scenes=named,
                parts=parts,
                elements=elements,
                large=large,
            )
        out.show(result)
