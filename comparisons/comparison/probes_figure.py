"""The scene's probes as a plot: what every model is off by there, the reference's error bar as a band.

Of each probe |u − u_ref| / |u_ref| [%], the column `difference` of the table; what lies in the band cannot be
separated from it. A probe that the reference leaves still has no such number and no place in the plot.
"""

from __future__ import annotations

from itertools import cycle

import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter

from comparisons.comparison.answer import Comparison
from sheetbench.answers.figure_style import PLAIN, FigureStyle
from sheetbench.answers.report import NoPicture
from sheetbench.answers.style import GREY, MOST, SERIES, plain

HEIGHT = 2.4  # inches
MARKERS = "osD^vP"
LEAST = 1e-3  # percent, where an error of nothing is drawn
HALF = 0.42  # of a probe's place on the axis


def shown(comparison: Comparison) -> list[str]:
    """Return the probes with a place in the plot, in the scene's order: the first of those that move."""
    moving = {difference.probe for difference in comparison.differences if difference.relative is not None}
    return [probe for probe in comparison.scene.probes if probe in moving][:MOST]


def compose(comparison: Comparison, style: FigureStyle = PLAIN) -> Figure:
    """Return the figure: a place a probe, a marker a model, the band below the reference's bar. Raises
    NoPicture."""
    probes, reference = shown(comparison), comparison.reference
    if not probes:
        raise NoPicture("no probe moves, so that there are no relative differences")
    figure = Figure(figsize=(style.width, HEIGHT), layout="constrained")
    axis = figure.add_subplot()
    found = {(d.probe, d.of): 100.0 * d.relative for d in comparison.differences if d.relative is not None}
    drawn = [max(LEAST, value) for value in found.values()]
    own = comparison.relative_bars
    bars = [100.0 * own[probe] for probe in probes] if own else []
    bottom = 0.5 * min([*drawn, *(bar for bar in bars if bar > 0.0)])
    for place, bar in enumerate(bars):
        label = f"error bar of the {reference.model}" if place == 0 else None
        axis.fill_between(
            [place - HALF, place + HALF], bottom, max(bar, bottom), color=GREY, alpha=0.3, lw=0, label=label
        )
    others = [s for s in comparison.solutions if s is not reference]
    aside = np.linspace(-0.2, 0.2, len(others)) if len(others) > 1 else [0.0]
    for solution, marker, colour, by in zip(others, cycle(MARKERS), cycle(SERIES), aside, strict=False):
        at = [place for place, probe in enumerate(probes) if (probe, solution.model) in found]
        off = [max(LEAST, found[probes[place], solution.model]) for place in at]
        axis.plot(np.add(at, by), off, marker, color=colour, ms=4.5, label=plain(solution.label, longest=60))
    axis.set_yscale("log")
    axis.set_ylim(bottom=bottom)
    axis.yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    axis.set_xlim(-0.5, len(probes) - 0.5)
    axis.set_xticks(range(len(probes)), [plain(probe, longest=14) for probe in probes])
    axis.tick_params(axis="x", length=0)
    axis.set_xlabel("probe")
    axis.set_ylabel(f"off the {reference.model} [%]")
    axis.grid(axis="y", which="major", color="#e4e4e4", lw=0.5)
    axis.set_axisbelow(True)
    columns = 2 if max((len(solution.label) for solution in others), default=0) > 40 else 4
    columns //= 2 if style.narrow else 1
    figure.legend(loc="outside lower center", ncols=columns, frameon=False, fontsize=6.5)
    if style.titled:
        figure.suptitle(plain(comparison.scene.title or comparison.scene.name, longest=105), fontsize=8)
    return figure
