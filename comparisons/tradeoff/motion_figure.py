"""The picture of a motion's trade-off: errors against time a simulated second, and of steps against steps."""

from __future__ import annotations

from typing import Any

from matplotlib.figure import Figure

from comparisons.tradeoff.answer import DynamicTradeoff
from comparisons.tradeoff.figure import floor, logarithmic
from comparisons.tradeoff.row import MotionRow
from sheetbench.answers.figure_style import PLAIN, FigureStyle
from sheetbench.answers.style import SERIES, plain

MARKERS = "osvD^P*"


def compose(found: DynamicTradeoff, style: FigureStyle = PLAIN) -> Figure:
    """The figure. Rows on the front are filled; the band is the uncertainty of the reference."""
    above, beside = style.panels(2)
    figure = Figure(figsize=(style.width, 3.0 * above + 0.9), layout="constrained")
    left, right = figure.subplots(above, beside)
    on_front = {id(found.rows[i]) for i in found.front}
    for n, (name, numbers) in enumerate(found.series.items()):
        rows = [row for row in (found.rows[i] for i in numbers) if row.error and row.seconds_per_second]
        line: dict[str, Any] = {"color": SERIES[n % len(SERIES)], "marker": MARKERS[n % len(MARKERS)]}
        order = found.orders.get(name)
        label = plain(name) if order is None else f"{plain(name)}  (order of steps {order:z.1f})"
        if not rows:
            continue
        left.plot(*_points(rows), label=label, markerfacecolor="white", lw=0.9, ms=3.6, **line)
        left.plot(*_points([row for row in rows if id(row) in on_front]), ls="", ms=4.6, **line)
        stepped = [(1e3 * row.step, 100 * row.step_error) for row in rows if row.step and row.step_error]
        if stepped:
            right.plot(*zip(*stepped, strict=True), markerfacecolor="white", lw=0.9, ms=3.6, **line)
    for axis in (left, right) if right.lines else (left,):
        logarithmic(axis)
    floor(left, found, "uncertainty of the reference")
    left.set_xlabel("solve time of a simulated second [s]")
    left.set_ylabel(f"error against the {found.reference.model} [%]")
    right.set_xlabel("step [ms]")
    right.set_ylabel("error of the steps alone [%]")
    left.set_title("Error against time; filled: on the front", loc="left")
    right.set_title("What a lattice's steps miss", loc="left")
    names, ncols = left.get_legend_handles_labels(), 1 if style.narrow else 2
    figure.legend(*names, loc="outside lower center", ncols=ncols, frameon=False)
    if style.titled:
        figure.suptitle(plain(found.scene.title or found.scene.name, longest=105))
    return figure


def _points(rows: list[MotionRow]) -> tuple[list[float], list[float]]:
    return [row.seconds_per_second or 0.0 for row in rows], [100 * (row.error or 0.0) for row in rows]
