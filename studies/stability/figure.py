"""A study's map as a picture."""

from __future__ import annotations

import matplotlib
from matplotlib.figure import Figure

from comparisons.stability.rows import Row
from comparisons.stability.tiles import MAP_STYLE
from sheetbench.answers.figure_style import PLAIN, FigureStyle
from studies.stability.study import Study


def compose(study: Study, rows: list[Row], style: FigureStyle = PLAIN) -> Figure:
    """A study's map of its rows."""
    with matplotlib.rc_context(MAP_STYLE):
        figure = Figure(figsize=study.size, layout="constrained")
        study.draw(figure, rows)
        if style.titled:
            figure.suptitle(study.title, x=0.01, ha="left", fontsize=9, fontweight="bold")
    return figure
