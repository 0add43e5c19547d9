"""`sheetbench study coverage`: how often the references' error bars hold."""

from __future__ import annotations

from typing import Annotated

from comparisons.cli.options import CampaignOptions, option
from comparisons.cli.output import OutputOptions
from sheetbench.choices import REFERENCES
from sheetbench.errors import require_choice
from studies.coverage import study


def command(
    scenes: Annotated[
        int,
        option(
            "Scenes drawn. Each takes half a minute of one processor, less than half without the solid.",
            "N",
            min=1,
        ),
    ] = 40,
    seed: Annotated[int, option("Seed of the scenes.", "N", min=0)] = 41,
    model: Annotated[list[str] | None, option("Only plate, shell or solid; may be repeated.", "NAME")] = None,
    *,
    campaign: CampaignOptions,
    output: OutputOptions,
) -> None:
    """Measure how often the references' error bars hold the error, on drawn scenes.

    Exit status 3 unless 95 % of the components are inside, the bars no looser than five errors. With --out an
    interrupted study is resumed.
    """
    for name in model or ():
        require_choice("model", name, REFERENCES)
    with output.open() as out:
        with out.campaign(campaign) as run:
            coverage = study.coverage(
                **run,
                count=scenes,
                seed=seed,
                models=[name for name in study.MODELS if name in (model or study.MODELS)],
            )
        out.show(coverage)
