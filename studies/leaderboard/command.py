"""`sheetbench study leaderboard`: where models stand on the statics of the reference set."""

from __future__ import annotations

from typing import Annotated

import typer

from comparisons.cli import console
from studies.leaderboard.study import measure


def command(
    model: Annotated[
        list[str] | None,
        typer.Argument(metavar="MODEL", help="As mujoco:grid=9; all but the slow ones unless given."),
    ] = None,
) -> None:
    """Measure models on the statics of the reference set, and put the rows into its file.

    What is not installed keeps its rows.
    """
    measure(model or (), console.tell)
