"""The picture of a run: the probes over time, the energies below."""

from typing import Any

import numpy as np
from matplotlib.figure import Figure

from sheetbench.answers.figure_style import PLAIN, FigureStyle
from sheetbench.answers.history import History
from sheetbench.answers.style import COMPONENTS, MOST, plain

DASHES: Any = {"uy": (0, (4, 4))}  # on a symmetric sheet the curve of uy lies on the curve of ux
LEGEND: Any = {"loc": "lower right", "bbox_to_anchor": (1.0, 1.0), "borderaxespad": 0.1, "frameon": False}


def compose(history: History, title: str, style: FigureStyle = PLAIN) -> Figure:
    """Draw a panel per probe, at most MOST with the largest displacements, and the energies below."""
    excursions = {name: float(np.abs(u).max(initial=0.0)) for name, u in history.probes.items()}
    largest = sorted(excursions, key=excursions.__getitem__, reverse=True)[:MOST]
    shown = [name for name in excursions if name in largest]
    count = len(shown)
    figure = Figure(figsize=(style.width, 1.5 * count + 1.9), layout="constrained")
    panels = figure.subplots(count + 1, 1, sharex=True, squeeze=False)[:, 0]
    for axis, name in zip(panels, shown, strict=False):
        u = history.probes[name]
        for i, (component, colour) in enumerate(COMPONENTS.items()):
            label = f"${component[0]}_{component[1]}$"
            dashes = DASHES.get(component, "-")
            axis.plot(history.time, 1e3 * u[:, i], ls=dashes, color=colour, linewidth=1.0, label=label)
        axis.set_title(plain(name, longest=60), loc="left", fontsize=7.5, fontweight="bold")
        axis.set_ylabel("displacement [mm]")
    panels[0].legend(ncols=3, **LEGEND)
    for name in ("kinetic", "elastic", "potential", "dissipated"):
        panels[-1].plot(history.time, 1e3 * history.energies[name], linewidth=0.9, label=name)
    panels[-1].plot(history.time, 1e3 * history.balance, "k--", linewidth=0.9, label="balance")
    panels[-1].set_ylabel("energy [mJ]")
    panels[-1].set_xlabel("time [s]")
    panels[-1].legend(ncols=3 if style.narrow else 5, fontsize=6.5, **LEGEND)
    for axis in panels:
        axis.margins(x=0)
    omitted = f"; {count} of {len(history.probes)} probes" if count < len(history.probes) else ""
    text = f"{plain(title, width=95)}\n{history.label}, {history.integrator}{omitted}"
    if style.titled:
        figure.suptitle(text, fontsize=8)
    return figure
