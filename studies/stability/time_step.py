"""Study `time-step`: which steps the integrators stand, and what steps cost in energy, period and amplitude.

Explicit: velocity Verlet's limit by bisection, over the one that `lumped.step_limit` computes. The
limit of central differences with the velocity half a step old, (2/ω_max)(√(1+ξ²) − ξ), is drawn beside it:
the scheme corrects the velocity once and stands up to 1.6 times as much. Implicit: steps from 1e-6 s to 1 s
on a first mode of 1e-3 of the thickness; trapezoidal theory asks for a period error of (ωh)²/12.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

import lumped
from comparisons.stability import tiles as maps
from comparisons.stability.answer import MICROSECONDS
from comparisons.stability.limit import energy, measured_limit, start, system
from comparisons.stability.rows import LARGE, Cell, Row, percent
from lumped import INTEGRATORS, StepFailed, step_limit, turn_limit
from sheetbench.answers.style import DARK, GREY
from sheetbench.answers.table import SECONDS
from sheetbench.scenes import Gravity
from studies.stability.equilibria import FALLEN
from studies.stability.survey import Study, columns
from studies.stability.vibrating import FirstMode, follow, weightless

IMPLICIT = ("generalised-alpha", "midpoint")
COLOURS = dict(zip(IMPLICIT, ("#0072b2", "#009e73"), strict=True))
AMPLITUDE = 1e-3  # of the thickness
SAFE_STEPS = 2000
FEWEST, MOST = 12, 60  # steps of an implicit run


def cells(full: bool) -> list[Cell]:
    """Verlet over grid, kz, damping, thickness; the implicit integrators over the step."""
    grids = (5, 9, 17, 33) if full else (5, 9, 17)
    every: list[Cell] = [
        {"integrator": "verlet", "masses": n, "vertical": kz, "damping_ratio": xi, "slenderness": 0.016}
        for n in grids
        for kz in ("4 C", "E l²/h")
        for xi in (0.0, 0.03, 0.3, 1.0, 10.0)
    ]
    every += [
        {"integrator": "verlet", "masses": 9, "vertical": "4 C", "damping_ratio": 0.0, "slenderness": h}
        for h in (1e-3, 5e-3, 0.05)
    ]
    every.append({**every[0], "masses": 9, "precision": "single"})
    decades = np.arange(-6.0, 0.01, 0.5 if full else 1.0)
    every += [{"integrator": name, "step": float(10.0**d)} for name in IMPLICIT for d in decades]
    return every


def measure(integrator: str, **cell: Any) -> Row:
    """The row of a cell."""
    return _explicit(**cell) if INTEGRATORS[integrator].explicit else _implicit(integrator, **cell)


def _explicit(
    masses: int, vertical: str, damping_ratio: float, slenderness: float, precision: Any = "double"
) -> Row:
    scene = weightless(slenderness)
    springs = lumped.calibrate(scene.sheet, scene.material, grid=(masses, masses))
    if vertical != "4 C":
        spacing = scene.sheet.length_x / (masses - 1)
        kz = scene.material.young * spacing**2 / scene.sheet.thickness
        springs = springs.with_constant("vertical", kz)
    rest = system(scene, springs)
    flat = np.zeros_like(rest.problem.loads.dead)
    undamped = step_limit(rest, flat)
    damping_time = 2.0 * damping_ratio / undamped.frequency
    scene = weightless(slenderness, damping_time=damping_time)
    equations = system(scene, springs, precision)
    limit = step_limit(equations, flat)
    measured = measured_limit(equations, limit.step)
    heavy = scene.replace(gravity=Gravity(acceleration=(0.0, 0.0, -9.81)))
    duration = SAFE_STEPS * limit.advised
    run = lumped.simulate(
        heavy, springs, duration, integrator="verlet", every=0.1 * duration, precision=precision
    )
    return {
        "status": str(run.status),
        "message": run.message,
        "error": abs(measured / limit.step - 1.0),
        "iterations": run.steps,
        "frequency": limit.frequency,
        "ratio_at_limit": limit.damping_ratio,
        "computed": limit.step,
        "measured": measured,
        "measured_over_computed": measured / limit.step,
    }


def _implicit(integrator: str, step: float) -> Row:
    scene = weightless()
    springs = lumped.calibrate(scene.sheet, scene.material, grid=(9, 9))
    equations = system(scene, springs)
    mode = FirstMode(equations, springs)
    method = INTEGRATORS[integrator](equations, step)
    count = int(np.clip(2.0 * mode.period / step, FEWEST, MOST))
    first = start(equations, AMPLITUDE * scene.sheet.thickness * mode.shape)
    turned = mode.omega * step
    row: Row = {"turn": turned, "theory": turned**2 / 12.0, "iterations": count, "period": mode.period}
    try:
        states = follow(method, first, step, count)
    except StepFailed as failure:
        return {**row, "status": "diverged", "message": str(failure)}
    q = np.array([mode.coordinate(state.u) for state in states])
    p = np.array([mode.coordinate(state.v) for state in states]) / mode.omega
    turning, size = np.unwrap(np.arctan2(-p, q)), np.hypot(q, p)
    angle = turning[-1] - turning[0]
    periods = turned * count / (2.0 * np.pi)
    drift = energy(equations, states[-1]) / energy(equations, first) - 1.0
    finite = bool(np.isfinite([angle, size[-1], drift]).all())
    error = abs(turned * count / angle - 1.0) if finite and angle else None
    row |= {
        "status": "converged" if finite else "non-finite",
        "error": error,
        "period_error": error,
        "amplitude_decay": float(1.0 - (size[-1] / size[0]) ** (1.0 / periods)) if finite else None,
        "energy_drift": float(drift / max(periods, 1.0)) if finite else None,
    }
    if error is not None and error > LARGE:
        finer = _implicit(integrator, 0.1 * step)
        left = finer["error"] if finer["status"] == "converged" else None
        if left is not None and left < FALLEN * error:
            evidence = f"{turned / (2.0 * np.pi):.2g} periods a step; a tenth of it leaves {percent(left)} %"
            row |= {"mechanism": "resolution", "evidence": evidence}
    return row


def draw(figure: Figure, rows: list[Row]) -> None:
    """Left: measured limits over the computed ones against damping. Right: period error and decay."""
    left, right = figure.subplots(1, 2)
    explicit = [row for row in rows if row["cell"]["integrator"] == "verlet" and "measured" in row]
    xi = np.logspace(-2.3, 2.0, 120)
    central = 2.0 * (np.sqrt(1.0 + xi**2) - xi)
    left.plot(xi, [turn_limit(x) for x in xi], **maps.THEORY)
    left.plot(xi, central, color=DARK, lw=0.9, ls=(0, (4, 2)))
    shades = {5: "#56b4e9", 9: "#0072b2", 17: "#002a4d", 33: "#000000"}
    for row in explicit:
        at = max(row["ratio_at_limit"], 5e-3)
        marker = "o" if row["cell"]["vertical"] == "4 C" else "^"
        colour = shades[row["cell"]["masses"]]
        left.plot(at, row["measured"] * row["frequency"], marker, ms=4, mfc="white", mec=colour)
    left.set(xscale="log", yscale="log", ylabel="largest stable ω_max h")
    left.set(xlabel="damping ratio ξ at ω_max (left end: none)", title="Explicit: velocity Verlet")
    for name, colour in COLOURS.items():
        mine = [r for r in rows if r["cell"]["integrator"] == name and r["status"] == "converged"]
        at = [r["cell"]["step"] for r in mine]
        right.plot(at, [max(r["period_error"] or 0.0, 1e-9) for r in mine], "-o", ms=3, lw=0.9, color=colour)
        decay = [max(abs(r["amplitude_decay"] or 0.0), 1e-9) for r in mine]
        right.plot(at, decay, "--s", ms=2.5, lw=0.7, color=colour, mfc="white")
    implicit = [r for r in rows if "theory" in r]
    steps = np.logspace(-6, 0, 50)
    omega = implicit[0]["turn"] / implicit[0]["cell"]["step"] if implicit else 1.0
    right.plot(steps, np.maximum((omega * steps) ** 2 / 12.0, 1e-9), **maps.THEORY)
    right.set(xscale="log", yscale="log", ylim=(1e-9, 20.0))
    right.set(xlabel="time step [s]", title="Implicit: errors of a period")
    for axis in (left, right):
        maps.plain(axis)
    handles = [
        maps.theory("computed limit; (ωh)²/12"),
        Line2D([], [], color=DARK, lw=0.9, ls=(0, (4, 2)), label="central differences"),
        *(
            Line2D([], [], ls="", marker="o", mfc="white", mec=c, label=f"{n}×{n}×2")
            for n, c in shades.items()
            if any(row["cell"]["masses"] == n for row in explicit)
        ),
        Line2D([], [], ls="", marker="^", mfc="white", mec=DARK, label="kz = E l²/h"),
        *(Line2D([], [], color=c, label=n) for n, c in COLOURS.items()),
        Line2D([], [], color=GREY, ls="--", marker="s", ms=2.5, mfc="white", label="loss of amplitude"),
    ]
    figure.legend(handles=handles, loc="outside lower center", ncols=5, frameon=False, fontsize=6.5)


STUDY = Study(
    name="time-step",
    title="Time steps that the integrators stand, and what longer ones cost",
    says="Explicit: the measured limit of velocity Verlet (`error`: its distance from the computed one, "
    "2/(ω_max(ξ + √(1 − 3ξ²))) for ξ < 1/2 and 1/(ω_max ξ) beyond), over the grid, the stiffness of vertical "
    "springs, damping in proportion to stiffness, thickness and precision; `status` is that of 2000 "
    "default steps, nine tenths of the limit, under gravity. Implicit: the first mode's period (`error`), "
    "amplitude and energy over steps from 1e-6 s to 1 s.",
    cells=cells,
    measure="studies.stability.time_step:measure",
    columns=columns(
        integrator="",
        masses="d",
        vertical="",
        damping_ratio="g",
        slenderness="g",
        precision="",
        step=SECONDS("g"),
        computed=MICROSECONDS(".4g"),
        measured=MICROSECONDS(".4g"),
        measured_over_computed=".3f",
        amplitude_decay=".2e",
        energy_drift=".2e",
    ),
    draw=draw,
)
