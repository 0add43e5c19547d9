"""The figure of a score: errors by case over the reference's error bars."""

import numpy as np
from matplotlib.figure import Figure

from comparisons.scoring.score import Score
from sheetbench.answers.figure_style import PLAIN, FigureStyle
from sheetbench.answers.style import plain

COLOUR = "#c1272d"
LEAST = 1e-3  # percent: smaller errors are drawn here


def compose(score: Score, style: FigureStyle = PLAIN) -> Figure:
    """Return the figure: a dot per case, the reference's error bar in grey."""
    figure = Figure(figsize=(style.width, 1.2 + 0.17 * max(8, len(score.answers))), layout="constrained")
    axis, names = figure.subplots(), [plain(a.reference.name, longest=24) for a in score.answers]
    at = np.arange(len(names))[::-1]
    errors = [max(LEAST, 100.0 * score.error(answer)) for answer in score.answers]
    bars = [max(LEAST, 100.0 * answer.reference.bar) for answer in score.answers]
    axis.barh(at, bars, height=0.7, color="#e4e4e4")
    axis.plot(errors, at, "o", ms=4, color=COLOUR)
    axis.set_yticks(at, names)
    axis.set_xscale("log")
    axis.set_xlabel("error [%]; grey: the reference's own")
    axis.margins(y=0.02)
    axis.set_title("Errors by case", fontsize=8, fontweight="bold", loc="left")
    return figure
