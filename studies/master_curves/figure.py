"""The picture: drop over reach against Γ; critical Γ* against width; the way of a turned strip's tip."""

from __future__ import annotations

from typing import TYPE_CHECKING

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from sheetbench.answers.figure_style import PLAIN, FigureStyle
from sheetbench.answers.style import DARK, GREY, SERIES

if TYPE_CHECKING:
    from studies.master_curves.study import MasterCurves


def compose(found: MasterCurves, style: FigureStyle = PLAIN) -> Figure:
    """Return the figure."""
    figure = Figure(figsize=(style.width, 2.6), layout="constrained")
    left, right, turned = figure.subplots(1, 3)
    models = list(dict.fromkeys(drop.model for drop in found.drops))
    first = [drop for drop in found.drops if drop.model == models[0]]
    left.plot([d.load for d in first], [d.exact for d in first], color=DARK, lw=1.2, label="heavy elastica")
    for number, model in enumerate(models):
        own = [drop for drop in found.drops if drop.model == model]
        mark = "s" if model.startswith("shell") else "o"
        style_of = {"ls": "", "marker": mark, "ms": 4.0, "mfc": "none", "color": SERIES[number % len(SERIES)]}
        left.plot([d.load for d in own], [d.found for d in own], label=model, **style_of)
    left.set(xscale="log", yscale="log", xlabel="Γ = ρ_A g L³/B", ylabel="drop over reach H/W")
    widths = [row.width for row in found.buckled]
    right.axhline(found.narrow, color=DARK, lw=0.8, ls="--", label="narrow strip")
    right.plot(widths, [row.shell for row in found.buckled], color=SERIES[0], marker="s", ms=4, label="shell")
    right.plot(
        widths,
        [row.lattice for row in found.buckled],
        ls="",
        marker="o",
        mfc="none",
        color=SERIES[1],
        label="lattice",
    )
    right.set(xlabel="width over length", ylabel="critical Γ*", ylim=(10.0, None))
    _turned(turned, found)
    for axis in (left, right, turned):
        axis.grid(True, which="major", color=GREY, alpha=0.25, lw=0.5)
        axis.legend(fontsize=6.5, frameon=False)
    return figure


def _turned(axes: Axes, found: MasterCurves) -> None:
    """Drop and way aside against Γ: lines of the narrow strip, marks of models."""
    models = list(dict.fromkeys(one.model for one in found.twisted))
    for number, model in enumerate(models):
        own = [one for one in found.twisted if one.model == model]
        loads = [one.load for one in own]
        if number == 0:
            for values, line in (([o.narrow_drop for o in own], "-"), ([o.narrow_aside for o in own], "--")):
                axes.plot(loads, values, line, color=DARK, lw=1.0)
            axes.text(loads[-1], own[-1].narrow_drop, "drop ", ha="right", va="bottom", fontsize=6.5)
            axes.text(loads[-1], own[-1].narrow_aside, "aside ", ha="right", va="top", fontsize=6.5)
        ways = [one.drop for one in own] + [one.aside for one in own]
        axes.plot(loads * 2, ways, "so^"[number % 3], ms=4.0, mfc="none", color=SERIES[number], label=model)
    axes.set(xscale="log", xlabel="Γ, plane turned by 45°", ylabel="tip's way over length")
