"""The picture of a score: errors by case above the reference's bars, and the place beside other models."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from comparisons.pictures.labels import marks, spread
from comparisons.scoring.score import Place, Score
from sheetbench.answers.figure_style import PLAIN, FigureStyle
from sheetbench.answers.style import DARK, GREY, plain

OWN = "#c1272d"
NAME = 5.5  # points, of a model's name
LEAST = 1e-3  # percent, where an error of nothing is drawn


def compose(score: Score, style: FigureStyle = PLAIN) -> Figure:
    """The figure: cases on the left; on the right time and score, where other models were measured."""
    beside = len(score.leaderboard) > 1
    cases = 1.2 + 0.17 * max(8, len(score.answers))
    below = 2.8 if beside and style.narrow else 0.0
    figure = Figure(figsize=(style.width, cases + below), layout="constrained")
    heights = (cases, below) if below else None
    axes = figure.subplots(*style.panels(1 + beside), squeeze=False, height_ratios=heights).ravel()
    _cases(axes[0], score)
    if beside:
        _place(axes[1], score)
    return figure


def _cases(axis: Axes, score: Score) -> None:
    names = [plain(answer.reference.name, longest=24) for answer in score.answers]
    at = np.arange(len(names))[::-1]
    errors = [max(LEAST, 100.0 * score.error(answer)) for answer in score.answers]
    bars = [max(LEAST, 100.0 * answer.reference.bar) for answer in score.answers]
    axis.barh(at, bars, height=0.7, color="#e4e4e4")
    axis.plot(errors, at, "o", ms=4, color=OWN)
    axis.set_yticks(at, names)
    axis.set_xscale("log")
    axis.set_xlabel("error [%]; grey: the reference's own")
    axis.margins(y=0.02)
    axis.set_title("Errors by case", fontsize=8, fontweight="bold", loc="left")


def _place(axis: Axes, score: Score) -> None:
    timed = [one for one in score.leaderboard if one.seconds is not None]
    for one in timed:
        colour = OWN if one.model == "answers" else DARK
        kept = colour if one.model in score.front else "white"
        marker = "s" if one.foreign else "o"
        axis.plot(1e3 * (one.seconds or 0.0), 100.0 * one.score, marker, ms=5, color=colour, mfc=kept)
    for one in score.leaderboard:
        if one.seconds is None:
            axis.axhline(100.0 * one.score, color=OWN, lw=1.0, ls="--")
            axis.annotate(
                "answers (no times)", (0.02, 100.0 * one.score), xycoords=("axes fraction", "data"),
                xytext=(0, 2), textcoords="offset points", fontsize=6.5, color=OWN,
            )  # fmt: skip
    axis.set_xscale("log")
    axis.set_yscale("log")
    axis.margins(x=0.2, y=0.1)
    axis.grid(color=GREY, lw=0.3, alpha=0.4)
    axis.set_xlabel("time of a case [ms]; squares: other programs")
    axis.set_ylabel("score [%]")
    axis.set_title("Beside other models", fontsize=8, fontweight="bold", loc="left")
    _name(axis, timed)


def _name(axis: Axes, timed: Sequence[Place]) -> None:
    """The models' names where they hide neither each other nor a point."""
    axis.figure.draw_without_rendering()  # type: ignore[union-attr]
    labels = []
    for one in timed:
        at, name = (1e3 * (one.seconds or 0.0), 100.0 * one.score), re.sub(r"[:,]\w+=", " ", one.model)
        look: dict[str, Any] = {"fontsize": NAME, "color": OWN if one.model == "answers" else DARK}
        labels.append(axis.annotate(name, at, (0, 0), textcoords="offset points", **look))
    points = np.array([label.xy for label in labels])
    spread(labels, marks(axis, points), frame=axis.get_window_extent())
