"""The figure of a trade-off: error against time with the front, and against cell size or step."""

from itertools import cycle
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.text import Annotation
from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

from comparisons.pictures.labels import spread
from comparisons.tradeoff.answer import DynamicTradeoff, Tradeoff, TradeoffAnswer
from comparisons.tradeoff.row import MotionRow, TradeoffRow
from sheetbench.answers.figure_style import PLAIN, FigureStyle
from sheetbench.answers.style import GREY, SERIES, plain

PANEL, NAMES, TITLE = 3.1, 0.2, 0.25  # inches: of a panel, a row of names, the title over all
MARKERS = {"lumped": "o", "plate": "v", "shell": "s", "solid": "D"}
CORNERS = ((-1, -1), (1, 1), (-1, 1), (1, -1))  # positions of a size next to its point, by preference
SIZE = "size of a row"
LEAST_ORDER = 0.25  # order below which an error is no smaller on finer meshes
REFERENCE_COLOURS = {"plate": "#8a8a8a", "shell": "#222222", "solid": "#a0522d"}


def compose(tradeoff: Tradeoff | DynamicTradeoff, style: FigureStyle = PLAIN) -> Figure:
    """Return the figure: error against time at the left; at the right the error against the cell size, or the
    step error against the step."""
    figure = Figure(layout="constrained")
    ratios, same_error = None if style.narrow else (1.35, 1.0), not tradeoff.SIZED_ERROR
    left, right = figure.subplots(*style.panels(2), sharey=same_error, width_ratios=ratios)
    colours = cycle(SERIES)  # lattices take the first ones
    on_front = set(tradeoff.front)
    for name, (numbers, slope) in tradeoff.curves.items():
        positive = [
            i for i in numbers if tradeoff.rows[i].error and tradeoff.rows[i].cost
        ]  # for the log axes
        if not positive:
            continue
        rows: list[TradeoffRow | MotionRow] = [tradeoff.rows[i] for i in positive]
        model = rows[0].model
        colour = REFERENCE_COLOURS.get(model) or next(colours)
        line: dict[str, Any] = {"color": colour, "marker": MARKERS.get(model, "P"), "lw": 0.9, "ms": 3.6}
        if model in REFERENCE_COLOURS:
            line["ls"] = (0, (4, 1.5))
        label = plain(name)
        if slope is not None:
            label += f"  (order {slope:.1f})" if slope >= LEAST_ORDER else "  (does not converge)"
        _against_time(left, rows, [i in on_front for i in positive], line, label, tradeoff.COST[1])
        points = [(1e3 * h, 100 * e) for h, e in (row.plot_point for row in rows) if h and e]
        if points:
            right.plot(*zip(*points, strict=True), **line)
    _front(left, tradeoff)
    for axis, note in ((left, "uncertainty of the reference"), (right, "")):
        if axis.lines:
            logarithmic(axis)
        if note or same_error:
            floor(axis, tradeoff, note)
    left.margins(x=0.12)  # for the sizes next to the outermost rows
    left.set_xlabel(tradeoff.COST[0])
    left.set_ylabel("error at the probes [%]")
    right.set_xlabel(tradeoff.SIZE)
    if style.narrow or not same_error:
        right.set_ylabel(tradeoff.SIZED_ERROR or "error at the probes [%]")
    left.set_title("Error against time, and the front", fontsize=8, fontweight="bold", loc="left")
    right.set_title("Observed convergence", fontsize=8, fontweight="bold", loc="left")
    handles, labels = left.get_legend_handles_labels()
    names = 2 if style.narrow else 4
    legend: dict[str, Any] = {"handlelength": 1.9, "columnspacing": 0.8, "frameon": False, "fontsize": 7}
    figure.legend(handles, labels, loc="outside lower center", ncols=names, **legend)
    if style.titled:
        title = plain(tradeoff.scene.title or tradeoff.scene.name, longest=110)
        figure.suptitle(title, x=0.01, ha="left", fontsize=8.5)
    height = style.panels(2)[0] * PANEL + NAMES * -(-len(labels) // names) + TITLE * style.titled
    figure.set_size_inches(style.width, height)
    figure.draw_without_rendering()
    sizes = [text for text in left.texts if isinstance(text, Annotation) and text.get_gid() == SIZE]
    spread(sizes, [text.get_window_extent() for text in left.texts if text not in sizes], CORNERS)
    return figure


def _against_time(
    axis: Axes, rows: list[TradeoffRow | MotionRow], on_front: list[bool], line: dict[str, Any],
    label: str, scale: float,
) -> None:  # fmt: skip
    """Draw a series: medians as markers (filled on the front), spreads as bars, and sizes of front rows."""
    median = np.array([scale * (row.cost or 0.0) for row in rows])
    error = [100 * (row.error or 0.0) for row in rows]
    axis.plot(median, error, label=label, markerfacecolor="white", **line)
    for row, t, e, in_front in zip(rows, median, error, on_front, strict=True):
        samples = [scale * s for s in row.samples] or [t]
        axis.plot([min(samples), max(samples)], [e, e], color=line["color"], lw=0.6, alpha=0.6, zorder=1)
        if in_front:
            axis.plot([t], [e], color=line["color"], marker=line["marker"], ms=4.6, zorder=4)
            axis.annotate(
                row.mark, (t, e), (0, 0), textcoords="offset points", fontsize=6, color=line["color"],
                gid=SIZE,
            )  # fmt: skip


def _front(axis: Axes, tradeoff: TradeoffAnswer) -> None:
    """Draw the front as a staircase: the least error within each time."""
    rows, (_, scale) = [tradeoff.rows[i] for i in tradeoff.front], tradeoff.COST
    if not rows:
        return
    errors = [100 * max(row.error or 0.0, tradeoff.uncertainty or 0.0) for row in rows]
    times = [scale * (row.cost or 0.0) for row in rows]
    latest = max(scale * (row.cost or 0.0) for row in tradeoff.rows)
    band: dict[str, Any] = {"color": "#d4a017", "lw": 4.5, "alpha": 0.35, "solid_joinstyle": "round"}
    times, errors = [*times, max(latest, times[-1])], [*errors, errors[-1]]
    axis.step(times, errors, where="post", zorder=0, label="front: the best in that time", **band)


def floor(axis: Axes, tradeoff: TradeoffAnswer, note: str) -> None:
    """Draw a band for errors below the reference's uncertainty."""
    if not tradeoff.uncertainty:
        return
    bar = 100 * tradeoff.uncertainty
    errors = [100 * row.error for row in tradeoff.rows if row.error]
    bottom = min([bar / 2.5, *(0.6 * e for e in errors)])
    axis.set_ylim(bottom, 1.6 * max(bar, *errors))
    axis.axhspan(bottom, bar, color=GREY, alpha=0.18, lw=0)
    axis.annotate(
        note,
        (0.015, bar),
        (0, -2),
        xycoords=axis.get_yaxis_transform(),
        textcoords="offset points",
        va="top",
        fontsize=6,
        color=GREY,
    )


def logarithmic(axis: Axes) -> None:
    """Make both axes logarithmic, with plain numbers and a pale grid."""
    axis.set_xscale("log")
    axis.set_yscale("log")
    axis.grid(which="major", color="#e4e4e4", lw=0.5, zorder=-1)
    axis.set_axisbelow(True)
    for side in (axis.xaxis, axis.yaxis):
        side.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
        side.set_minor_locator(LogLocator(subs=range(2, 10)))
        side.set_minor_formatter(NullFormatter())
    labels = FuncFormatter(lambda value, _: f"{value:g}" if _labelled(axis, value) else "")
    axis.xaxis.set_minor_formatter(labels)
    axis.tick_params(which="both", width=0.5, length=2.5)
    axis.tick_params(which="minor", length=1.5, labelsize=6.5)


def _labelled(axis: Axes, value: float) -> bool:
    """Return whether a minor tick on the x axis has a number: all if the axis spans less than half a decade,
    2 and 5 if less than 1.5 decades."""
    low, high = axis.get_xlim()
    leading = round(value / 10.0 ** np.floor(np.log10(value)))
    return high < 10**0.5 * low or (high < 10**1.5 * low and leading in (2, 5))
