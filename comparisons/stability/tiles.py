"""Stability maps: cells as tiles, coloured by outcome and labelled with errors, and lines of theory."""

from collections.abc import Callable, Iterable, Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch, Rectangle

from comparisons.stability.rows import FAULTS, LARGE, Row, percent
from sheetbench.answers.style import GREY, STYLE

MAP_STYLE = {**STYLE, "axes.titlesize": 8, "axes.titleweight": "bold", "axes.titlelocation": "left"}
# Colours light enough for text, distinct in grey and for colour-blind readers.
OUTCOMES = {
    "within 1 %": "#a8d5c2",
    "within 5 %": "#d9ecd2",
    "off by more than 5 %": "#f6c667",
    (NOT_COMPARED := "converged, not compared"): "#bfd5ea",
    "unstable": "#c9b3e0",
    "strain-outside-model": "#d0d0d0",
    "step-limit": "#ee9a7a",
    "diverged": "#d9634c",
    "singular": "#b98a6f",
    "inverted": "#8f6f9f",
    "non-finite": "#6b3030",
    (REFUSED := "refused"): "#ffffff",
    **dict.fromkeys(FAULTS.values(), "#000000"),
}
HATCHED: Any = {"hatch": "//////", "edgecolor": "#b0b0b0", "lw": 0.4}  # unlike a cell without a run
THEORY: Any = {"color": "#b2182b", "lw": 1.3, "zorder": 5}


def outcome(row: Row) -> str:
    """Return the colour key of a row."""
    error, status = row.get("error"), str(row["status"])
    if status != "converged":
        return FAULTS.get(status, status)
    if error is None:
        return NOT_COMPARED
    if error > LARGE:
        return "off by more than 5 %"
    return "within 1 %" if error <= 0.01 else "within 5 %"


def tiles(
    axis: Axes,
    rows: Sequence[Row],
    x: str | Callable[[Row], float],
    y: str | Callable[[Row], float],
    *,
    text: Callable[[Row], str] = lambda row: percent(row.get("error")),
    scale: tuple[str, str] = ("log", "log"),
) -> None:
    """Draw a tile per row at (x, y), extended half-way to its neighbours. x, y: keys of the cell, or
    functions of the row."""

    def at(coordinate: str | Callable[[Row], float], row: Row) -> float:
        return float(row["cell"][coordinate] if isinstance(coordinate, str) else coordinate(row))

    edges = []
    for coordinate, kind in ((x, scale[0]), (y, scale[1])):
        places = np.unique([at(coordinate, row) for row in rows])
        on = np.log(places) if kind == "log" else places
        half = 0.5 * np.diff(on)[[0, -1]] if len(on) > 1 else np.array([0.5, 0.5])
        ends = np.concatenate([[on[0] - half[0]], 0.5 * (on[1:] + on[:-1]), [on[-1] + half[1]]])
        edges.append((places, np.exp(ends) if kind == "log" else ends))
    for row in rows:
        (xs, across), (ys, up) = edges
        i, j = int(np.searchsorted(xs, at(x, row))), int(np.searchsorted(ys, at(y, row)))
        corner, size = (across[i], up[j]), (across[i + 1] - across[i], up[j + 1] - up[j])
        axis.add_patch(Rectangle(corner, *size, **tile_style(outcome(row))))
        middle = _mid(across, i, scale[0]), _mid(up, j, scale[1])
        axis.text(*middle, text(row), fontsize=5.2, ha="center", va="center")
    axis.set_xscale(scale[0])
    axis.set_yscale(scale[1])
    axis.set_xlim(edges[0][1][0], edges[0][1][-1])
    axis.set_ylim(edges[1][1][0], edges[1][1][-1])
    axis.tick_params(which="both", width=0.5, length=2)


def tile_style(outcome: str) -> dict[str, Any]:
    """Return colour and border of a tile."""
    border = HATCHED if outcome == REFUSED else {"edgecolor": "white", "lw": 0.8}
    return {"facecolor": OUTCOMES[outcome], **border}


def _mid(edges: np.ndarray, i: int, scale: str) -> float:
    return float(np.sqrt(edges[i] * edges[i + 1]) if scale == "log" else 0.5 * (edges[i] + edges[i + 1]))


def strips(
    axis: Axes,
    rows: Sequence[Row],
    x: str | Callable[[Row], float],
    name: Callable[[Row], str],
    names: Sequence[str],
    **more: Any,
) -> None:
    """Draw a strip of tiles per name, the first at the bottom; more: keywords of `tiles`."""
    tiles(axis, rows, x, lambda row: float(names.index(name(row))), scale=("log", "linear"), **more)
    axis.set_yticks(range(len(names)), names)


def theory(label: str, **style: Any) -> Line2D:
    """Return a legend entry for a line of theory."""
    return Line2D([], [], label=label, **{**THEORY, "zorder": 1, **style})


def legend(figure: Figure, rows: Iterable[Row], *lines: Any) -> None:
    """Draw a legend below the panels: the outcomes that occur in the rows, and lines."""
    occurring = set(map(outcome, rows))
    patches = [
        Patch(**{"edgecolor": GREY, **tile_style(name), "lw": 0.4}, label=name)
        for name in OUTCOMES
        if name in occurring
    ]
    below: Any = {"loc": "outside lower center", "ncols": 4, "frameon": False, "fontsize": 6.8}
    figure.legend(handles=[*patches, *lines], handlelength=1.6, **below)
