"""`sheetbench study reproduction`: Habibi et al.'s study again."""

from __future__ import annotations

from typing import Annotated

from comparisons.cli.options import option
from comparisons.cli.output import PictureOptions
from sheetbench.choices import ELEMENTS


def command(
    part: Annotated[
        list[str] | None,
        option("Only errors, tables, settling or nearest; may be repeated. Default: all.", "NAME"),
    ] = None,
    elements: Annotated[
        str | None,
        option(
            f"The shell's elements along the shorter side, or 8x4 along x and y; default: {ELEMENTS}.", "N"
        ),
    ] = None,
    *,
    output: PictureOptions,
) -> None:
    """Reproduce Habibi et al.'s study from its published inputs: errors, both tests, the settling run.

    With which sheets come nearest to the published tables, and what in them no sheet can have.
    """
    from comparisons.models.grids import parse_elements
    from comparisons.reproduction.reproduction import PARTS, reproduce
    from sheetbench.errors import require_choice, require_effect

    for name in part or ():
        require_choice("--part", name, PARTS)
    parts = [name for name in PARTS if name in (part or PARTS)]
    if "tables" not in parts:
        require_effect("without the part tables", {"--elements": elements})
    with output.open(variant={"--part": parts}) as out:
        size = parse_elements(elements or str(ELEMENTS))
        reproduction = reproduce(parts, elements=size, progress=out.progress)
        for name in reproduction.folders:
            out.reserve(name)
        out.show(reproduction)
