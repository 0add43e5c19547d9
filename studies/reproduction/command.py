"""`sheetbench study reproduction`: reproduction of Habibi et al.'s study."""

from __future__ import annotations

from typing import Annotated, Any

from comparisons.cli.options import Kind
from comparisons.cli.output import PictureOptions
from comparisons.models.grids import parse_elements
from sheetbench.choices import ELEMENTS
from studies.reproduction.study import PARTS, reproduce


def command(
    part: Annotated[list[str] | None, Kind(choices=PARTS)] = None,
    elements: str = str(ELEMENTS),
    *,
    output: PictureOptions,
) -> Any:
    """Reproduce Habibi et al.'s study from its published inputs: errors, both tests, the settling run.

    The answer includes the sheets nearest to the published tables, and entries that no sheet reproduces.

    Args:
        part (NAMES): Only {PARTS}. Default: all."""
    parts = [name for name in PARTS if name in (part or PARTS)]
    with output.open(variant={"--part": parts}) as out:
        return out.show(reproduce(parts, parse_elements(elements)))
