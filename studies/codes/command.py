"""`sheetbench study codes`: other people's codes and our models on the reference set, error and time."""

from __future__ import annotations

from typing import Annotated

import typer

from comparisons.cli import console
from comparisons.cli.options import option
from comparisons.cli.output import PictureOptions
from sheetbench.choices import listed
from studies.codes.answer import codes
from studies.codes.models import LADDERS, climb, stand
from studies.codes.trials import run_trials


def command(
    code: Annotated[
        list[str] | None,
        typer.Argument(metavar="CODE=PYTHON", help="newton=.venv-newton/bin/python; none: the stored rows."),
    ] = None,
    seconds: Annotated[float, typer.Option(help="Limit of a run, of processor time.")] = 60.0,
    budget: Annotated[float, typer.Option(help="Seconds after which no further run of a code begins.")] = 1e9,
    ladder: Annotated[
        list[str] | None,
        option(f"Measure sizes of {listed(LADDERS)} on test 1; may be repeated.", "NAME", choices=LADDERS),
    ] = None,
    standing: Annotated[
        bool, option("Measure models on a suite, into the reference set's file.", None, "--standing")
    ] = False,
    model: Annotated[list[str] | None, option("With --standing: as mujoco:grid=9.", "MODEL")] = None,
    suite: Annotated[
        str, option("With --standing: statics or curves.", "SUITE", choices=("statics", "curves"))
    ] = "statics",
    *,
    output: PictureOptions,
) -> None:
    """Show errors and times of other codes, with numbers in use and with ours, beside our models.

    CODE=PYTHON runs what is missing or changed of a code; rows with the same inputs stay.
    """
    with output.open() as out:
        for text in code or ():
            name, _, python = text.partition("=")
            run_trials(name, python, seconds, budget, console.tell)
        for name in ladder or ():
            climb(name, console.tell)
        if standing or model:
            stand(model or (), console.tell, suite)
        out.show(codes())
