"""`sheetbench study advisor`: the advisor on scenes drawn at random."""

from __future__ import annotations

from typing import Annotated

import typer

from comparisons.cli.verb import CampaignOptions, OutputOptions
from studies.advisor.study import study


def command(
    scenes: Annotated[int, typer.Option(min=1, metavar="N", help="Scenes drawn.")] = 60,
    compared: Annotated[
        int, typer.Option(min=0, metavar="N", help="Scenes on which its time is compared with other models'.")
    ] = 20,
    *,
    campaign: CampaignOptions,
    output: OutputOptions,
) -> None:
    """Check the advisor on random scenes: whether its choice meets the tolerance, and what it costs.

    With --out an interrupted study is resumed.
    """
    with output.open() as out:
        with out.campaign(campaign) as run:
            result = study(count=scenes, compared=compared, **run)
        out.show(result)
