"""`sheetbench study reproduction`: Habibi et al.'s study in depth."""

from __future__ import annotations

from typing import Annotated

import typer

from comparisons.cli.finish import finish
from comparisons.cli.options import Elements, Figure, Json, NoPictures, Out, Overwrite
from comparisons.models.grids import parse_elements
from sheetbench.choices import ELEMENTS
from sheetbench.errors import require_choice
from studies.reproduction.study import PARTS, study


def command(
    part: Annotated[
        list[str] | None,
        typer.Option(
            "--part",
            metavar="NAME",
            help="Only errors, tables, settling or nearest; may be repeated. All unless given.",
            show_default=False,
        ),
    ] = None,
    elements: Elements = str(ELEMENTS),
    json: Json = False,
    out: Out = None,
    figure: Figure = None,
    no_pictures: NoPictures = False,
    overwrite: Overwrite = False,
) -> None:
    """Study what Habibi et al. published: tables beside our models, errors, the settling run, what fits best.

    With the published inputs; where they do not give the published tables, which sheets come nearest, and
    what in the tables no sheet can have.
    """
    for name in part or ():
        require_choice("--part", name, PARTS)
    parts = [name for name in PARTS if name in (part or PARTS)]
    with finish(
        "reproduce", json, out, overwrite, apart={"--part": parts}, figure=figure, pictures=not no_pictures
    ) as end:
        found = study(parts, elements=parse_elements(elements), progress=end.progress)
        for name in found.models.folders:
            end.place(name)
        end(found.report())
