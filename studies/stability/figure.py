"""A study's map as a picture."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import matplotlib
from matplotlib.figure import Figure

from comparisons.stability.rows import Row
from comparisons.stability.tiles import MAP_STYLE
from sheetbench.answers.figure_style import PLAIN, Look
from sheetbench.answers.style import save
from studies.stability.study import Study


def picture(study: Study, rows: list[Row], paths: Sequence[Path], look: Look = PLAIN) -> None:
    """Write a study's map to every path, in the format of its suffix."""
    with matplotlib.rc_context(MAP_STYLE):
        figure = Figure(figsize=study.size, layout="constrained")
        study.draw(figure, rows)
        if look.titled:
            figure.suptitle(study.title, x=0.01, ha="left", fontsize=9, fontweight="bold")
        save(figure, paths)
