"""Maps: cells as tiles coloured by how they ended, errors written in them, theory drawn over them."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Patch, Rectangle

from comparisons.stability.rows import LARGE, Row, percent
from sheetbench.answers.style import GREY, STYLE

MAP_STYLE = {**STYLE, "axes.titlesize": 8, "axes.titleweight": "bold", "axes.titlelocation": "left"}
# Light enough to write on; distinct in grey and without telling red from green.
OUTCOMES = {
    "within 1 %": "#a8d5c2",
    "within 5 %": "#d9ecd2",
    "off by more than 5 %": "#f6c667",
    "converged": "#bfd5ea",
    "unstable": "#c9b3e0",
    "strain-outside-model": "#d0d0d0",
    "step-limit": "#ee9a7a",
    "diverged": "#d9634c",
    "singular": "#b98a6f",
    "inverted": "#8f6f9f",
    "non-finite": "#6b3030",
    "refused": "#ffffff",
    "failed": "#000000",
    "lost": "#000000",
}
THEORY: Any = {"color": "#b2182b", "lw": 1.3, "zorder": 5}


def outcome(row: Row) -> str:
    """Return the colour key of a row."""
    error = row.get("error")
    if row["status"] != "converged" or error is None:
        return str(row["status"])  # "converged" where there is no reference to be off from
    if error > LARGE:
        return "off by more than 5 %"
    return "within 1 %" if error <= 0.01 else "within 5 %"


def tiles(
    axis: Axes,
    rows: Sequence[Row],
    x: Callable[[Row], float],
    y: Callable[[Row], float],
    *,
    of: Callable[[Row], str] = outcome,
    text: Callable[[Row], str] | None = None,
    scale: tuple[str, str] = ("log", "log"),
) -> None:
    """One tile a row at (x, y), reaching half-way to its neighbours; several rows at one place share it."""
    edges = []
    for value, kind in ((x, scale[0]), (y, scale[1])):
        places = np.unique([value(row) for row in rows])
        at = np.log(places) if kind == "log" else places
        middle = 0.5 * (at[1:] + at[:-1])
        half = 0.5 * np.diff(at)[[0, -1]] if len(at) > 1 else np.array([0.5, 0.5])
        ends = np.concatenate([[at[0] - half[0]], middle, [at[-1] + half[1]]])
        edges.append((places, np.exp(ends) if kind == "log" else ends))
    for row in rows:
        (xs, across), (ys, up) = edges
        i, j = int(np.searchsorted(xs, x(row))), int(np.searchsorted(ys, y(row)))
        corner, size = (across[i], up[j]), (across[i + 1] - across[i], up[j + 1] - up[j])
        axis.add_patch(Rectangle(corner, *size, facecolor=OUTCOMES[of(row)], edgecolor="white", lw=0.8))
        label = text(row) if text is not None else percent(row.get("error"))
        axis.text(
            _mid(across, i, scale[0]), _mid(up, j, scale[1]), label, fontsize=5.2, ha="center", va="center"
        )
    axis.set_xscale(scale[0])
    axis.set_yscale(scale[1])
    axis.set_xlim(edges[0][1][0], edges[0][1][-1])
    axis.set_ylim(edges[1][1][0], edges[1][1][-1])
    axis.tick_params(which="both", width=0.5, length=2)


def _mid(edges: np.ndarray, i: int, scale: str) -> float:
    return float(np.sqrt(edges[i] * edges[i + 1]) if scale == "log" else 0.5 * (edges[i] + edges[i + 1]))


def key(figure: Figure, outcomes: Sequence[str], *lines: Any, columns: int = 4) -> None:
    """The colours that occur, and the theory's lines, below the panels."""
    patches = [
        Patch(facecolor=c, edgecolor=GREY, lw=0.4, label=n) for n, c in OUTCOMES.items() if n in outcomes
    ]
    figure.legend(
        handles=[*patches, *lines],
        loc="outside lower center",
        ncols=columns,
        frameon=False,
        fontsize=6.8,
        handlelength=1.6,
    )


def plain(axis: Axes) -> None:
    """Axes of curves in the same dress as the maps."""
    axis.grid(which="major", color="#e4e4e4", lw=0.5)
    axis.set_axisbelow(True)
    axis.tick_params(which="both", width=0.5, length=2)
