"""The picture: drop over reach of a cantilever; critical Γ* of strips on edge, and how far one's tip goes
aside; the way of a turned strip's tip. Codes with our numbers where they were run."""

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

HOLLOW: dict[str, Any] = {"ls": "", "ms": 4.0, "mfc": "none"}
CODES = "xP*+"  # marks
LINE: dict[str, Any] = {"color": DARK, "lw": 1.0}
Way = Callable[[tuple[float, float, float]], float]


def compose(found: MasterCurves, style: FigureStyle = PLAIN) -> Figure:
    """Return the figure."""
    figure = Figure(figsize=(style.width, 5.6), layout="constrained")
    (drop, turned), (critical, aside) = figure.subplots(2, 2)
    _cantilever(drop, found)
    _critical(critical, found)
    _aside(aside, found)
    _turned(turned, found)
    for axis in (drop, turned, critical, aside):
        axis.grid(True, which="major", color=GREY, alpha=0.25, lw=0.5)
        axis.legend(fontsize=6.0, frameon=False)
    return figure


def _cantilever(axis: Axes, found: MasterCurves) -> None:
    models = list(dict.fromkeys(drop.model for drop in found.drops))
    for number, model in enumerate(models):
        own = [drop for drop in found.drops if drop.model == model]
        if number == 0:
            axis.plot([d.load for d in own], [d.exact for d in own], label="heavy elastica", **LINE)
        mark, colour = "s" if model.startswith("shell") else "o", SERIES[number % len(SERIES)]
        axis.plot([d.load for d in own], [d.found for d in own], mark, color=colour, label=model, **HOLLOW)
    _codes(axis, found, "cantilever", lambda tip: tip[1] / (1.0 + tip[0]))
    axis.set(xscale="log", yscale="log", xlabel=r"Γ = $\rho_A g L^3/B$", ylabel="drop over reach H/W")


def _critical(axis: Axes, found: MasterCurves) -> None:
    widths = [row.width for row in found.buckled]
    axis.axhline(found.narrow, ls="--", label="narrow strip", **LINE)
    axis.plot(widths, [row.shell for row in found.buckled], color=SERIES[0], marker="s", ms=4, label="shell")
    axis.plot(widths, [row.lattice for row in found.buckled], "o", color=SERIES[1], label="lattice", **HOLLOW)
    axis.set(xlabel="width over length", ylabel="critical Γ* on edge", ylim=(10.0, None))


def _aside(axis: Axes, found: MasterCurves) -> None:
    cases = {_load(name): case for name, case in references("curves").items() if name.startswith("on-edge")}
    truth = [way(case.scene, case.values[0])[2] for case in cases.values()]
    axis.plot(list(cases), truth, "s-", ms=3, label="shell, reference set", **LINE)
    _codes(axis, found, "on-edge", lambda tip: tip[2])
    axis.set(xlabel="Γ*, on edge and leaning by 0.01", ylabel="tip's way aside over length")


def _turned(axis: Axes, found: MasterCurves) -> None:
    """Drop and way aside against Γ: lines of the narrow strip, marks of models."""
    models = list(dict.fromkeys(one.model for one in found.twisted))
    for number, model in enumerate(models):
        own = [one for one in found.twisted if one.model == model]
        loads = [one.load for one in own]
        if number == 0:
            for values, line in (([o.narrow_drop for o in own], "-"), ([o.narrow_aside for o in own], "--")):
                axis.plot(loads, values, line, **LINE)
            axis.text(loads[-1], own[-1].narrow_drop, "drop ", ha="right", va="bottom", fontsize=6.5)
            axis.text(loads[-1], own[-1].narrow_aside, "aside ", ha="right", va="top", fontsize=6.5)
        ways = [one.drop for one in own] + [one.aside for one in own]
        axis.plot(loads * 2, ways, "so^"[number % 3], color=SERIES[number], label=model, **HOLLOW)
    _codes(axis, found, "bend-twist", lambda tip: tip[1], lambda tip: tip[2])
    axis.set(xscale="log", xlabel="Γ, plane turned by 45°", ylabel="tip's way over length")


def _codes(axis: Axes, found: MasterCurves, curve: str, *values: Way) -> None:
    for number, code in enumerate(dict.fromkeys(tip.code for tip in found.tips)):
        own = [tip for tip in found.tips if tip.code == code and tip.case.startswith(curve)]
        if not own:
            continue
        loads = [_load(tip.case) for tip in own] * len(values)
        shown = [value((tip.along, tip.down, tip.aside)) for value in values for tip in own]
        colour = (DARK, GREY)[number % 2]  # other than all models of ours
        axis.plot(loads, shown, CODES[number], ms=5, color=colour, label=code.split(",")[0])


def _load(name: str) -> float:
    return float(name.rpartition("-")[2])
