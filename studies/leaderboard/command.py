"""`sheetbench study leaderboard`: where models stand on statics and curves of the reference set."""

from __future__ import annotations

from typing import Annotated

import typer

from comparisons.cli import console
from comparisons.cli.options import option
from sheetbench.errors import require_choice
from studies.leaderboard.study import measure


def command(
    model: Annotated[
        list[str] | None,
        typer.Argument(metavar="MODEL", help="As mujoco:grid=9; all but the slow ones unless given."),
    ] = None,
    suite: Annotated[str, option("statics or curves.", "SUITE")] = "statics",
) -> None:
    """Measure models on a suite of the reference set, and put the rows into its file.

    What is not installed keeps its rows.
    """
    require_choice("--suite", suite, ("statics", "curves"))
    measure(model or (), console.tell, suite)
