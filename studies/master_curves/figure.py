"""Figure of the master curves.

Drop over reach of a cantilever; critical Γ* of strips on edge, and a tip's way aside; the way of a turned
strip's tip. Codes with our numbers where they were run.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from comparisons.scoring.reference import references
from sheetbench.answers.figure_style import PLAIN, FigureStyle
from sheetbench.answers.style import DARK, GREY, SERIES
from studies.master_curves.curves import way

if TYPE_CHECKING:
    from studies.master_curves.study import MasterCurves

OPEN_MARKERS: dict[str, Any] = {"ls": "", "ms": 4.0, "mfc": "none"}
CODES = "xP*+"  # marks
LINE: dict[str, Any] = {"color": DARK, "lw": 1.0}
Way = Callable[[tuple[float, float, float]], float]


def compose(answer: MasterCurves, style: FigureStyle = PLAIN) -> Figure:
    """Return the figure."""
    figure = Figure(figsize=(style.width, 5.6), layout="constrained")
    (drop, turned), (critical, aside) = figure.subplots(2, 2)
    _cantilever(drop, answer)
    _critical(critical, answer)
    _aside(aside, answer)
    _turned(turned, answer)
    for axis in (drop, turned, critical, aside):
        axis.grid(True, which="major", color=GREY, alpha=0.25, lw=0.5)
        axis.legend(fontsize=6.0, frameon=False)
    return figure


def _cantilever(axis: Axes, answer: MasterCurves) -> None:
    models = list(dict.fromkeys(drop.model for drop in answer.drops))
    for number, model in enumerate(models):
        drops = [drop for drop in answer.drops if drop.model == model]
        if number == 0:
            axis.plot([d.load for d in drops], [d.exact for d in drops], label="heavy elastica", **LINE)
        mark, colour = "s" if model.startswith("shell") else "o", SERIES[number % len(SERIES)]
        loads, values = [d.load for d in drops], [d.found for d in drops]
        axis.plot(loads, values, mark, color=colour, label=model, **OPEN_MARKERS)
    _codes(axis, answer, "cantilever", lambda tip: tip[1] / (1.0 + tip[0]))
    axis.set(xscale="log", yscale="log", xlabel=r"Γ = $\rho_A g L^3/B$", ylabel="drop over reach H/W")


def _critical(axis: Axes, curves: MasterCurves) -> None:
    widths = [row.width for row in curves.buckled]
    axis.axhline(curves.narrow, ls="--", label="narrow strip", **LINE)
    axis.plot(widths, [row.shell for row in curves.buckled], color=SERIES[0], marker="s", ms=4, label="shell")
    lattice = [row.lattice for row in curves.buckled]
    axis.plot(widths, lattice, "o", color=SERIES[1], label="lattice", **OPEN_MARKERS)
    axis.set(xlabel="width over length", ylabel="critical Γ* on edge", ylim=(10.0, None))


def _aside(axis: Axes, answer: MasterCurves) -> None:
    cases = {_load(name): case for name, case in references("curves").items() if name.startswith("on-edge")}
    truth = [way(case.scene, case.values[0])[2] for case in cases.values()]
    axis.plot(list(cases), truth, "s-", ms=3, label="shell, reference set", **LINE)
    _codes(axis, answer, "on-edge", lambda tip: tip[2])
    axis.set(xlabel="Γ*, on edge and leaning by 0.01", ylabel="tip's way aside over length")


def _turned(axis: Axes, answer: MasterCurves) -> None:
    """Draw drop and way aside against Γ: lines of the narrow strip, marks of models."""
    models = list(dict.fromkeys(row.model for row in answer.twisted))
    for number, model in enumerate(models):
        rows = [row for row in answer.twisted if row.model == model]
        loads = [row.load for row in rows]
        if number == 0:
            axis.plot(loads, [row.narrow_drop for row in rows], "-", **LINE)
            axis.plot(loads, [row.narrow_aside for row in rows], "--", **LINE)
            axis.text(loads[-1], rows[-1].narrow_drop, "drop ", ha="right", va="bottom", fontsize=6.5)
            axis.text(loads[-1], rows[-1].narrow_aside, "aside ", ha="right", va="top", fontsize=6.5)
        ways = [row.drop for row in rows] + [row.aside for row in rows]
        axis.plot(loads * 2, ways, "so^"[number % 3], color=SERIES[number], label=model, **OPEN_MARKERS)
    _codes(axis, answer, "bend-twist", lambda tip: tip[1], lambda tip: tip[2])
    axis.set(xscale="log", xlabel="Γ, plane turned by 45°", ylabel="tip's way over length")


def _codes(axis: Axes, answer: MasterCurves, curve: str, *values: Way) -> None:
    for number, code in enumerate(dict.fromkeys(tip.code for tip in answer.tips)):
        tips = [tip for tip in answer.tips if tip.code == code and tip.case.startswith(curve)]
        if not tips:
            continue
        loads = [_load(tip.case) for tip in tips] * len(values)
        shown = [value((tip.along, tip.down, tip.aside)) for value in values for tip in tips]
        colour = (DARK, GREY)[number % 2]  # colours that no model of ours has
        axis.plot(loads, shown, CODES[number], ms=5, color=colour, label=code.split(",")[0])


def _load(name: str) -> float:
    return float(name.rpartition("-")[2])
