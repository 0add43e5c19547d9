"""`sheetbench study rubber`: laws and constants of measured rubbers, and where linear lattices end."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from comparisons.cli.output import PictureOptions
from studies.rubber.answer import measure


def command(
    data: Path = Path("../shared/data"),
    block: bool = False,
    *,
    output: PictureOptions,
) -> Any:
    """Fit laws of rubber to measured tensile tests; pull, hang and blow up linear lattices of them.

    The option --block also lets a block of silicone go, with one damper and with branches.

    Args:
        data (DIR): Folder with silicone-tensile/, treloar/ and silicone-beam/.
        block: Also the block of silicone-beam/ (C3D; half an hour)."""
    with output.open() as out:
        return out.show(measure(data, block, out.progress))
