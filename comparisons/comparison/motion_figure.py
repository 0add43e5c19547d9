"""The picture of two motions: probes over time and what differs below."""

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
    """A panel a probe, of its component that moves farthest and a panel of differences."""
    truth, others = found.histories[found.reference], [n for n in found.histories if n != found.reference]
    farthest = {name: float(np.abs(u).max()) for name, u in truth.probes.items()}
    kept = set(sorted(farthest, key=lambda name: farthest[name], reverse=True)[:MOST])
    shown = [name for name in truth.probes if name in kept]
    figure = Figure(figsize=(style.width, 1.3 * len(shown) + 1.7), layout="constrained")
    panels = figure.subplots(len(shown) + 1, 1, sharex=True, squeeze=False)[:, 0]
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
        panels[-1].plot(
            truth.time[:count],
            100.0 * np.abs(off).max(axis=1) / scale,
            lw=1.0,
            label=plain(probe, longest=20),
        )
    panels[-1].set_ylabel("difference\n[% of the peak]")
    panels[-1].legend(ncols=MOST, **ABOVE)
    panels[-1].set_xlabel("time [s]")
    for axis in panels:
        axis.axhline(0.0, color=DARK, lw=0.3)
        axis.margins(x=0)
    if style.titled:
        figure.suptitle(plain(found.scene.title or found.scene.name, width=95), fontsize=8)
    return figure
