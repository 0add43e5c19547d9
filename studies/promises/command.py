"""`sheetbench study promises`: error bars, expected errors and advice beside the errors that there are."""

from __future__ import annotations

from typing import Annotated, Any

from comparisons.cli import console
from comparisons.cli.options import CampaignOptions, Count, Kind
from comparisons.cli.output import OutputOptions
from sheetbench.choices import REFERENCES
from studies.promises import study
from studies.promises.answer import Promise, Promises
from studies.promises.expected import expected_errors, solve_again
from studies.promises.scenes import KINDS

PARTS = ("bars", "expected", "advice", "kinds")


def command(
    part: Annotated[list[str] | None, Kind(choices=PARTS)] = None,
    scenes: Count = study.SCENES,
    seed: Annotated[int, Kind(least=0)] = study.SEED,
    model: Annotated[list[str] | None, Kind(choices=tuple(REFERENCES))] = None,
    kind: Annotated[list[str] | None, Kind(choices=KINDS)] = None,
    anew: bool = False,
    *,
    campaign: CampaignOptions,
    output: OutputOptions,
) -> Any:
    """Measure how often promised errors hold: the references' bars, expected errors, advice's tolerance.

    Exit status 3 unless as many hold as required. An interrupted study with --out is resumed.

    Args:
        part (NAMES): Only {PARTS}. All unless given.
        scenes (N): Scenes drawn, for bars half a minute of one processor each.
        seed (N): Seed of the scenes.
        model (NAMES): Bars of {REFERENCES}.
        kind (NAMES): Scenes of the part kinds, of {KINDS}: bars and expected errors.
        anew: Solve the stored scenes of expected errors again."""
    parts, rows, skipped = part or PARTS, list[Promise](), dict[str, str]()
    with output.open() as out:
        if anew:
            solve_again(console.print_status)
        with out.campaign(campaign) as run:
            if "bars" in parts:
                models = [name for name in study.MODELS if name in (model or study.MODELS)]
                rows, skipped = study.bars(count=scenes, seed=seed, models=models, **run)
            if "expected" in parts:
                rows += expected_errors()
            if "advice" in parts:
                advice, replaced = study.advised(count=scenes, seed=seed, **run)
                rows, skipped = rows + advice, skipped | replaced
            if "kinds" in parts:
                by_kind, replaced = study.by_kind(count=scenes, kinds=kind or KINDS, seed=seed, **run)
                rows, skipped = rows + by_kind, skipped | replaced
        return out.show(Promises(tuple(rows), skipped))
