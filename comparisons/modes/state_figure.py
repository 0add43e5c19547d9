"""Frequency responses: motion along z of the probe that moves most, by the frequency of each input."""

from __future__ import annotations

import re

import numpy as np
from matplotlib.figure import Figure

from comparisons.modes.state_space import Linearisation, unit_of
from sheetbench.answers.figure_style import PLAIN, FigureStyle
from sheetbench.answers.style import GREY, plain

POINTS = 600
SHOWN = 6  # inputs: a line each
PAST = 2.0  # times the highest frequency of the state space


def compose(found: Linearisation, style: FigureStyle = PLAIN) -> Figure:
    """Amplitude above, phase below."""
    space, matrices = found.space, found.matrices
    probe = moved_most(found)
    output = matrices.outputs.index(f"{probe} uz")
    shown = [i for i, name in enumerate(matrices.inputs) if _worth(name, probe)][:SHOWN]
    at = np.geomspace(0.2 * space.frequencies[0], PAST * space.frequencies[-1], POINTS)
    response = space.response(at)[:, output][:, shown]
    figure = Figure(figsize=(style.width, 4.4), layout="constrained")
    size, phase = figure.subplots(2, 1, sharex=True, height_ratios=(2, 1))
    for column, number in enumerate(shown):
        name = matrices.inputs[number]
        values = response[:, column]
        dashes = "-" if column % 2 == 0 else (0, (4, 2))  # the answers of a symmetric sheet lie on each other
        size.loglog(at, np.abs(values), ls=dashes, lw=1.0, label=f"{name} [{unit_of(name)}]")
        phase.semilogx(at, np.degrees(np.angle(values)), ls=dashes, lw=0.8)
    for axis in (size, phase):
        axis.grid(color=GREY, lw=0.3, alpha=0.4)
    size.set_ylabel(f"{plain(probe, longest=20)} uz [m per unit of input]")
    phase.set_ylabel("phase [°]")
    phase.set_yticks([-180, -90, 0, 90, 180])
    phase.set_xlabel("frequency [Hz]")
    size.legend(frameon=False, fontsize=6.5, ncols=1 if style.narrow else 2)
    if style.titled:
        named = plain(found.scene.title or found.scene.name, longest=80)
        probed = f"{plain(probe, longest=20)} along z, the probe that moves most at rest"
        size.set_title(f"{named}\n{probed}", fontsize=8.5, loc="left")
    return figure


def _worth(name: str, probe: str) -> bool:
    """Loads and commands, forces at the probe itself, edges moved along z."""
    return name.startswith(("load", "gravity")) or name.endswith(("curvature", " z")) or name == f"{probe} fz"


def moved_most(found: Linearisation) -> str:
    """Return the probe that a load or command at rest moves most along z, else a force at the probe itself;
    of those that are alike to three digits the last."""
    matrices, probes = found.matrices, list(found.scene.probes)
    acting = re.compile("load|gravity|.*curvature$")
    common = [i for i, name in enumerate(matrices.inputs) if acting.match(name)]

    def moved(probe: str) -> float:
        row = np.abs(matrices.jacobian[matrices.outputs.index(f"{probe} uz")])
        return float(f"{max(row[common or [matrices.inputs.index(f'{probe} fz')]]):.3g}")

    return max(reversed(probes), key=moved)
