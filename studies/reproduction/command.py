"""`sheetbench study reproduction`: Habibi et al.'s study in depth."""

from __future__ import annotations

from dataclasses import replace
from typing import Annotated

from comparisons.cli.options import Elements, option
from comparisons.cli.output import PictureOptions
from comparisons.models.grids import parse_elements
from sheetbench.choices import ELEMENTS
from sheetbench.errors import require_choice
from studies.reproduction.study import PARTS, study


def command(
    part: Annotated[
        list[str] | None,
        option("Only errors, tables, settling or nearest; may be repeated. All unless given.", "NAME"),
    ] = None,
    elements: Elements = str(ELEMENTS),
    *,
    output: PictureOptions,
) -> None:
    """Study what Habibi et al. published: tables beside our models, errors, the settling run, what fits best.

    With the published inputs; where they do not give the published tables, which sheets come nearest, and
    what in the tables no sheet can have.
    """
    for name in part or ():
        require_choice("--part", name, PARTS)
    parts = [name for name in PARTS if name in (part or PARTS)]
    # pages and folders know it as the verb whose tables it extends
    with replace(output, verb="reproduce").open(variant={"--part": parts}) as out:
        forensics = study(parts, elements=parse_elements(elements), progress=out.progress)
        for name in forensics.models.folders:
            out.reserve(name)
        out.show(forensics)
