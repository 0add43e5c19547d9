"""Study `damping`: from none to a thousand times critical.

The sheet starts in its first mode, 1e-3 of the thickness large; with damping in proportion to the springs
(`damping_time`) or to the masses (`damping_rate`) its coordinate is that of one oscillator,

    q¨ + 2 ξ ω q˙ + ω² q = 0,

whose exact solution is the reference. Verlet's limit with stiffness-proportional damping falls like
1/(ω_max ξ_max), and ξ_max = ξ ω_max/ω: beyond 20 000 steps for a period the study does without.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

import lumped
from comparisons.stability import tiles as maps
from comparisons.stability.limit import start, system
from comparisons.stability.rows import LARGE, Cell, Row, percent
from lumped import StepFailed
from sheetbench.answers.table import SECONDS
from studies.stability.equilibria import FALLEN
from studies.stability.survey import Study, columns
from studies.stability.vibrating import FirstMode, follow, weightless

RATIOS = (0.0, 0.01, 0.1, 1.0, 10.0, 100.0, 1000.0)
INTEGRATORS = ("generalised-alpha", "midpoint", "verlet")
KINDS = ("springs", "masses")
STEPS_PER_PERIOD, MOST_STEPS = 100, 20_000
AMPLITUDE = 1e-3
CRITICAL: Any = {"marker": "v", "color": maps.THEORY["color"], "ms": 5.0, "ls": ""}


def cells(full: bool) -> list[Cell]:
    """Damping ratio of the first mode, kind of damping, integrator."""
    ratios = sorted({*RATIOS, 0.03, 0.3, 3.0, 30.0, 300.0}) if full else RATIOS
    return [
        {"integrator": name, "damping_of": kind, "damping_ratio": xi}
        for name in INTEGRATORS
        for kind in KINDS
        for xi in ratios
    ]


def measure(integrator: str, damping_of: str, damping_ratio: float) -> Row:
    """The largest error of the first mode's coordinate over a period, relative to its start."""
    still = weightless()
    springs = lumped.calibrate(still.sheet, still.material, grid=(5, 5))
    omega = FirstMode(system(still, springs), springs).omega
    key, value = ("damping_time", 2.0 / omega) if damping_of == "springs" else ("damping_rate", 2.0 * omega)
    scene = weightless(**{key: value * damping_ratio})
    equations = system(scene, springs)
    mode = FirstMode(equations, springs)
    step = mode.period / STEPS_PER_PERIOD
    limit = lumped.INTEGRATORS[integrator].limit(equations, np.zeros_like(equations.problem.loads.dead))
    if limit is not None:
        step = min(step, limit.advised)
    count = int(np.ceil(mode.period / step))
    if count > MOST_STEPS:
        reason = f"{count} steps of {step:.1e} s for a period: more than this study takes"
        return {"status": "refused", "message": reason, "step": step}
    row: Row = {"step": mode.period / count}
    try:
        error = _error(equations, mode, integrator, damping_ratio, count)
    except StepFailed as failure:
        return {**row, "status": "diverged", "message": str(failure)}
    row |= {"status": "converged", "error": error, "iterations": count}
    if not np.isfinite(error):
        return {**row, "status": "non-finite", "error": None}
    if error <= LARGE:
        return row
    try:
        left = _error(equations, mode, integrator, damping_ratio, 4 * count)
    except StepFailed as failure:
        return {**row, "mechanism": "unknown", "evidence": f"a quarter of the step fails: {failure}"}
    kind = "resolution" if left < FALLEN * error else "unknown"
    return {**row, "mechanism": kind, "evidence": f"a quarter of the step leaves {percent(left)} %"}


def _error(equations: lumped.System, mode: FirstMode, integrator: str, ratio: float, count: int) -> float:
    """The largest error of the mode's coordinate in so many steps, nan where numbers are not finite. Raises
    StepFailed."""
    step = mode.period / count
    first = start(equations, AMPLITUDE * equations.scene.sheet.thickness * mode.shape)
    states = follow(lumped.INTEGRATORS[integrator](equations, step), first, step, count)
    q = np.array([mode.coordinate(state.u) for state in states])
    return float(np.abs(q / q[0] - exact(ratio, mode.omega * step * np.arange(count + 1))).max())


def exact(ratio: float, phase: np.ndarray) -> np.ndarray:
    """q/q₀ of the damped oscillator from rest at the phases ω t (n,)."""
    if ratio < 1.0:
        turned = np.sqrt(1.0 - ratio**2)
        swing = np.cos(turned * phase) + ratio / turned * np.sin(turned * phase)
        return np.asarray(np.exp(-ratio * phase) * swing)
    if ratio == 1.0:
        return np.asarray(np.exp(-phase) * (1.0 + phase))
    root = np.sqrt(ratio**2 - 1.0)
    slow, fast = 1.0 / (ratio + root), ratio + root
    return np.asarray((fast * np.exp(-slow * phase) - slow * np.exp(-fast * phase)) / (fast - slow))


def draw(figure: Figure, rows: list[Row]) -> None:
    """A panel a kind of damping: integrators against the damping ratio; critical damping drawn over."""
    axes = figure.subplots(1, 2, sharey=True)
    shown = [{**row, "at": max(row["cell"]["damping_ratio"], 1e-3)} for row in rows]
    for axis, kind in zip(axes, KINDS, strict=True):
        mine = [row for row in shown if row["cell"]["damping_of"] == kind]
        if not mine:
            continue
        maps.strips(axis, mine, lambda r: r["at"], lambda r: r["cell"]["integrator"], INTEGRATORS)
        ratios = sorted({row["at"]: row["cell"]["damping_ratio"] for row in mine}.items())
        names = [f"{ratio:g}" if ratio else "none" for _, ratio in ratios]
        axis.set_xticks([at for at, _ in ratios], names, fontsize=6)
        axis.set_xticks([], minor=True)
        axis.plot(1.0, 1.0, transform=axis.get_xaxis_transform(), clip_on=False, **CRITICAL)
        axis.set_xlabel("damping ratio of the first mode")
        axis.set_title(f"Damping in proportion to the {kind}", pad=9)
    maps.legend(figure, rows, Line2D([], [], label="critical damping", **CRITICAL))


STUDY = Study(
    name="damping",
    title="Damping from none to a thousand times critical: error of the first mode over a period [%]",
    says="The first mode's coordinate against the exact damped oscillator, over one period from rest, at a "
    "hundred steps a period or Verlet's default step. `error` is relative to the start.",
    cells=cells,
    measure="studies.stability.damping:measure",
    columns=columns(integrator="", damping_of="", damping_ratio="g", step=SECONDS(".2e")),
    draw=draw,
    size=(7.2, 2.9),
)
