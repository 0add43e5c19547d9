"""The picture of a tensile test: the measured curves and those of every law, and the misfit of each."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

from comparisons.identification.tensile.laws import stress
from comparisons.identification.tensile.tensile import TensileFit
from sheetbench.answers.figure_style import PLAIN, FigureStyle
from sheetbench.answers.style import DARK, GREY

HEIGHT = 3.0  # of a panel [inches]
MARKS = {"uniaxial": "o", "pure-shear": "s", "equibiaxial": "^"}
COLORS = ("#4c72b0", "#dd8452", "#55a868", "#c44e52")


def compose(found: TensileFit, style: FigureStyle = PLAIN) -> Figure:
    """Stress over stretch at the left, misfit over stretch at the right."""
    rows, columns = style.panels(2)
    figure = Figure(figsize=(style.width, rows * HEIGHT), layout="constrained")
    left, right = figure.subplots(rows, columns)
    for curve in found.curves:
        thin = slice(None, None, max(1, len(curve.stretch) // 40))
        left.plot(
            curve.stretch[thin],
            1e-6 * curve.stress[thin],
            MARKS[curve.test],
            color=GREY,
            markersize=3,
            label=f"{curve.test}, measured",
        )
        size = float(np.abs(curve.stress).max())
        at = np.linspace(min(1.0, curve.stretch.min()), curve.stretch.max(), 200)
        for fit, color in zip(found.fits, COLORS, strict=False):
            width = 1.8 if fit is found.law else 0.9
            label = fit.law if curve is found.curves[0] else None
            drawn = 1e-6 * stress(fit.energy, curve.test, at)
            left.plot(at, drawn, color=color, linewidth=width, label=label)
            off = stress(fit.energy, curve.test, curve.stretch) - curve.stress
            right.plot(curve.stretch, 100.0 * off / size, color=color, linewidth=width)
    right.axhline(0.0, color=DARK, linewidth=0.6)
    left.set(xlabel="stretch λ", ylabel="engineering stress [MPa]")
    right.set(xlabel="stretch λ", ylabel="law − measurement [% of the largest stress]")
    left.legend(frameon=False)
    for axis, title in ((left, "Stress"), (right, "Misfit")):
        axis.set_title(title, loc="left", fontweight="bold")
    return figure
