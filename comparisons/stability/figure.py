"""The figure of a scene's stability: a panel per varied parameter, a strip of tiles per model."""

import matplotlib
from matplotlib.figure import Figure

from comparisons.stability import tiles as maps
from comparisons.stability.answer import Stability
from comparisons.stability.rows import label_of, place
from sheetbench.answers.figure_style import FigureStyle
from sheetbench.choices import VARIED


def compose(stability: Stability, style: FigureStyle) -> Figure:
    """Return the figure."""
    by_study = {
        name: [r for r in stability.rows if r["study"] == name] for name in VARIED if name != "damping"
    }
    panels = {name: rows for name, rows in by_study.items() if rows}
    models = {name: list(dict.fromkeys(map(label_of, rows)))[::-1] for name, rows in panels.items()}
    heights = [1.0 + len(names) for names in models.values()]
    with matplotlib.rc_context(maps.MAP_STYLE):
        figure = Figure(figsize=(style.width, 0.8 + 0.24 * sum(heights)), layout="constrained")
        axes = figure.subplots(len(panels), 1, height_ratios=heights, squeeze=False)[:, 0]
        for axis, (name, rows) in zip(axes, panels.items(), strict=True):
            maps.strips(axis, rows, place, label_of, models[name])
            axis.set_xlabel(VARIED[name])
            if name == "time-step":
                axis.xaxis.set_major_formatter(lambda x, _: f"{1e3 * x:g}")
            else:
                at = sorted(set(map(place, rows)))
                axis.set_xticks(at, [f"{x:g}" for x in at])
                axis.set_xticks([], minor=True)
        if style.titled:
            title = f"Where each model of {stability.scene.name} holds; errors in %"
            figure.suptitle(title, x=0.01, ha="left", fontsize=9, fontweight="bold")
        maps.legend(figure, (row for rows in panels.values() for row in rows))
    return figure
