"""`sheetbench study rubber`: laws and constants of measured rubbers, and where linear lattices end."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

from comparisons.cli import console
from comparisons.cli.options import option
from studies.rubber.beam import beam
from studies.rubber.study import blown, constants, curves, pulled_and_hung


def command(
    data: Annotated[Path, option("Where silicone-tensile/ and treloar/ are.", "DIR")] = Path(
        "../shared/data"
    ),
    picture: Annotated[
        Path | None, option("Also the block of silicone-beam/ (C3D), with its picture.", "FILE")
    ] = None,
) -> None:
    """Fit laws of rubber to measured tensile tests; pull, hang and blow up linear lattices of them.

    With --picture also let a block of silicone go, with one damper and with branches.
    """
    fits = curves(data)
    for table in (constants(fits), pulled_and_hung(fits)):
        console.show(table)
    first = next(iter(fits.values())).law
    assert first is not None
    console.show(blown(first))
    if picture is not None:
        table, figure = beam(data)
        console.show(table)
        figure.savefig(picture, dpi=130)
