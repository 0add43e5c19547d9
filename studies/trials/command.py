"""`sheetbench study trials CODE=PYTHON …`: other codes with the numbers people use and with ours."""

from __future__ import annotations

from typing import Annotated

import typer

from comparisons.cli import console
from studies.trials.page import write_page
from studies.trials.study import trials, write_results


def command(
    code: Annotated[
        list[str] | None,
        typer.Argument(metavar="CODE=PYTHON", help="newton=.venv-newton/bin/python; none: the page alone."),
    ] = None,
    seconds: Annotated[float, typer.Option(help="Limit of a run.")] = 120.0,
) -> None:
    """Run other codes on two scenes with the numbers people use and with ours; write docs/results.md."""
    for text in code or ():
        name, _, python = text.partition("=")
        found = []
        for one in trials(name, python, seconds, console.tell):
            found.append(one)
            write_results(name, found)  # what is killed leaves what it has
    console.tell(str(write_page()))
