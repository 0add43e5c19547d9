"""`sheetbench score [ANSWERS.csv]`: the reference set, and a user's answers against it."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from comparisons.cli.options import Kind
from comparisons.cli.output import PictureOptions
from comparisons.cli.verb import no_effect
from sheetbench.choices import SUITES

if TYPE_CHECKING:
    from comparisons.scoring.score import Score
    from comparisons.scoring.suite import Suite


@no_effect(without_answers="case")
def command(
    answers: Path | None = None,
    *,
    suite: Annotated[str | None, Kind(choices=SUITES)] = None,
    case: list[str] | None = None,
    output: PictureOptions,
) -> Annotated[Suite | Score, "answers: Score"]:
    """List the reference set, or score your answers to it.

    Without ANSWERS the set is listed: scenes with converged values, error bars and a reason for each; --out
    writes its scenes, its values as CSV and JSON (CC-BY-4.0), and a form to fill in, whose empty cases are
    ignored. A score has errors, likely mistakes (units, signs, swapped probes) and a rank. Exit status 3 for
    a likely mistake.

    Args:
        answers ([ANSWERS], argument): CSV: case,probe[,time],ux,uy,uz[,seconds] in m, s; without it, the set
            is listed.
        suite (NAME): The suite to score or list: {SUITES}. Default: by the header and cases of ANSWERS; all
            are listed.
        case (NAMES): A selection of cases.
    """
    from comparisons.scoring.score import score
    from comparisons.scoring.suite import Suite

    if answers is None:
        with output.open(variant={"--suite": suite}) as out:
            return out.show(Suite(suite))
    with output.open(variant={"--suite": suite, "--case": sorted(case) if case else None}) as out:
        return out.show(score(answers, suite, case or ()))
