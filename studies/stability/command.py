"""`sheetbench study stability`: where each model holds, on published scenes and at extremes."""

from __future__ import annotations

from typing import Annotated, Any

from comparisons.cli.options import CampaignOptions, Kind
from comparisons.cli.output import PictureOptions
from sheetbench.errors import BadInput
from studies.stability.study import PARTS, maps


def command(
    part: Annotated[list[str] | None, Kind(choices=tuple(PARTS))] = None,
    *,
    campaign: CampaignOptions,
    output: PictureOptions,
) -> Any:
    """Map where each model holds, degrades, refuses or fails: the verb on published and extreme scenes.

    Neighbouring masses, units of stiffness and families of springs are varied too. An interrupted run with
    --out is resumed.

    Args:
        part (NAMES): Only {PARTS}."""
    if any(style.narrow for style in output.styles):
        raise BadInput("--figure: maps with their numbers need both columns; leave ':single' out")
    with output.open() as out:
        with out.campaign(campaign) as run:
            answer = maps(parts=part or PARTS, **run)
        return out.show(answer)
