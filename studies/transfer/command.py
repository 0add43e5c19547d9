"""`sheetbench study transfer`: calibrations judged on scenes that they were not made on."""

from __future__ import annotations

from typing import Annotated

from comparisons.cli.options import CampaignOptions, Grading, Large, option
from comparisons.cli.output import OutputOptions
from studies.transfer import parse
from studies.transfer.study import transfer


def command(
    methods: Annotated[str | None, option("Calibrations, with commas; all unless given.", "NAMES")] = None,
    grids: Annotated[
        str,
        option(
            "Masses along the shorter side, 4 n + 1, coarsest first.",
            "N,N,…",
            "--grids",
            "--grid",
            "--lumped",
        ),
    ] = "9,17,33",
    grading: Grading = None,
    scenes: Annotated[str | None, option("Scenes of the study; all unless given.", "NAMES")] = None,
    part: Annotated[
        list[str] | None,
        option("static, limits, modal, aspect or left-out; may be repeated. All unless given.", "NAME"),
    ] = None,
    elements: Annotated[int, option("Elements of the shell along a side.", "N", min=1)] = 24,
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
