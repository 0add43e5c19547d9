"""The picture of a motion's trade-off: error against time a simulated second, and against the step."""

from __future__ import annotations

from typing import Any

from matplotlib.figure import Figure

from comparisons.tradeoff.axes import logarithmic
from comparisons.tradeoff.motion import DynamicTradeoff
from comparisons.tradeoff.pareto import grouped
from sheetbench.answers.figure_style import PLAIN, FigureStyle
from sheetbench.answers.style import GREY, SERIES, plain

MARKERS = "osvD^P*"


def compose(found: DynamicTradeoff, style: FigureStyle = PLAIN) -> Figure:
    """The figure. Rows on the front are filled; the band is the uncertainty of the reference."""
    above, beside = style.panels(2)
    figure = Figure(figsize=(style.width, 3.0 * above + 0.5), layout="constrained")
    left, right = figure.subplots(above, beside, sharey=True)
    on_front = set(found.front)
    for n, (name, numbers) in enumerate(grouped([row.integrator for row in found.rows]).items()):
        known = [i for i in numbers if found.rows[i].error and found.rows[i].seconds_per_second]
        if not known:
            continue
        rows = [found.rows[i] for i in known]
        errors = [100 * (row.error or 0.0) for row in rows]
        line: dict[str, Any] = {"color": SERIES[n % len(SERIES)], "marker": MARKERS[n % len(MARKERS)]}
        order = found.orders[name]
        label = plain(name) if order is None else f"{plain(name)}  (order {order:z.1f})"
        for axis, across in (
            (left, [row.seconds_per_second or 0.0 for row in rows]),
            (right, [1e3 * row.step for row in rows]),
        ):
            axis.plot(across, errors, label=label, markerfacecolor="white", lw=0.9, ms=3.6, **line)
            filled = [(x, e) for x, e, i in zip(across, errors, known, strict=True) if i in on_front]
            axis.plot([x for x, _ in filled], [e for _, e in filled], ls="", ms=4.6, **line)
    for axis in (left, right):
        logarithmic(axis)
    bottom = left.get_ylim()[0]
    for axis in (left, right):
        if found.uncertainty:
            axis.axhspan(bottom, 100 * found.uncertainty, color=GREY, alpha=0.18, lw=0)
    left.set_ylim(bottom)
    if found.uncertainty:
        at = (0.99, 100 * found.uncertainty)
        said = {"xytext": (0, -2), "textcoords": "offset points", "ha": "right", "va": "top"}
        of = left.get_yaxis_transform()
        left.annotate("uncertainty of the reference", at, xycoords=of, fontsize=6, color=GREY, **said)
    left.set_xlabel("solve time of a simulated second [s]")
    left.set_ylabel("error of the motion [%]")
    right.set_xlabel("step [ms]")
    left.set_title("Error against time; filled: on the front", loc="left")
    right.set_title("Error against step", loc="left")
    names, ncols = left.get_legend_handles_labels(), 2 if style.narrow else 4
    figure.legend(*names, loc="outside lower center", ncols=ncols, frameon=False)
    if style.titled:
        figure.suptitle(plain(found.scene.title or found.scene.name, longest=105))
    return figure
