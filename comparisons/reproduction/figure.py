"""The pictures of a reproduction: published and computed displacements, the settling run, misfits."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import matplotlib
import numpy as np
from matplotlib.figure import Figure

from comparisons.report.look import Look
from comparisons.report.style import DARK, GREY, SERIES, STYLE, save
from comparisons.reproduction.nearest import SOURCE, target
from comparisons.reproduction.published import COMPONENTS, SOURCES, published
from comparisons.reproduction.settling import PROBE
from sheetbench.scenes.seed import PROBES, seed_inputs

if TYPE_CHECKING:
    from comparisons.reproduction.answers import Answer
    from comparisons.reproduction.reproduction import Reproduction
    from comparisons.reproduction.settling import Settling

PUBLISHED = {"published model": ("s", DARK), "published experiment": ("D", GREY)}
OURS = tuple(zip("oXvP", (SERIES[0], SERIES[5], SERIES[1], SERIES[2]), strict=True))
FARTHEST = 3.0  # times the largest published displacement: what moves more is not drawn
SCANNED: dict[tuple[tuple[int, ...], int], tuple[str, str]] = {
    ((1,), 0): ("test 1", SERIES[0]),
    ((2,), 1): ("test 2, ends up", SERIES[5]),
    ((2,), -1): ("test 2, ends down", SERIES[1]),
}
TICKS = {"sheet": (2, 5, 10, 20, 50, 100, 200), "lattice": (2, 3, 5, 7, 10, 15, 20)}


def picture(paths: Sequence[Path], compose: Callable[[Any, Look], Figure], of: Any, look: Look) -> None:
    """Write a picture, one of PICTURES."""
    with matplotlib.rc_context(STYLE):
        save(compose(of, look), paths)


def test(one: Answer, look: Look) -> Figure:
    """A panel a component: every source's displacement at every probe."""
    comparison = one.comparison
    moved = {f"published {source}": published(one.test, source) for source in SOURCES}
    marks: dict[str, tuple[str, str]] = dict(PUBLISHED)
    for solution, mark in zip(comparison.solutions, OURS, strict=False):
        moved[solution.model] = np.array(list(comparison.probes(solution).values()))
        marks[solution.model] = mark
    limit = FARTHEST * float(np.nanmax(np.abs(moved["published model"])))
    drawn = {name: table for name, table in moved.items() if np.nanmax(np.abs(table)) <= limit}
    aside = dict(zip(drawn, np.linspace(-0.28, 0.28, len(drawn)), strict=True))
    figure = Figure(figsize=(look.width, 6.6 if look.narrow else 2.9), layout="constrained")
    panels = figure.subplots(*look.panels(3), squeeze=False).ravel()
    for axis, panel in enumerate(panels):
        for name, table in drawn.items():
            symbol, colour = marks[name]
            bars = None
            if name == comparison.reference.model and comparison.bar is not None:
                bars = 1e3 * comparison.bar.uncertainty.bar[:, axis]
            at, shown = np.arange(len(PROBES)) + aside[name], 1e3 * table[:, axis]
            panel.errorbar(
                at, shown, bars, fmt=symbol, color=colour, ms=3.5, elinewidth=0.8, capsize=3, label=name
            )
        panel.axhline(0.0, color=GREY, linewidth=0.5)
        panel.set_xticks(range(len(PROBES)), PROBES)
        panel.set_ylabel(f"$u_{COMPONENTS[axis][1]}$ [mm]")
        panel.spines[["top", "right"]].set_visible(False)
    for name in sorted(moved.keys() - drawn):
        most = 1e3 * np.nanmax(np.abs(moved[name]))
        panels[-1].plot([], [], " ", label=f"not drawn: {name}, up to {most:.0f} mm")
    _legend(figure, panels[-1], 2 if look.narrow else 6)
    if look.titled:
        figure.suptitle(one.title, fontsize=8)
    return figure


def motion(settling: Settling, look: Look) -> Figure:
    """ux, uy, uz of P4 over time, dotted its static values, and the published ones."""
    figure = Figure(figsize=(look.width, 4.6), layout="constrained")
    panels = figure.subplots(3, 1, sharex=True)
    for axis, panel in enumerate(panels):
        for (model, run), colour in zip(settling.runs.items(), SERIES, strict=False):
            panel.plot(run.time, 1e3 * run.probes[PROBE][:, axis], color=colour, linewidth=0.9, label=model)
            panel.axhline(1e3 * settling.rest[model][axis], color=colour, linewidth=0.7, linestyle=":")
        for source, style in zip(SOURCES, ("--", "-."), strict=True):
            value = 1e3 * published(1, source)[PROBES.index(PROBE), axis]
            if np.isfinite(value):
                panel.axhline(value, color=DARK, linewidth=0.7, linestyle=style, label=f"published {source}")
        panel.set_ylabel(f"$u_{COMPONENTS[axis][1]}$ of {PROBE} [mm]")
        panel.spines[["top", "right"]].set_visible(False)
        panel.margins(x=0, y=0.08)
    panels[-1].set_xlabel("time [s]")
    _legend(figure, panels[-1], 2 if look.narrow else 4)
    if look.titled:
        figure.suptitle(f"Test 1 from rest: {PROBE}; dotted: the static answers", fontsize=8)
    return figure


def misfit(found: Reproduction, look: Look) -> Figure:
    """Root mean square of the differences from the published table over the first number of each kind."""
    figure = Figure(figsize=(look.width, 5.2 if look.narrow else 2.8), layout="constrained")
    axes = figure.subplots(*look.panels(len(SOURCE)), squeeze=False).ravel()
    panels = dict(zip(SOURCE, axes, strict=True))
    for scan in found.scans:
        if (scan.tests, scan.sense) not in SCANNED:
            continue
        label, colour = SCANNED[scan.tests, scan.sense]
        wanted = target(scan.tests, SOURCE[scan.kind])
        known = np.isfinite(wanted)
        apart = np.sqrt(np.mean((scan.displacement[:, known] - wanted[known]) ** 2, axis=1))
        values = (1e-6 if scan.name == "young" else 1e3) * scan.values
        share = 100.0 * apart / np.nanmax(np.abs(wanted))
        panels[scan.kind].plot(values, share, ".-", color=colour, lw=0.9, ms=3, label=label)
    for kind, panel in panels.items():
        panel.set_xscale("log")
        panel.set_xticks(TICKS[kind], [str(tick) for tick in TICKS[kind]])
        panel.set_xticks([], minor=True)
        panel.set_ylim(0.0, 100.0)
        panel.set_ylabel("misfit, rms of the largest [%]")
        panel.spines[["top", "right"]].set_visible(False)
        panel.grid(color=GREY, lw=0.3, alpha=0.4)
        title = f"{kind.capitalize()} and published {SOURCE[kind]}"
        panel.set_title(title, loc="left", fontsize=7.5, fontweight="bold")
    given = seed_inputs()
    panels["sheet"].set_xlabel("E [MPa]")
    panels["lattice"].set_xlabel(f"layer distance [mm], k = {given['k']:g} N/m")
    for kind, at, said in (
        ("sheet", 1e-6 * given["young"], "published E"),
        ("lattice", 1e3 * given["thickness"], "thickness"),
    ):
        panels[kind].axvline(at, color=GREY, lw=0.7, ls="--")
        aside: dict[str, Any] = {"textcoords": "offset points", "va": "top", "fontsize": 6.5, "color": GREY}
        panels[kind].annotate(said, (at, 98.0), (3, 0), **aside)
    _legend(figure, panels["lattice"], 1 if look.narrow else 3)
    return figure


def _legend(figure: Figure, panel: Any, columns: int) -> None:
    labels = panel.get_legend_handles_labels()
    figure.legend(*labels, loc="outside lower center", ncols=columns, frameon=False, fontsize=6.5)


PICTURES: dict[str, Callable[[Any, Look], Figure]] = {"test": test, "motion": motion, "misfit": misfit}
