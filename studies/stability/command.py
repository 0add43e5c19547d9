"""`sheetbench study stability`: eight maps of where each solver holds, degrades or breaks."""

from __future__ import annotations

from typing import Annotated

from comparisons.cli.options import ClusterOptions, Grading, Large, option
from comparisons.cli.output import PictureOptions
from sheetbench.answers.figure_style import parse_figure
from sheetbench.errors import BadInput, require_choice
from studies.stability import STUDIES
from studies.stability.answer import StabilityMaps
from studies.stability.survey import survey


def command(
    study: Annotated[
        list[str] | None,
        option(
            "Only this study, may be repeated: time-step, stiffness, slenderness, grid, load, damping, "
            "mass or curved-edge. All unless given.",
            "NAME",
        ),
    ] = None,
    full: Annotated[bool, option("Every cell: finer maps, grids to 257 × 257.")] = False,
    grading: Grading = None,
    large: Large = False,
    *,
    campaign: ClusterOptions,
    output: PictureOptions,
) -> None:
    """Map where each solver is accurate, degrades, refuses or fails; an interrupted run can be resumed.

    Every cell ends in a status. With --out the maps, tables and texts are written there. --grading is of the
    studies curved-edge, load and slenderness; the others have cells of one size.
    """
    if parse_figure(output.figure).narrow:
        raise BadInput("--figure: maps with their numbers need both columns; leave ':single' out")
    names = [name.strip().replace(" ", "-") for name in study or STUDIES]
    for name in names:
        require_choice("study", name, STUDIES)
    chosen = [STUDIES[name] for name in dict.fromkeys(names)]
    with output.open() as out:
        with out.campaign(campaign) as run:
            rows = survey(chosen, **run, full=full, grading=grading, large=large)
        out.show(StabilityMaps(chosen, rows))
