"""Figures of identifications: the fit and its residuals over the plan or over time; of a tensile test the
curves, measured and of every law, and the misfits.
"""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from comparisons.identification.answer import Identification
from comparisons.identification.measurements import Displacements
from comparisons.identification.tensile.laws import stress
from comparisons.identification.tensile.tensile import TensileFit
from sheetbench.answers.figure_style import PLAIN, FigureStyle
from sheetbench.answers.style import COMPONENTS, DARK, GREY, plain
from sheetbench.answers.table import quantity

HEIGHT = 3.0  # of a panel [inches]
SHADES = "magma_r"


def compose(answer: Identification, style: FigureStyle = PLAIN) -> Figure:
    """Draw model over measurement at the left (of a point cloud the distribution of distances), residuals at
    the right: over the plan, or of a motion over time. Lengths in millimetres."""
    rows, columns = style.panels(2)
    figure = Figure(figsize=(style.width, rows * HEIGHT), layout="constrained")
    left, right = figure.subplots(rows, columns)
    measured = answer.measured
    if isinstance(measured, Displacements):
        _draw_fit(left, 1e3 * measured.displacement, 1e3 * answer.residuals)
    else:
        left.hist(1e3 * answer.residuals, bins="auto", color=COMPONENTS["uz"])
        left.set(xlabel="distance from the model's surface [mm]", ylabel="points")
    if isinstance(measured, Displacements) and measured.time is not None:
        for name, column in zip(COMPONENTS, 1e3 * answer.residuals.T, strict=True):
            right.plot(measured.time, column, ".", color=COMPONENTS[name], markersize=3, label=name)
        right.axhline(0.0, color=GREY, linewidth=0.6)
        right.set(xlabel="time [s]", ylabel="model − measurement [mm]")
        right.legend(frameon=False, ncols=3)
    else:
        _draw_map(figure, right, answer)
    values = [
        f"{name} = {quantity(u.value, u.unit, '.4g')}" if u.determined else f"{name}: not determined"
        for name, u in answer.unknowns.items()
    ]
    for axis, title in ((left, "\n".join(["Fit", *values])), (right, "Residuals")):
        axis.set_title(title, loc="left", fontsize=7.5, fontweight="bold")
    if style.titled:
        figure.suptitle(plain(answer.scene.title or answer.scene.name, longest=105), fontsize=8)
    return figure


def _draw_fit(axis: Axes, measured: np.ndarray, residuals: np.ndarray) -> None:
    ends = [np.nanmin(measured), np.nanmax(measured)]
    axis.plot(ends, ends, color=GREY, linewidth=0.8, label="equal")
    for name, values, residual in zip(COMPONENTS, measured.T, residuals.T, strict=True):
        axis.plot(values, values + residual, "o", color=COMPONENTS[name], markersize=3, alpha=0.7, label=name)
    axis.set(xlabel="measured [mm]", ylabel="model [mm]")
    axis.locator_params(nbins=6)
    axis.legend(frameon=False)


def _draw_map(figure: Figure, axis: Axes, answer: Identification) -> None:
    """Draw the length of every residual on the plan."""
    sheet, plan = answer.scene.sheet, 1e3 * answer.measured.points[:, :2]
    residuals = np.nan_to_num(1e3 * answer.residuals).reshape(len(plan), -1)
    size = np.linalg.norm(residuals, axis=1)
    x, y = 1e3 * sheet.length_x, 1e3 * sheet.length_y
    axis.plot([0, x, x, 0, 0], [0, 0, y, y, 0], color=DARK, linewidth=0.6)
    dots = axis.scatter(plan[:, 0], plan[:, 1], c=size, cmap=SHADES, vmin=0.0, s=22, edgecolors=GREY, lw=0.4)
    figure.colorbar(dots, ax=axis, label="|model − measurement| [mm]", shrink=0.9)
    axis.set_aspect("equal")
    axis.set(xlabel="x [mm]", ylabel="y [mm]")


MARKS = {"uniaxial": "o", "pure-shear": "s", "equibiaxial": "^"}
COLORS = ("#4c72b0", "#dd8452", "#55a868", "#c44e52")


def tensile(answer: TensileFit, style: FigureStyle = PLAIN) -> Figure:
    """Draw stress over stretch at the left, misfit over stretch at the right."""
    rows, columns = style.panels(2)
    figure = Figure(figsize=(style.width, rows * HEIGHT), layout="constrained")
    left, right = figure.subplots(rows, columns)
    for curve in answer.curves:
        sample = slice(None, None, max(1, len(curve.stretch) // 40))
        points, label = (curve.stretch[sample], 1e-6 * curve.stress[sample]), f"{curve.test}, measured"
        left.plot(*points, MARKS[curve.test], color=GREY, markersize=3, label=label)
        largest = float(np.abs(curve.stress).max())
        stretches = np.linspace(min(1.0, curve.stretch.min()), curve.stretch.max(), 200)
        for fit, color in zip(answer.fits, COLORS, strict=False):
            width = 1.8 if fit is answer.law else 0.9
            law = fit.law if curve is answer.curves[0] else None
            curve_stress = 1e-6 * stress(fit.energy, curve.test, stretches)
            left.plot(stretches, curve_stress, color=color, linewidth=width, label=law)
            misfit = stress(fit.energy, curve.test, curve.stretch) - curve.stress
            right.plot(curve.stretch, 100.0 * misfit / largest, color=color, linewidth=width)
    right.axhline(0.0, color=DARK, linewidth=0.6)
    left.set(xlabel="stretch λ", ylabel="engineering stress [MPa]")
    right.set(xlabel="stretch λ", ylabel="law − measurement [% of the largest stress]")
    left.legend(frameon=False)
    for axis, title in ((left, "Stress"), (right, "Misfit")):
        axis.set_title(title, loc="left", fontweight="bold")
    return figure
