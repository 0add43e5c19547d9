"""The picture of a run: the probes over time, measured histories as points, the energies below."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import matplotlib
import numpy as np
from matplotlib.figure import Figure

from comparisons.motion.history import COMPONENTS, Measured, error
from comparisons.report.style import MOST, STYLE, plain, save
from sheetbench.scenes import History

COLOURS = ("#1b6ca8", "#3a9d6e", "#b5453c")


def plot(paths: Sequence[Path], history: History, title: str, measured: dict[str, Measured]) -> None:
    """Write the picture."""
    with matplotlib.rc_context(STYLE):
        save(compose(history, title, measured), paths)


def compose(history: History, title: str, measured: dict[str, Measured]) -> Figure:
    """The figure with a panel per probe, and the energies below; of many probes those that were measured, or
    else that move most."""
    shown = _shown(history, measured)
    count = len(shown)
    figure = Figure(figsize=(6.4, 1.5 * count + 1.9), layout="constrained")
    panels = figure.subplots(count + 1, 1, sharex=True, squeeze=False)[:, 0]
    for axis, name in zip(panels, shown, strict=False):
        u = history.probes[name]
        for i, (component, colour) in enumerate(zip(COMPONENTS, COLOURS, strict=True)):
            label = f"${component[0]}_{component[1]}$"
            axis.plot(history.time, 1e3 * u[:, i], color=colour, linewidth=1.0, label=label)
            if name in measured:
                points = measured[name]
                axis.plot(points.time, 1e3 * points.displacement[:, i], "o", color=colour, markersize=2.5)
        off = error(history, name, measured[name]) if name in measured else None
        said = "" if off is None else f"   (points measured; off by {100 * off:.1f} %)"
        axis.set_title(f"{plain(name, longest=60)}{said}", loc="left", fontsize=7.5, fontweight="bold")
        axis.set_ylabel("[mm]")
    panels[0].legend(loc="lower right", ncols=3, frameon=False)
    for name in ("kinetic", "elastic", "potential", "dissipated"):
        panels[-1].plot(history.time, 1e3 * history.energies[name], linewidth=0.9, label=name)
    panels[-1].plot(history.time, 1e3 * history.balance, "k--", linewidth=0.9, label="balance")
    panels[-1].set_ylabel("energy [mJ]")
    panels[-1].set_xlabel("time [s]")
    panels[-1].legend(loc="upper right", ncols=5, frameon=False, fontsize=6.5)
    for axis in panels:
        axis.spines[["top", "right"]].set_visible(False)
        axis.margins(x=0)
    left = f"; {count} of {len(history.probes)} probes" if count < len(history.probes) else ""
    said = f"{plain(title, width=95)}\n{history.label}, {history.integrator}{left}"
    figure.suptitle(said, fontsize=8)
    return figure


def _shown(history: History, measured: dict[str, Measured]) -> list[str]:
    """The probes with a panel, in the order of the scene."""
    names = list(history.probes)
    moves = {name: (name in measured, float(np.abs(history.probes[name]).max(initial=0.0))) for name in names}
    kept = set(sorted(names, key=lambda name: moves[name], reverse=True)[:MOST])
    return [name for name in names if name in kept]
