"""`sheetbench study advisor`: the advisor on scenes drawn at random."""

from __future__ import annotations

import os
from typing import Annotated

import typer

from comparisons.cli.finish import finish
from comparisons.cli.options import Json, Out, Workers
from studies.advisor.study import study


def command(
    scenes: Annotated[int, typer.Option(min=1, metavar="N", help="Scenes drawn.")] = 60,
    compared: Annotated[
        int, typer.Option(min=0, metavar="N", help="Scenes on which its time is compared with other models'.")
    ] = 20,
    workers: Workers = None,
    json: Json = False,
    out: Out = None,
) -> None:
    """Check the advisor on random scenes: whether its choice meets the tolerance, and what it costs.

    With --out an interrupted study is resumed.
    """
    with finish("advisor-study", json, out) as end:
        with end.campaign() as (store, _, progress):
            found = study(store, scenes, compared, workers=workers or os.cpu_count() or 1, progress=progress)
        end(found.report())
