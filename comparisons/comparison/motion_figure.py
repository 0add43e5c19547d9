"""The figure of motions: displacements of probes over time, and differences from the reference."""

from typing import Any

import numpy as np
from matplotlib.figure import Figure

from comparisons.comparison.motion_answer import MotionComparison
from sheetbench.answers.figure_style import PLAIN, FigureStyle
from sheetbench.answers.style import DARK, SERIES, plain

MOST = 3  # probes
COLOURS = (SERIES[0], SERIES[5], *SERIES[1:5], *SERIES[6:])  # the reference's first
LEGEND: Any = {"loc": "lower right", "bbox_to_anchor": (1.0, 1.0), "borderaxespad": 0.1, "frameon": False}


def compose(motions: MotionComparison, style: FigureStyle = PLAIN) -> Figure:
    """Return a figure with a panel per probe, of its largest component, and a panel of differences."""
    reference, histories = motions.reference, motions.histories
    truth, others = histories[reference], [name for name in histories if name != reference]
    largest = {name: float(np.abs(u).max()) for name, u in truth.probes.items()}
    selected = set(sorted(largest, key=lambda name: largest[name], reverse=True)[:MOST])
    probes = [name for name in truth.probes if name in selected]
    figure = Figure(figsize=(style.width, 1.3 * len(probes) + 1.7), layout="constrained")
    panels = figure.subplots(len(probes) + 1, 1, sharex=True, squeeze=False)[:, 0]
    scale = max(largest.values()) or 1.0
    for number, (axis, probe) in enumerate(zip(panels, probes, strict=False)):
        component = int(np.abs(truth.probes[probe]).max(axis=0).argmax())
        colours = dict(zip((reference, *others), COLOURS, strict=False))
        for name, history in histories.items():
            line: Any = {"ls": "-", "zorder": 2} if name == reference else {"ls": (0, (4, 2)), "zorder": 3}
            label, values = plain(history.label, longest=44), 1e3 * history.probes[probe][:, component]
            axis.plot(history.time, values, color=colours[name], lw=1.0, label=label, **line)
        axis.set_title(f"$u_{'xyz'[component]}$ of {plain(probe, longest=40)}", loc="left", fontsize=7.5)
        axis.set_ylabel("displacement [mm]")
        if number == 0:
            axis.legend(ncols=2, **LEGEND)
        lattice = histories[others[0]]
        count = min(len(lattice.time), len(truth.time))
        errors = np.abs(lattice.probes[probe][:count] - truth.probes[probe][:count]).max(axis=1)
        label = plain(probe, longest=20)
        panels[-1].plot(truth.time[:count], 100.0 * errors / scale, lw=1.0, label=label)
    panels[-1].set_ylabel("difference\n[% of the peak]")
    panels[-1].legend(ncols=MOST, **LEGEND)
    panels[-1].set_xlabel("time [s]")
    for axis in panels:
        axis.axhline(0.0, color=DARK, lw=0.3)
        axis.margins(x=0)
    if style.titled:
        figure.suptitle(plain(motions.scene.title or motions.scene.name, width=95), fontsize=8)
    return figure
