"""`sheetbench study reproduction`: reproduction of Habibi et al.'s study."""

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

    The answer includes the sheets nearest to the published tables, and entries that no sheet reproduces.

    Args:
        part (NAMES): Only {REPRODUCED}. Default: all.
    """
    from comparisons.models.grids import parse_elements
    from comparisons.reproduction.reproduction import reproduce

    parts = [name for name in REPRODUCED if name in (part or REPRODUCED)]
    with output.open(variant={"--part": parts}) as out:
        return out.show(reproduce(parts, parse_elements(elements)))
