"""The picture of a sweep: the displacement that is largest, and the error, over the first key varied."""

from __future__ import annotations

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


def compose(found: Variation, style: FigureStyle = PLAIN) -> Figure:
    """Return the figure: a line for every model and combination of the other keys' values."""
    key, *others = found.keys
    shown, (probe, axis) = unit(unit_of(key)), found.moves_most
    lines: dict[tuple[str, str], list[VariedRow]] = {}
    for row in found.rows:
        fixed = in_words({name: row.varied[name] for name in others})
        lines.setdefault((fixed, row.model), []).append(row)
    figure = Figure(layout="constrained")
    left, right = figure.subplots(*style.panels(2))
    models = list(dict.fromkeys(model for _, model in lines))
    colours = dict(zip(dict.fromkeys(fixed for fixed, _ in lines), cycle(SERIES), strict=False))
    for (fixed, model), rows in lines.items():
        known = [row for row in rows if row.usable]
        values = [row.varied[key] for row in known]
        at = [shown.scale * one for one in values] if found.numeric(key) else [*map(str, values)]
        place = list(found.scene.probes).index(probe)
        marker = MARKERS[models.index(model) % len(MARKERS)]
        how: dict[str, Any] = {
            "color": colours[fixed],
            "marker": marker,
            "ms": 3.6,
            "lw": 0.9,
            "markerfacecolor": "white",
        }
        how |= {"ls": (0, (4, 1.5))} if model == found.reference else {}
        left.plot(at, [1e3 * row.u[place, axis] for row in known], label=plain(f"{model}  {fixed}"), **how)
        off = [(x, 100.0 * row.error) for x, row in zip(at, known, strict=True) if row.error is not None]
        if off:
            right.plot(*zip(*off, strict=True), **how)
    name, bracket = Column(key, shown_unit=shown.shown).heading(shown=True)
    for panel, label in ((left, f"{AXES[axis]} at {plain(probe)} [mm]"), (right, "error at the probes [%]")):
        panel.set_xlabel(f"{plain(name)} {bracket}")
        panel.set_ylabel(label)
    right.set_ylim(bottom=0.0)
    handles, labels = left.get_legend_handles_labels()
    named, columns = min(len(labels), MOST), 1 if style.narrow else 2
    below: dict[str, Any] = {"ncols": columns, "frameon": False, "fontsize": 7}
    figure.legend(handles[:named], labels[:named], loc="outside lower center", **below)
    if style.titled:
        title = plain(found.scene.title or found.scene.name, longest=110)
        figure.suptitle(title, x=0.01, ha="left", fontsize=8.5)
    figure.set_size_inches(style.width, 2.6 * style.panels(2)[0] + 0.18 * -(-named // columns) + 0.3)
    return figure
