"""`sheetbench score ANSWERS.csv`: somebody's answers against the reference set."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from comparisons.cli.options import option
from comparisons.cli.output import PictureOptions


def command(
    answers: Annotated[
        Path, typer.Argument(metavar="ANSWERS", help="CSV: case,probe[,time],ux,uy,uz[,seconds] in m, s.")
    ],
    suite: Annotated[
        str | None,
        option(
            "The suite answered: statics, motion, modes or curves. Default: by the file's header and cases.",
            "NAME",
            "--suite",
        ),
    ] = None,
    case: Annotated[list[str] | None, option("Only this case; may be repeated.", "NAME")] = None,
    *,
    output: PictureOptions,
) -> None:
    """Score answers to the reference set: errors, what is wrong with them, the place beside other models.

    `sheetbench suite --out DIR` writes the scenes and a form to fill in; cases left empty are left out. Exit
    status 3 where units, signs or probes are mistaken.
    """
    from comparisons.scoring.cases import SUITES
    from comparisons.scoring.score import score
    from sheetbench.errors import require_choice

    if suite is not None:
        require_choice("--suite", suite, SUITES)
    with output.open(variant={"--suite": suite, "--case": sorted(case) if case else None}) as out:
        out.show(score(answers, suite, case or ()))
