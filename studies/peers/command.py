"""`sheetbench study peers`: ours and other people's codes in one run."""

from __future__ import annotations

from typing import Annotated

from comparisons.cli.options import option
from comparisons.cli.output import OutputOptions
from sheetbench.errors import require_choice
from studies.peers.study import QUESTIONS, study


def command(
    question: Annotated[
        list[str] | None, option("Only statics or settling; may be repeated. Both unless given.", "NAME")
    ] = None,
    *,
    output: OutputOptions,
) -> None:
    """Measure our models and other people's codes on the same sheet: error and time, at rest and in motion.

    Other codes take part where they are installed: MuJoCo, Kratos, FElupe, CalculiX.
    """

    for name in question or ():
        require_choice("question", name, QUESTIONS)
    with output.open() as out:
        out.show(study(question or list(QUESTIONS), out.progress))
