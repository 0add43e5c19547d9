"""Figures of the study: error of a linear lattice against stretch, and the tips of the block."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.figure import Figure

from sheetbench.answers.figure_style import PLAIN, FigureStyle
from sheetbench.answers.style import DARK, GREY, SERIES
from studies.rubber.study import STRETCHES

if TYPE_CHECKING:
    from studies.rubber.answer import Rubber
    from studies.rubber.beam import Block

DRAWN: dict[str, dict[str, Any]] = {
    "measured": {"ls": "", "marker": ".", "ms": 3.0, "color": DARK},
    "fitted to it": {"color": GREY},
    "one damper": {"color": SERIES[1]},
    "branches": {"color": SERIES[0]},
}


def of_lattices(answer: Rubber, style: FigureStyle = PLAIN) -> Figure:
    """Return error against stretch: of strips pulled and hung, by material, and of the square blown up."""
    drawn = Figure(figsize=(style.width, 3.1), layout="constrained")
    axes = drawn.subplots(1, 3, sharey=True)
    for axis, way in zip(axes, ("pulled", "hung"), strict=False):
        for strip in (strip for strip in answer.strips if strip.way == way):
            errors = 100.0 * np.array(list(strip.errors.values()))
            axis.plot(100.0 * np.array(STRETCHES), errors, ".-", ms=4, lw=1, label=strip.material)
    stretch, error = 100.0 * np.array([(row.stretch, row.error) for row in answer.squares], dtype=float).T
    axes[2].plot(stretch, error, ".-", ms=4, lw=1)
    blown = f"blown up ({answer.constants[0].material})"
    for axis, title in zip(axes, ("pulled", "hung", blown), strict=True):
        axis.axhspan(-2.0, 2.0, color="0.9", zorder=0, label="within 2 %")
        axis.set(title=title, xlabel="largest strain [%]")
    axes[0].set_ylabel("error of a linear lattice [%]")
    drawn.legend(*axes[0].get_legend_handles_labels(), loc="outside lower center", ncols=6, frameon=False)
    return drawn


def of_block(block: Block, style: FigureStyle = PLAIN) -> Figure:
    """Return tips over time by load: measured, fitted, with one damper and with branches."""
    drawn = Figure(figsize=(style.width, 2.9), layout="constrained")
    loads = list(dict.fromkeys(curve.load for curve in block.curves))
    for axis, load in zip(drawn.subplots(1, len(loads), squeeze=False)[0], loads, strict=True):
        for curve in (curve for curve in block.curves if curve.load == load):
            axis.plot(curve.time, 1e3 * curve.tip, lw=1, label=curve.what, **DRAWN[curve.what])
        axis.set(title=load, xlabel="time [s]")
    first = drawn.axes[0]
    first.set_ylabel("tip [mm]")
    drawn.legend(*first.get_legend_handles_labels(), loc="outside lower center", ncols=4, frameon=False)
    return drawn
