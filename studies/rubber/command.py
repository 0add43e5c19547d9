"""`sheetbench study rubber`: laws and constants of measured rubbers, and where linear lattices end."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

from comparisons.cli import console
from comparisons.cli.options import option
from studies.rubber.beam import beam
from studies.rubber.study import blown, constants, curves, figure, pulled_and_hung


def command(
    data: Annotated[Path, option("Where silicone-tensile/ and treloar/ are.", "DIR")] = Path(
        "../shared/data"
    ),
    pictures: Annotated[
        Path | None,
        option("Also the block of silicone-beam/ (C3D); draw both pictures here.", "DIR"),
    ] = None,
) -> None:
    """Fit laws of rubber to measured tensile tests; pull, hang and blow up linear lattices of them.

    With --pictures also let a block of silicone go, with one damper and with branches.
    """
    fits = curves(data)
    console.show(constants(fits))
    console.show(strips := pulled_and_hung(fits))
    first = next(iter(fits.values())).law
    assert first is not None
    console.show(squares := blown(first))
    if pictures is not None:
        figure(strips, squares).savefig(pictures / "linear-lattices.png", dpi=130)
        *tables, swings = beam(data)
        for table in tables:
            console.show(table)
        swings.savefig(pictures / "silicone-beam.png", dpi=130)
