"""`sheetbench study trials CODE=PYTHON …`: other codes with the numbers people use and with ours."""

from __future__ import annotations

from typing import Annotated

import typer

from comparisons.cli import console
from studies.trials.page import chosen, write_page
from studies.trials.study import run_trials


def command(
    code: Annotated[
        list[str] | None,
        typer.Argument(metavar="CODE=PYTHON", help="newton=.venv-newton/bin/python; none: the page alone."),
    ] = None,
    seconds: Annotated[float, typer.Option(help="Limit of a run, of processor time.")] = 60.0,
    budget: Annotated[float, typer.Option(help="Seconds after which no further run of a code begins.")] = 1e9,
) -> None:
    """Run other codes with the numbers people use and with ours; write docs/results.md.

    Rows of studies/results with the same inputs are not run again.
    """
    for text in code or ():
        name, _, python = text.partition("=")
        run_trials(name, python, seconds, budget, console.tell)
    for line in (*chosen().splitlines(), str(write_page())):
        console.tell(line)
