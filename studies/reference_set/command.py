"""`sheetbench study reference-set`: the reference set of `score`, computed anew."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

from comparisons.cli import console
from comparisons.cli.options import option
from comparisons.scoring.reference import FILE
from sheetbench.answers.files import to_json, write_text
from sheetbench.choices import SUITES
from studies.reference_set.study import regenerate


def command(
    to: Annotated[Path | None, option("Write here; the package's own file unless given.", "FILE")] = None,
    suite: Annotated[
        str | None, option("This suite alone; the others' values stay.", "SUITE", choices=SUITES)
    ] = None,
) -> None:
    """Compute every value of the reference set with its bar, and write them.

    Other values need another version of the set, and so do more cases.
    """
    write_text(to or FILE, to_json(regenerate(console.tell, suite)))
