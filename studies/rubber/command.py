"""`sheetbench study rubber`: laws and constants of measured rubbers, and where linear lattices end."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from comparisons.cli import console
from studies.rubber.study import blown, constants, curves, pulled_and_hung


def command(
    data: Annotated[
        Path, typer.Option(metavar="DIR", help="Where silicone-tensile/ and treloar/ are.")
    ] = Path("../shared/data"),
) -> None:
    """Fit laws of rubber to measured tensile tests; pull, hang and blow up linear lattices of them."""
    fits = curves(data)
    for table in (constants(fits), pulled_and_hung(fits)):
        console.show(table)
    first = next(iter(fits.values())).law
    assert first is not None
    console.show(blown(first))
