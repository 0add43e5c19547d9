"""The figure of a reproduced test: published and computed displacements."""

import numpy as np
from matplotlib.figure import Figure

from sheetbench.answers.figure_style import FigureStyle
from sheetbench.answers.style import DARK, GREY, SERIES
from studies.reproduction.answers import COMPONENTS, SOURCES, ReproducedTest, published
from studies.reproduction.published import PROBES

PUBLISHED = {"published model": ("s", DARK), "published experiment": ("D", GREY)}
OURS = tuple(zip("oXvP", (SERIES[0], SERIES[5], SERIES[1], SERIES[2]), strict=True))
FARTHEST = 3.0  # times the largest published displacement: sources with larger values are not drawn


def test(reproduced: ReproducedTest, style: FigureStyle) -> Figure:
    """Return a figure with a panel per component: displacements of every source at every probe."""
    comparison = reproduced.comparison
    sources = {f"published {source}": published(reproduced.test, source) for source in SOURCES}
    marks: dict[str, tuple[str, str]] = dict(PUBLISHED)
    for solution, mark in zip(comparison.solutions, OURS, strict=False):
        sources[solution.model] = np.array(list(comparison.probes(solution).values()))
        marks[solution.model] = mark
    limit = FARTHEST * float(np.nanmax(np.abs(sources["published model"])))
    drawn = {name: table for name, table in sources.items() if np.nanmax(np.abs(table)) <= limit}
    shift = dict(zip(drawn, np.linspace(-0.28, 0.28, len(drawn)), strict=True))
    figure = Figure(figsize=(style.width, 6.6 if style.narrow else 2.9), layout="constrained")
    panels = figure.subplots(*style.panels(3), squeeze=False).ravel()
    for axis, panel in enumerate(panels):
        for name, table in drawn.items():
            symbol, colour = marks[name]
            bars = None
            if name == comparison.reference.model and comparison.bar is not None:
                bars = 1e3 * comparison.bar.uncertainty.bar[:, axis]
            at, values = np.arange(len(PROBES)) + shift[name], 1e3 * table[:, axis]
            panel.errorbar(
                at, values, bars, fmt=symbol, color=colour, ms=3.5, elinewidth=0.8, capsize=3, label=name
            )
        panel.axhline(0.0, color=GREY, linewidth=0.5)
        panel.set_xticks(range(len(PROBES)), PROBES)
        panel.set_ylabel(f"$u_{COMPONENTS[axis][1]}$ [mm]")
    for name in sorted(sources.keys() - drawn):
        largest = 1e3 * np.nanmax(np.abs(sources[name]))
        panels[-1].plot([], [], " ", label=f"not drawn: {name}, up to {largest:.0f} mm")
    labels, columns = panels[-1].get_legend_handles_labels(), 2 if style.narrow else 6
    figure.legend(*labels, loc="outside lower center", ncols=columns, frameon=False, fontsize=6.5)
    if style.titled:
        figure.suptitle(reproduced.title, fontsize=8)
    return figure
