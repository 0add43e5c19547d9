"""`sheetbench study promises`: error bars, expected errors and advice beside the errors that there are."""

from __future__ import annotations

from typing import Annotated

from comparisons.cli import console
from comparisons.cli.options import CampaignOptions, option
from comparisons.cli.output import OutputOptions
from sheetbench.choices import REFERENCES, listed
from studies.promises import study
from studies.promises.answer import Promise, Promises
from studies.promises.expected import expected_errors, solve_again

PARTS = ("bars", "expected", "advice")


def command(
    part: Annotated[
        list[str] | None,
        option(f"Only {listed(PARTS)}; may be repeated. All unless given.", "NAME", choices=PARTS),
    ] = None,
    scenes: Annotated[
        int, option("Scenes drawn, for bars half a minute of one processor each.", "N", min=1)
    ] = study.SCENES,
    seed: Annotated[int, option("Seed of the scenes.", "N", min=0)] = study.SEED,
    model: Annotated[
        list[str] | None,
        option(f"Bars of {listed(REFERENCES)}; may be repeated.", "NAME", choices=REFERENCES),
    ] = None,
    anew: Annotated[
        bool, option("Solve the stored scenes of expected errors again.", None, "--anew")
    ] = False,
    *,
    campaign: CampaignOptions,
    output: OutputOptions,
) -> None:
    """Measure how often promised errors hold: the references' bars, expected errors, advice's tolerance.

    Exit status 3 unless as many hold as required. With --out an interrupted study is resumed.
    """
    parts, rows, skipped = part or PARTS, list[Promise](), dict[str, str]()
    with output.open() as out:
        if anew:
            solve_again(console.tell)
        with out.campaign(campaign) as run:
            if "bars" in parts:
                models = [name for name in study.MODELS if name in (model or study.MODELS)]
                rows, skipped = study.bars(count=scenes, seed=seed, models=models, **run)
            if "expected" in parts:
                rows += expected_errors()
            if "advice" in parts:
                found, replaced = study.advised(count=scenes, seed=seed, **run)
                rows, skipped = rows + found, skipped | replaced
        out.show(Promises(tuple(rows), skipped))
