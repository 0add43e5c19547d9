"""`sheetbench study reference-set`: the reference set of `score`, computed anew."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

from comparisons.cli import console
from comparisons.cli.options import Kind
from comparisons.scoring.reference import FILE
from sheetbench.answers.files import to_json, write_text
from sheetbench.choices import SUITES
from studies.reference_set.study import regenerate


def command(
    to: Path | None = None,
    suite: Annotated[str | None, Kind(choices=SUITES)] = None,
) -> None:
    """Compute every value of the reference set with its bar, and write them.

    Other values need another version of the set, and so do more cases.

    Args:
        to (FILE): Write here; the package's own file unless given.
        suite (SUITE): This suite alone; the others' values stay.
    """
    write_text(to or FILE, to_json(regenerate(console.print_status, suite)))
