"""`sheetbench suite`: the reference set."""

from __future__ import annotations

from typing import Annotated

from comparisons.cli.options import option
from comparisons.cli.output import OutputOptions


def command(
    suite: Annotated[str | None, option("Only statics, motion, modes or curves.", "NAME")] = None,
    *,
    output: OutputOptions,
) -> None:
    """List the reference set: scenes with converged values, error bars, and why each is in the set.

    --out writes its scenes, its values as CSV and JSON (CC-BY-4.0), and a form for answers.
    """
    from comparisons.scoring.cases import SUITES
    from comparisons.scoring.suite import Suite
    from sheetbench.errors import require_choice

    if suite is not None:
        require_choice("--suite", suite, SUITES)
    with output.open(variant={"--suite": suite}) as out:
        out.show(Suite(suite))
