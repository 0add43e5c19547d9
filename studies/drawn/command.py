"""`sheetbench study drawn`: lattice against shell on drawn sheets."""

from __future__ import annotations

import warnings
from typing import Annotated

from comparisons.cli import console
from comparisons.cli.options import option
from studies.drawn.scenes import scenes
from studies.drawn.study import measure, table


def command(
    scene: Annotated[list[str] | None, option("Only this one; may be repeated.", "NAME")] = None,
) -> None:
    """Print the errors of lattices of 9, 17 and 33 masses, and the order by which they fall."""
    warnings.simplefilter("ignore")
    rows = []
    for one in scenes():
        if not scene or one.name in scene:
            console.tell(f"solving {one.name} …")
            rows.append(measure(one))
    print(table(rows))
