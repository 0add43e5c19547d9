"""The picture of two motions: probes over time, what differs below, then the energies."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.figure import Figure

from comparisons.comparison.motion_answer import MotionComparison
from sheetbench.answers.figure_style import PLAIN, FigureStyle
from sheetbench.answers.style import DARK, SERIES, plain

MOST = 3  # probes
COLOURS = (SERIES[0], SERIES[5], *SERIES[1:5], *SERIES[6:])  # the reference's first
ABOVE: Any = {"loc": "lower right", "bbox_to_anchor": (1.0, 1.0), "borderaxespad": 0.1, "frameon": False}


def compose(found: MotionComparison, style: FigureStyle = PLAIN) -> Figure:
    """A panel a probe, of its component that moves farthest, a panel of differences, one of energies."""
    truth, others = found.histories[found.reference], [n for n in found.histories if n != found.reference]
    farthest = {name: float(np.abs(u).max()) for name, u in truth.probes.items()}
    kept = set(sorted(farthest, key=lambda name: farthest[name], reverse=True)[:MOST])
    shown = [name for name in truth.probes if name in kept]
    figure = Figure(figsize=(style.width, 1.3 * len(shown) + 3.0), layout="constrained")
    panels = figure.subplots(len(shown) + 2, 1, sharex=True, squeeze=False)[:, 0]
    scale = max(farthest.values()) or 1.0
    for number, (axis, probe) in enumerate(zip(panels, shown, strict=False)):
        component = int(np.abs(truth.probes[probe]).max(axis=0).argmax())
        colours = dict(zip((found.reference, *others), COLOURS, strict=False))
        for name, history in found.histories.items():
            values = 1e3 * history.probes[probe][:, component]
            dashed = "-" if name == found.reference else (0, (4, 2))
            axis.plot(
                history.time,
                values,
                ls=dashed,
                color=colours[name],
                lw=1.0,
                zorder=2 + (name != found.reference),
                label=plain(history.label, longest=44),
            )
        axis.set_title(f"$u_{'xyz'[component]}$ of {plain(probe, longest=40)}", loc="left", fontsize=7.5)
        axis.set_ylabel("displacement [mm]")
        if number == 0:
            axis.legend(ncols=2, **ABOVE)
        ours = found.histories[others[0]]
        count = min(len(ours.time), len(truth.time))
        off = ours.probes[probe][:count] - truth.probes[probe][:count]
        panels[-2].plot(
            truth.time[:count],
            100.0 * np.abs(off).max(axis=1) / scale,
            lw=1.0,
            label=plain(probe, longest=20),
        )
    panels[-2].set_ylabel("difference\n[% of the peak]")
    panels[-2].legend(ncols=MOST, **ABOVE)
    for i, name in enumerate(("kinetic", "elastic", "potential", "dissipated")):
        for model, history in ((m, h) for m, h in found.histories.items() if h.energies):
            dashed = "-" if model == found.reference else (0, (4, 2))
            label = name if model == found.reference else None
            panels[-1].plot(
                history.time, 1e3 * history.energies[name], ls=dashed, color=SERIES[i], lw=0.9, label=label
            )
    panels[-1].set_ylabel("energy [mJ]")
    panels[-1].set_xlabel("time [s]")
    panels[-1].legend(ncols=4, fontsize=6.5, **ABOVE)
    for axis in panels:
        axis.axhline(0.0, color=DARK, lw=0.3)
        axis.margins(x=0)
    if style.titled:
        figure.suptitle(plain(found.scene.title or found.scene.name, width=95), fontsize=8)
    return figure
