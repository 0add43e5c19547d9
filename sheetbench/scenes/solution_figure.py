"""The picture of a solution: heights of the deformed sheet over its plan."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

from sheetbench.answers.figure_style import PLAIN, FigureStyle
from sheetbench.answers.report import NoPicture
from sheetbench.answers.style import DARK, plain
from sheetbench.scenes.solution import Solution

CELLS = 64  # along each side


def compose(solution: Solution, style: FigureStyle = PLAIN) -> Figure:
    """uz in mm over the plan, with the probes. Raises NoPicture for what is not finite."""
    sides = solution.mesh.points[:, :2].T
    x, y = (np.linspace(float(side.min()), float(side.max()), CELLS + 1) for side in sides)
    plan = np.stack(np.meshgrid(x, y), axis=-1).reshape(-1, 2)
    height = 1e3 * solution.displacement(plan)[:, 2].reshape(len(y), len(x))
    if not np.isfinite(height).all():
        raise NoPicture("a displacement is not a finite number")
    figure = Figure(figsize=(style.width / 2, style.width / 2), layout="constrained")
    axis = figure.add_subplot()
    drawn = axis.pcolormesh(1e3 * x, 1e3 * y, height, cmap="viridis", shading="gouraud", rasterized=True)
    for name, at in solution.points.items():
        axis.plot(1e3 * at[0], 1e3 * at[1], "o", markersize=3, markerfacecolor="white", markeredgecolor=DARK)
        axis.annotate(plain(name, longest=14), (1e3 * at[0], 1e3 * at[1]), (3, 3), textcoords="offset points")
    axis.set(xlabel="x [mm]", ylabel="y [mm]", aspect="equal")
    figure.colorbar(drawn, label="$u_z$ [mm]", shrink=0.8)
    if style.titled:
        axis.set_title(f"{solution.label}: {solution.status}", fontsize=8)
    return figure
