"""Study `slenderness`: from foil to block, from rigid to hanging; Poisson's ratio from 0 to 0.4999.

One and two adjacent edges clamped, thickness/side against the load number ρ g h a³/D. Boundaries:

    ρ g a/E = 0.05   L = 0.05 · 12 (1 − ν²) (a/h)²: beyond it a linear law of stress and strain means nothing
    l = 2 δ          cells as long as two of the layers in which a thin sheet clamped at two edges stretches,
                     δ = √(h/κ)/(12(1−ν²))^¼ with κ ≈ L/8a: L = 32 (h/a)/√(12(1−ν²)) (a/l)²
"""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.figure import Figure

from comparisons.models.spec import GradingLike
from comparisons.stability import tiles as maps
from comparisons.stability.rows import Cell, Row
from sheetbench.answers.table import PERCENT, Column
from sheetbench.scenes.strains import WEIGHT_LIMIT
from studies.stability.equilibria import EDGES, NAMES, POISSON, compare, consistent, sheet
from studies.stability.survey import Study, columns

MASSES = {1: 33, 2: 17}
RATIOS = (0.0, 0.2, 0.3, 1.0 / 3.0, 0.4, 0.48, 0.499, 0.4999)
THICKNESS = 0.016  # over the side, where ν varies


def cells(full: bool) -> list[Cell]:
    """Slenderness by load number for both supports, the extremes of slenderness, Poisson's ratio."""
    slender = (1e-4, 3e-4, 1e-3, 3e-3, 0.01, 0.03, 0.1) if full else (1e-4, 1e-3, 0.01, 0.1)
    loads = (1e-3, 0.1, 1.0, 10.0, 30.0, 100.0, 300.0, 1e3) if full else (1e-3, 1.0, 10.0, 100.0, 1e3)
    every: list[Cell] = [
        {"clamped": n, "slenderness": h, "load_number": L} for n in EDGES for h in slender for L in loads
    ]
    every += [{"clamped": 1, "slenderness": h, "load_number": 1.0} for h in (1e-6, 1e-5, 0.3, 0.5)]
    every += [
        {"clamped": n, "slenderness": THICKNESS, "load_number": 3.0, "poisson": nu}
        for n in EDGES
        for nu in RATIOS
    ]
    return every


def measure(
    clamped: int,
    slenderness: float,
    load_number: float,
    poisson: float = POISSON,
    grading: GradingLike = None,
) -> Row:
    """The row of a cell; the springs' area stiffness with it, in units of the axial one."""
    scene = sheet(slenderness, load_number, EDGES[clamped], poisson=poisson)
    n = MASSES[clamped] if slenderness != THICKNESS else 17
    row = compare(scene, (n, n), springs=consistent(scene, grading), single=load_number == 1.0)
    springs: Any = consistent(scene)((n, n)).springs
    return {**row, "masses": n, "area_over_axial": springs.area / springs.axial}


def draw(figure: Figure, rows: list[Row]) -> None:
    """Maps of the lattice and the shell for both supports; Poisson's ratio below."""
    above_below = figure.add_gridspec(2, 1, height_ratios=(5, 1))
    axes: Any = above_below[0].subgridspec(2, 2, width_ratios=(7, 5)).subplots(sharey=True)
    strength = 12.0 * (1.0 - POISSON**2)
    at = np.logspace(-6, 0, 100)
    for n, (above, below) in zip(EDGES, axes.T, strict=True):
        mine = [r for r in rows if r["cell"]["clamped"] == n and "poisson" not in r["cell"]]
        if not mine:
            continue
        maps.tiles(above, mine, "slenderness", "load_number")
        maps.tiles(below, maps.references(mine), "slenderness", "load_number", text=maps.iterations)
        for axis in (above, below):
            axis.plot(at, WEIGHT_LIMIT * strength / at**2, **maps.THEORY)
        if n == 2:
            cell = 1.0 / (MASSES[2] - 1)
            above.plot(at, 32.0 * at / np.sqrt(strength) / cell**2, **{**maps.THEORY, "ls": "--"})
        above.set_title(f"Lattice {MASSES[n]}×{MASSES[n]}×2, {NAMES[n]}")
        below.set_title(f"Shell, {NAMES[n]}: factorisations")
        below.set_xlabel("thickness / side")
        above.tick_params(labelbottom=False)
    for axis in axes[:, 0]:
        axis.set_ylabel("load number ρ g h a³/D")
    strip = figure.add_subplot(above_below[1])
    soft = [r for r in rows if "poisson" in r["cell"]]
    if soft:
        maps.tiles(
            strip, soft, lambda r: RATIOS.index(r["cell"]["poisson"]), "clamped", scale=("linear", "linear")
        )
        strip.axvline(RATIOS.index(1.0 / 3.0), **{**maps.THEORY, "ls": ":"})
    strip.set_xticks(range(len(RATIOS)), [f"{ratio:.4g}" for ratio in RATIOS])
    strip.set_yticks(list(NAMES), list(NAMES.values()))
    strip.set_xlabel(f"Poisson's ratio (h/a = {THICKNESS}, L = 3)")
    strip.set_title("Lattice 17×17×2; left of 1/3 area springs are negative")
    maps.legend(
        figure,
        [*rows, *maps.references(rows)],
        maps.theory("ρ g a/E = 0.05"),
        maps.theory("cells twice as long as the stretching layer", ls="--"),
        maps.theory("area springs vanish", ls=":"),
    )


STUDY = Study(
    name="slenderness",
    title="Thickness and load: where lattice and shell stand (lattice: error [%])",
    says="Thickness over side against the load number, one and two adjacent edges clamped, ν = 0.48; then "
    "ν from 0 to 0.4999 at h/a = 0.016 and L = 3, where `area over axial` turns negative below ν = 1/3; "
    "`error` against the shell with 12 elements a side. Boundaries: ρ g a/E = 0.05; cells twice as long as "
    "the layer in which a sheet clamped at two edges stretches.",
    cells=cells,
    measure="studies.stability.slenderness:measure",
    columns=columns(
        clamped="d",
        slenderness="g",
        load_number="g",
        poisson=".4g",
        masses="d",
        area_over_axial=".3f",
        single_error=PERCENT(".1e", detail=True),
        single_status=Column(detail=True),
    ),
    draw=draw,
    size=(7.2, 6.2),
    graded=True,
)
