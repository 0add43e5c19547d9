"""The picture: error against time, statics at the left, the settling run at the right; ours filled."""

from __future__ import annotations

from collections.abc import Sequence

import matplotlib
from matplotlib.figure import Figure

from sheetbench.answers.figure_style import PLAIN, FigureStyle
from sheetbench.answers.style import GREY, STYLE
from studies.peers.row import PeerRow

COLOURS = ("#0072b2", "#222222", "#a0522d", "#e69f00", "#009e73", "#cc79a7", "#56b4e9", "#d55e00")


def compose(rows: Sequence[PeerRow], style: FigureStyle = PLAIN) -> Figure:
    """The figure."""
    questions = list(dict.fromkeys(row.question for row in rows))
    with matplotlib.rc_context(STYLE):
        figure = Figure(figsize=(style.width, 3.2), layout="constrained")
        for axis, question in zip(
            figure.subplots(1, len(questions), squeeze=False)[0], questions, strict=True
        ):
            of = [row for row in rows if row.question == question and row.error and row.median]
            for code, colour in zip(dict.fromkeys(row.code for row in of), COLOURS * 2, strict=False):
                some = [row for row in of if row.code == code]
                times, errors = [row.median for row in some], [100.0 * (row.error or 0.0) for row in some]
                face = colour if some[0].ours else "white"
                line = {"ls": "-" if some[0].ours else (0, (4, 1.5)), "lw": 0.9, "marker": "o", "ms": 4.0}
                axis.plot(times, errors, color=colour, markerfacecolor=face, label=code, **line)
            axis.set_xscale("log")
            axis.set_yscale("log")
            axis.set_title(question, fontsize=8.5)
            axis.set_xlabel("time of a solve [s]" if question == "statics" else "time of two seconds [s]")
            axis.set_ylabel("error [%]")
            axis.grid(True, which="major", color=GREY, alpha=0.25, lw=0.5)
            axis.legend(fontsize=6.2, frameon=False)
    return figure
