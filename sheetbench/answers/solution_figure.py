"""The picture of a solution: heights of the deformed sheet over its plan."""

from typing import Any

import numpy as np
from matplotlib.figure import Figure
from matplotlib.tri import Triangulation

from sheetbench.answers.figure_style import PLAIN, FigureStyle
from sheetbench.answers.report import NoPicture
from sheetbench.answers.solution import Solution
from sheetbench.answers.style import DARK, plain

CELLS = 64  # along each side


def compose(solution: Solution, style: FigureStyle = PLAIN) -> Figure:
    """Draw uz in mm over the plan, with the probes. Raises NoPicture if a displacement is not finite."""
    points, heights = solution.mesh.points, 1e3 * solution.mesh.point_data["displacement"][:, 2]
    if not np.isfinite(heights).all():
        raise NoPicture("a displacement is not a finite number")
    figure = Figure(figsize=(style.width / 2, style.width / 2), layout="constrained")
    axis = figure.add_subplot()
    drawn_as: dict[str, Any] = {"cmap": "viridis", "shading": "gouraud", "rasterized": True}
    quads = [cell[:, :4] for kind, cell in solution.mesh.cells if kind.startswith("quad")]
    if quads:
        (x, y), faces = 1e3 * points[:, :2].T, np.vstack(quads)
        triangles = np.vstack([faces[:, [0, 1, 2]], faces[:, [0, 2, 3]]])
        drawn: Any = axis.tripcolor(Triangulation(x, y, triangles), heights, **drawn_as)
    else:
        x, y = (np.linspace(float(side.min()), float(side.max()), CELLS + 1) for side in points[:, :2].T)
        plan = np.stack(np.meshgrid(x, y), axis=-1).reshape(-1, 2)
        heights = 1e3 * solution.displacement(plan)[:, 2].reshape(len(y), len(x))
        drawn = axis.pcolormesh(1e3 * x, 1e3 * y, heights, **drawn_as)
    for name, at in solution.points.items():
        axis.plot(1e3 * at[0], 1e3 * at[1], "o", markersize=3, markerfacecolor="white", markeredgecolor=DARK)
        axis.annotate(plain(name, longest=14), (1e3 * at[0], 1e3 * at[1]), (3, 3), textcoords="offset points")
    axis.set(xlabel="x [mm]", ylabel="y [mm]", aspect="equal")
    figure.colorbar(drawn, label="$u_z$ [mm]", shrink=0.8)
    if style.titled:
        axis.set_title(f"{solution.label}: {solution.status}", fontsize=8)
    return figure
