"""`sheetbench study reproduction`: Habibi et al.'s study again."""

from __future__ import annotations

from typing import Annotated, Any

from comparisons.cli.options import Kind
from comparisons.cli.output import PictureOptions
from sheetbench.choices import ELEMENTS, REPRODUCED


def command(
    part: Annotated[list[str] | None, Kind(choices=REPRODUCED)] = None,
    elements: str = str(ELEMENTS),
    *,
    output: PictureOptions,
) -> Any:
    """Reproduce Habibi et al.'s study from its published inputs: errors, both tests, the settling run.

    With which sheets come nearest to the published tables, and what in them no sheet can have.

    Args:
        part (NAMES): Only {REPRODUCED}. Default: all.
    """
    from comparisons.models.grids import parse_elements
    from comparisons.reproduction.reproduction import reproduce

    parts = [name for name in REPRODUCED if name in (part or REPRODUCED)]
    with output.open(variant={"--part": parts}) as out:
        return out.show(reproduce(parts, parse_elements(elements)))
