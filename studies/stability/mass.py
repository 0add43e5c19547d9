"""Study `mass`: neighbouring masses whose ratio reaches a million.

Masses alternate like a chess board in the ratio r, their sum kept. The light ones set ω_max, which grows like
√r; what it costs is steps. The conserving midpoint rule keeps the energy whatever the ratio.
"""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

import lumped
from comparisons.stability import tiles as maps
from comparisons.stability.answer import MICROSECONDS
from comparisons.stability.limit import energy, measured_limit, noise, start, system
from comparisons.stability.rows import Cell, Row
from lumped import INTEGRATORS, StepFailed, step_limit
from studies.stability.survey import Study, columns
from studies.stability.vibrating import follow, weightless

IMPLICIT_STEPS = 50
PER_LIMIT = 20.0  # the implicit step over the explicit limit


def cells(full: bool) -> list[Cell]:
    """Ratios from 1 to 1e6 on several grids."""
    grids = (5, 9, 17, 33) if full else (5, 9, 17)
    decades = range(7) if full else (0, 2, 4, 6)
    return [{"masses": n, "ratio": float(10.0**d)} for n in grids for d in decades]


def measure(masses: int, ratio: float) -> Row:
    """Verlet's limit, computed and measured; the energy that the midpoint rule loses in 50 steps."""
    scene = weightless()
    springs = lumped.calibrate(scene.sheet, scene.material, grid=(masses, masses))

    def chess(shares: np.ndarray) -> np.ndarray:
        j, i, _ = np.unravel_index(np.arange(len(shares)), (masses, masses, 2))
        uneven = shares * np.where((i + j) % 2, np.sqrt(ratio), 1.0 / np.sqrt(ratio))
        changed: np.ndarray = uneven * shares.sum() / uneven.sum()
        return changed

    equations = system(scene, springs, mass=chess)
    limit = step_limit(equations, np.zeros_like(equations.problem.loads.dead))
    measured = measured_limit(equations, limit.step)
    step = PER_LIMIT * limit.step
    first = start(equations, noise(equations))
    row: Row = {"computed": limit.step, "measured": measured, "error": abs(measured / limit.step - 1.0)}
    try:
        last = follow(INTEGRATORS["midpoint"](equations, step), first, step, IMPLICIT_STEPS)[-1]
    except StepFailed as failure:
        return {**row, "status": "diverged", "message": f"midpoint: {failure}"}
    drift = energy(equations, last) / energy(equations, first) - 1.0
    status = "converged" if np.isfinite(drift) else "non-finite"
    return {**row, "status": status, "iterations": IMPLICIT_STEPS, "energy_drift": drift}


def draw(figure: Figure, rows: list[Row]) -> None:
    """Left: the limit against the ratio. Right: measured over computed, and the midpoint rule's energy."""
    left, right = figure.subplots(1, 2)
    drift = right.twinx()
    sizes = sorted({r["cell"]["masses"] for r in rows})
    for n, colour in zip(sizes, ("#56b4e9", "#0072b2", "#002a4d", "k"), strict=False):
        mine = [r for r in rows if r["cell"]["masses"] == n and r["status"] == "converged"]
        ratio = [r["cell"]["ratio"] for r in mine]
        computed, measured, lost = (
            np.array([r[key] for r in mine]) for key in ("computed", "measured", "energy_drift")
        )
        left.plot(ratio, computed, color=maps.THEORY["color"], lw=1.0)
        left.plot(ratio, measured, "o", ms=4, mfc="white", mec=colour, label=f"{n}×{n}×2")
        right.plot(ratio, 100 * (measured / computed - 1), "-o", ms=3, lw=0.8, color=colour)
        shown = np.maximum(np.abs(lost), 1e-17)
        drift.plot(ratio, shown, "--s", ms=2.5, lw=0.7, mfc="white", color=colour)
    for axis in (left, right):
        axis.set(xscale="log", xlabel="ratio of neighbouring masses")
        maps.plain(axis)
    left.set(yscale="log", ylabel="largest stable step [s]", title="Velocity Verlet's limit")
    right.set(ylabel="measured − computed limit [%]", ylim=(-2.5, 2.5))
    right.set_title("How well it is foreseen; the midpoint rule's energy")
    right.axhspan(-2, 2, color="#f0f0f0", lw=0, zorder=0)
    drift.set(yscale="log", ylabel="energy drift, midpoint (dashed)", ylim=(1e-17, 1e-3))
    points, _ = left.get_legend_handles_labels()
    lines = [maps.theory("computed, 2/ω_max"), *points]
    figure.legend(handles=lines, loc="outside lower center", ncols=5, frameon=False)


STUDY = Study(
    name="mass",
    title="Neighbouring masses of unequal size",
    says="Masses alternate like a chess board. `error`: of the computed limit of velocity Verlet against the "
    "measured one. The conserving midpoint rule runs at twenty times that limit.",
    cells=cells,
    measure="studies.stability.mass:measure",
    columns=columns(
        masses="d",
        ratio="g",
        computed=MICROSECONDS(".4g"),
        measured=MICROSECONDS(".4g"),
        energy_drift=".1e",
    ),
    draw=draw,
)
