"""The pictures of a reproduction: published and computed displacements, the settling run, misfits."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import matplotlib
import numpy as np
from matplotlib.figure import Figure

from comparisons.report.style import DARK, GREY, STYLE, save
from comparisons.reproduction.nearest import SOURCE, target
from comparisons.reproduction.published import COMPONENTS, SOURCES, published
from comparisons.reproduction.settling import PROBE
from sheetbench.scenes.seed import PROBES, seed_inputs

if TYPE_CHECKING:
    from comparisons.reproduction.answers import Answer
    from comparisons.reproduction.reproduction import Reproduction
    from comparisons.reproduction.settling import Settling

BLUE, GREEN, RED, ORANGE = "#1b6ca8", "#3a9d6e", "#b5453c", "#d98e04"
PUBLISHED = {"published model": ("s", DARK), "published experiment": ("D", GREY)}
OURS = (("o", BLUE), ("o", RED), ("^", ORANGE), ("v", GREEN))
FARTHEST = 3.0  # times the largest published displacement: what moves more is not drawn
SCANNED: dict[tuple[tuple[int, ...], int], tuple[str, str]] = {
    ((1,), 0): ("test 1", BLUE),
    ((2,), 1): ("test 2, ends up", RED),
    ((2,), -1): ("test 2, ends down", ORANGE),
}
TICKS = {"sheet": (2, 5, 10, 20, 50, 100, 200), "lattice": (2, 3, 5, 7, 10, 15, 20)}


def picture(paths: Sequence[Path], compose: Callable[[], Figure]) -> None:
    """Write a picture."""
    with matplotlib.rc_context(STYLE):
        save(compose(), paths)


def test(one: Answer) -> Figure:
    """A panel a component: every source's displacement at every probe."""
    figure = Figure(figsize=(7.2, 2.9), layout="constrained")
    comparison = one.comparison
    moved = {f"published {source}": published(one.test, source) for source in SOURCES}
    marks: dict[str, tuple[str, str]] = dict(PUBLISHED)
    for solution, mark in zip(comparison.solutions, OURS, strict=False):
        moved[solution.model] = np.array(list(comparison.probes(solution).values()))
        marks[solution.model] = mark
    largest = float(np.nanmax(np.abs(moved["published model"])))
    far = [name for name, table in moved.items() if np.nanmax(np.abs(table)) > FARTHEST * largest]
    drawn = {name: table for name, table in moved.items() if name not in far}
    aside = dict(zip(drawn, np.linspace(-0.28, 0.28, len(drawn)), strict=True))
    panels = figure.subplots(1, 3)
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
        panel.set_title(f"$u_{COMPONENTS[axis][1]}$ [mm]", loc="left", fontsize=7.5, fontweight="bold")
        panel.spines[["top", "right"]].set_visible(False)
    labels = panels[-1].get_legend_handles_labels()
    figure.legend(*labels, loc="outside lower center", ncols=6, frameon=False, fontsize=6.5)
    left = "".join(
        f"; {name}, up to {1e3 * np.nanmax(np.abs(moved[name])):.0f} mm, not drawn" for name in far
    )
    figure.suptitle(f"{one.title}{left}", fontsize=8)
    return figure


def motion(settling: Settling) -> Figure:
    """ux, uy, uz of P4 over time, its static values, and the published ones."""
    figure = Figure(figsize=(7.2, 4.4), layout="constrained")
    panels = figure.subplots(3, 1, sharex=True)
    for axis, panel in enumerate(panels):
        for (model, run), colour in zip(settling.runs.items(), (BLUE, ORANGE), strict=False):
            panel.plot(run.time, 1e3 * run.probes[PROBE][:, axis], color=colour, linewidth=0.9, label=model)
            panel.axhline(1e3 * settling.rest[model][axis], color=colour, linewidth=0.6, linestyle=":")
        for source, style in zip(SOURCES, ("--", "-."), strict=True):
            value = 1e3 * published(1, source)[PROBES.index(PROBE), axis]
            if np.isfinite(value):
                panel.axhline(value, color=DARK, linewidth=0.7, linestyle=style, label=f"published {source}")
        panel.set_ylabel(f"$u_{COMPONENTS[axis][1]}$ [mm]")
        panel.spines[["top", "right"]].set_visible(False)
        panel.margins(x=0, y=0.08)
    panels[-1].set_xlabel("time [s]")
    figure.legend(*panels[-1].get_legend_handles_labels(), loc="outside lower center", ncols=4, frameon=False)
    figure.suptitle(f"Test 1 from rest: {PROBE}; dotted: the static answers", fontsize=8)
    return figure


def misfit(found: Reproduction) -> Figure:
    """Root mean square of the differences from the published table over the first number of each kind."""
    figure = Figure(figsize=(7.2, 2.8), layout="constrained")
    panels = dict(zip(SOURCE, figure.subplots(1, 2, sharey=True), strict=True))
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
        panel.spines[["top", "right"]].set_visible(False)
        panel.grid(color=GREY, lw=0.3, alpha=0.4)
        title = f"{kind.capitalize()} and published {SOURCE[kind]}"
        panel.set_title(title, loc="left", fontsize=7.5, fontweight="bold")
    given = seed_inputs()
    panels["sheet"].set(xlabel="E [MPa]", ylabel="misfit, rms of the largest [%]")
    panels["lattice"].set(xlabel=f"layer distance [mm], k = {given['k']:g} N/m")
    for kind, at, said in (
        ("sheet", 1e-6 * given["young"], "published E"),
        ("lattice", 1e3 * given["thickness"], "thickness"),
    ):
        panels[kind].axvline(at, color=GREY, lw=0.7, ls="--")
        panels[kind].annotate(
            said, (at, 98.0), (3, 0), textcoords="offset points", va="top", fontsize=6.5, color=GREY
        )
    panels["lattice"].legend(frameon=False, loc="lower left")
    return figure


PICTURES: dict[str, Callable[[Any], Callable[[], Figure]]] = {
    "test": lambda one: lambda: test(one),
    "motion": lambda settling: lambda: motion(settling),
    "misfit": lambda found: lambda: misfit(found),
}
