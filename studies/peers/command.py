"""`sheetbench study peers`: ours and other people's codes in one run."""

from __future__ import annotations

from typing import Annotated

import typer

from comparisons.cli.finish import finish
from comparisons.cli.options import Json, Out
from sheetbench.errors import require_choice
from studies.peers.study import QUESTIONS, study


def command(
    question: Annotated[
        list[str] | None,
        typer.Option(metavar="NAME", help="Only statics or settling; may be repeated. Both unless given."),
    ] = None,
    json: Json = False,
    out: Out = None,
) -> None:
    """Measure our models and other people's codes on the same sheet: error and time, at rest and in motion.

    Other codes take part where they are installed: MuJoCo, Kratos, FElupe, CalculiX.
    """

    for name in question or ():
        require_choice("question", name, QUESTIONS)
    with finish("peers", json, out) as end:
        end(study(question or list(QUESTIONS), end.progress))
