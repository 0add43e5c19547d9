"""The figure of a sweep: the largest displacement component and the error over the first varied key."""

from itertools import cycle
from typing import Any

from matplotlib.figure import Figure

from comparisons.sweep.variants import in_words, unit_of
from comparisons.sweep.variation import AXES, Variation, VariedRow
from sheetbench.answers.figure_style import PLAIN, FigureStyle
from sheetbench.answers.style import SERIES, plain
from sheetbench.answers.table import Column, unit

MARKERS = "osvD^P"
MOST = 12  # names under the panels


def compose(variation: Variation, style: FigureStyle = PLAIN) -> Figure:
    """Return the figure: a line for every model and combination of the other keys' values."""
    key, *others = variation.keys
    key_unit, (probe, axis) = unit(unit_of(key)), variation.largest_component
    lines: dict[tuple[str, str], list[VariedRow]] = {}
    for row in variation.rows:
        fixed = in_words({name: row.varied[name] for name in others})
        lines.setdefault((fixed, row.model), []).append(row)
    figure = Figure(layout="constrained")
    left, right = figure.subplots(*style.panels(2))
    models = list(dict.fromkeys(model for _, model in lines))
    colours = dict(zip(dict.fromkeys(fixed for fixed, _ in lines), cycle(SERIES), strict=False))
    for (fixed, model), rows in lines.items():
        usable = [row for row in rows if row.usable]
        values = [row.varied[key] for row in usable]
        x = [key_unit.scale * value for value in values] if variation.numeric(key) else [*map(str, values)]
        index = list(variation.scene.probes).index(probe)
        marker = MARKERS[models.index(model) % len(MARKERS)]
        line: dict[str, Any] = {"color": colours[fixed], "marker": marker, "ms": 3.6, "lw": 0.9}
        line |= {"markerfacecolor": "white"}
        line |= {"ls": (0, (4, 1.5))} if model == variation.reference else {}
        left.plot(x, [1e3 * row.u[index, axis] for row in usable], label=plain(f"{model}  {fixed}"), **line)
        points = [(at, 100.0 * row.error) for at, row in zip(x, usable, strict=True) if row.error is not None]
        if points:
            right.plot(*zip(*points, strict=True), **line)
    name, bracket = Column(key, shown_unit=key_unit.shown).heading(shown=True)
    for panel, label in ((left, f"{AXES[axis]} at {plain(probe)} [mm]"), (right, "error at the probes [%]")):
        panel.set_xlabel(f"{plain(name)} {bracket}")
        panel.set_ylabel(label)
    right.set_ylim(bottom=0.0)
    handles, labels = left.get_legend_handles_labels()
    count, columns = min(len(labels), MOST), 1 if style.narrow else 2
    legend: dict[str, Any] = {"ncols": columns, "frameon": False, "fontsize": 7}
    figure.legend(handles[:count], labels[:count], loc="outside lower center", **legend)
    if style.titled:
        title = plain(variation.scene.title or variation.scene.name, longest=110)
        figure.suptitle(title, x=0.01, ha="left", fontsize=8.5)
    figure.set_size_inches(style.width, 2.6 * style.panels(2)[0] + 0.18 * -(-count // columns) + 0.3)
    return figure
