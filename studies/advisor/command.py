"""`sheetbench study advisor`: the advisor on scenes drawn at random."""

from __future__ import annotations

from typing import Annotated

from comparisons.cli.options import CampaignOptions, option
from comparisons.cli.output import OutputOptions
from studies.advisor.study import study


def command(
    scenes: Annotated[int, option("Scenes drawn.", "N", min=1)] = 60,
    compared: Annotated[
        int, option("Scenes on which its time is compared with other models'.", "N", min=0)
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
