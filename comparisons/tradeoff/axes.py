"""Logarithmic axes of a trade-off's pictures."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter


def logarithmic(axis: Axes) -> None:
    """Both axes logarithmic, with plain numbers, a pale grid and no frame."""
    axis.set_xscale("log")
    axis.set_yscale("log")
    axis.grid(which="major", color="#e4e4e4", lw=0.5, zorder=-1)
    axis.set_axisbelow(True)
    for side in (axis.xaxis, axis.yaxis):
        side.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
        side.set_minor_locator(LogLocator(subs=range(2, 10)))
        side.set_minor_formatter(NullFormatter())
    axis.xaxis.set_minor_formatter(
        FuncFormatter(lambda value, _: f"{value:g}" if _decades(axis) < 1.5 and _leads(value) else "")
    )
    axis.tick_params(which="both", width=0.5, length=2.5)
    axis.tick_params(which="minor", length=1.5, labelsize=6.5)


def _decades(axis: Axes) -> float:
    low, high = axis.get_xlim()
    return float(np.log10(high / low))


def _leads(value: float) -> bool:
    """Whether a number is 2 or 5 times a power of ten."""
    return round(value / 10.0 ** np.floor(np.log10(value))) in (2, 5)
