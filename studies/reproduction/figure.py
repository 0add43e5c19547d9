"""The picture of the nearest sheets: misfit over E, and over the layer distance."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.figure import Figure

from comparisons.reproduction.figure import legend
from sheetbench.answers.figure_style import FigureStyle
from sheetbench.answers.style import GREY, SERIES
from sheetbench.scenes.habibi import published_inputs
from studies.reproduction.nearest import SOURCE, target
from studies.reproduction.study import Forensics

SCANNED: dict[tuple[tuple[int, ...], int], tuple[str, str]] = {
    ((1,), 0): ("test 1", SERIES[0]),
    ((2,), 1): ("test 2, ends up", SERIES[5]),
    ((2,), -1): ("test 2, ends down", SERIES[1]),
}
TICKS = {"sheet": (2, 5, 10, 20, 50, 100, 200), "lattice": (2, 3, 5, 7, 10, 15, 20)}


def misfit(forensics: Forensics, style: FigureStyle) -> Figure:
    """Root mean square of the differences from the published table over the first number of each kind."""
    figure = Figure(figsize=(style.width, 5.2 if style.narrow else 2.8), layout="constrained")
    axes = figure.subplots(*style.panels(len(SOURCE)), squeeze=False).ravel()
    panels = dict(zip(SOURCE, axes, strict=True))
    for scan in forensics.scans:
        if (scan.tests, scan.sense) not in SCANNED:
            continue
        label, colour = SCANNED[scan.tests, scan.sense]
        wanted = target(scan.tests, SOURCE[scan.kind])
        known = np.isfinite(wanted)
        distance = np.sqrt(np.mean((scan.displacement[:, known] - wanted[known]) ** 2, axis=1))
        values = (1e-6 if scan.name == "young" else 1e3) * scan.values
        share = 100.0 * distance / np.nanmax(np.abs(wanted))
        panels[scan.kind].plot(values, share, ".-", color=colour, lw=0.9, ms=3, label=label)
    for kind, panel in panels.items():
        panel.set_xscale("log")
        panel.set_xticks(TICKS[kind], [str(tick) for tick in TICKS[kind]])
        panel.set_xticks([], minor=True)
        panel.set_ylim(0.0, 100.0)
        panel.set_ylabel("misfit, rms of the largest [%]")
        panel.grid(color=GREY, lw=0.3, alpha=0.4)
        title = f"{kind.capitalize()} and published {SOURCE[kind]}"
        panel.set_title(title, loc="left", fontsize=7.5, fontweight="bold")
    given = published_inputs()
    panels["sheet"].set_xlabel("E [MPa]")
    panels["lattice"].set_xlabel(f"layer distance [mm], k = {given['k']:g} N/m")
    for kind, at, label in (
        ("sheet", 1e-6 * given["young"], "published E"),
        ("lattice", 1e3 * given["thickness"], "thickness"),
    ):
        panels[kind].axvline(at, color=GREY, lw=0.7, ls="--")
        aside: dict[str, Any] = {"textcoords": "offset points", "va": "top", "fontsize": 6.5, "color": GREY}
        panels[kind].annotate(label, (at, 98.0), (3, 0), **aside)
    legend(figure, panels["lattice"], 1 if style.narrow else 3)
    return figure
