"""The picture of a score: errors by case above the reference's bars, and the place beside our own models."""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import matplotlib
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from comparisons.report.look import PLAIN, Look
from comparisons.report.style import DARK, GREY, STYLE, plain, save

if TYPE_CHECKING:
    from comparisons.scoring.score import Score

OWN = "#c1272d"
LEAST = 1e-3  # percent, where an error of nothing is drawn


def picture(paths: Sequence[Path], found: Score, look: Look = PLAIN) -> None:
    """Write the picture."""
    with matplotlib.rc_context(STYLE):
        save(compose(found, look), paths)


def compose(found: Score, look: Look = PLAIN) -> Figure:
    """The figure: cases on the left; on the right time and score, where our own models were measured."""
    beside = len(found.standing) > 1
    cases = 1.2 + 0.17 * max(8, len(found.answers))
    below = 2.8 if beside and look.narrow else 0.0
    figure = Figure(figsize=(look.width, cases + below), layout="constrained")
    heights = (cases, below) if below else None
    axes = figure.subplots(*look.panels(1 + beside), squeeze=False, height_ratios=heights).ravel()
    _cases(axes[0], found)
    if beside:
        _place(axes[1], found)
    return figure


def _cases(axis: Axes, found: Score) -> None:
    names = [plain(answer.reference.name, longest=24) for answer in found.answers]
    at = np.arange(len(names))[::-1]
    errors = [max(LEAST, 100.0 * found.error(answer)) for answer in found.answers]
    bars = [max(LEAST, 100.0 * answer.reference.bar) for answer in found.answers]
    axis.barh(at, bars, height=0.7, color="#e4e4e4", label="reference's own bar")
    axis.plot(errors, at, "o", ms=4, color=OWN, label="answers")
    axis.set_yticks(at, names)
    axis.set_xscale("log")
    axis.set_xlabel("error [%]")
    axis.margins(y=0.02)
    axis.legend(frameon=False, fontsize=6.5, loc="lower right", bbox_to_anchor=(1.0, 1.0), ncols=2)
    axis.set_title("Errors by case", fontsize=8, fontweight="bold", loc="left")


def _place(axis: Axes, found: Score) -> None:
    for one in found.standing:
        own = one.model == "answers"
        colour = OWN if own else DARK
        if one.seconds is None:
            axis.axhline(100.0 * one.score, color=colour, lw=1.0, ls="--")
            axis.annotate(
                "answers (no times)", (0.02, 100.0 * one.score), xycoords=("axes fraction", "data"),
                xytext=(0, 2), textcoords="offset points", fontsize=6.5, color=colour,
            )  # fmt: skip
            continue
        kept = one.model in found.front
        place = (1e3 * one.seconds, 100.0 * one.score)
        axis.plot(*place, "o", ms=5, color=colour, markerfacecolor=colour if kept else "white")
        axis.annotate(
            re.sub(r"[:,]\w+=", " ", one.model), place, xytext=(0, 5), textcoords="offset points",
            fontsize=5.5, color=colour, ha="center",
        )  # fmt: skip
    axis.set_xscale("log")
    axis.set_yscale("log")
    axis.margins(x=0.2, y=0.1)
    axis.grid(color=GREY, lw=0.3, alpha=0.4)
    axis.set_xlabel("time of a case [ms], geometric mean")
    axis.set_ylabel("score [%]")
    axis.set_title("Beside our own models", fontsize=8, fontweight="bold", loc="left")
