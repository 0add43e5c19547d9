"""The picture of the locking sweeps: error on a fixed mesh against thickness, for every model and ν."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import groupby

from matplotlib.figure import Figure

from fem_reference.verification import Row
from fem_reference.verification.locking import MODELS
from sheetbench.answers.figure_style import PLAIN, FigureStyle

WIDEST, HEIGHT = 4.6, 2.9  # inches
MARKERS = {"plate": "s", "shell": "o", "solid": "^"}
COLOURS = {"plate": "#7d848c", "shell": "#20252b"}
SOLID_COLOURS = ("#fbb061", "#ee6a5a", "#b8327a", "#5c187f")  # from compressible to incompressible


def compose(rows: Sequence[Row], style: FigureStyle = PLAIN) -> Figure:
    """|w − w_converged| / w_converged in per cent over h/a, with the tolerances dashed."""
    figure = Figure(figsize=(min(style.width, WIDEST), HEIGHT), layout="constrained")
    axes = figure.add_subplot()
    colours = iter(SOLID_COLOURS)
    for (model, poisson), curve in groupby(rows, key=_series):
        points = list(curve)
        label = f"{model}, 8 × 8" if model != "solid" else f"solid, 8 × 8 × 1, ν = {poisson:g}"
        axes.plot(
            [row.at["h/a"] for row in points],
            [100.0 * (row.relative or 0.0) for row in points],
            marker=MARKERS[model],
            color=COLOURS.get(model) or next(colours),
            markersize=4.0,
            linewidth=1.2,
            label=label,
        )
    for row in {row.tolerance: row for row in rows}.values():
        axes.axhline(100.0 * row.tolerance, color="#c9ced4", linestyle="--", linewidth=1.0, zorder=0)
        axes.text(1.1e-5, 105.0 * row.tolerance, f"held to {100.0 * row.tolerance:g} %", color="#7d848c")
    axes.set(xscale="log", yscale="log", ylim=(5e-3, 6.0))
    axes.set(xlabel="thickness / side [–]", ylabel="deflection off its converged value [%]")
    axes.legend(frameon=False, ncols=2, loc="lower left", fontsize=6.5)
    return figure


def _series(row: Row) -> tuple[str, float]:
    """Return the model and Poisson's ratio of a row."""
    return MODELS[row.case], row.at["ν"]
