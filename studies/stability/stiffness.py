"""Study `stiffness`: Young's modulus over fourteen decades, load numbers over ten, uneven families.

scaled    E with the density that keeps the load number: nothing but the units changes, nor may the answer
fixed     Habibi et al.'s density and E such that ρ g h a³/D runs from 1e-6 to 1e4; beyond ρ g a/E = 0.05,
          that is L = 0.6 (1 − ν²) (a/h)², strains are outside of the model
contrast  one family of springs made stiffer or softer: another sheet, so errors are the wrong limit's;
          the result is an answer or a status
"""

from __future__ import annotations

from dataclasses import replace

from matplotlib.figure import Figure

import lumped
from comparisons.stability import tiles as maps
from comparisons.stability.rows import Cell, Row
from sheetbench.answers.style import DARK
from sheetbench.answers.table import PERCENT, Unit
from sheetbench.scenes.strains import WEIGHT_LIMIT
from studies.stability.equilibria import POISSON, Grid, compare, consistent, sheet
from studies.stability.survey import Study, columns

SLENDERNESS, SCALED_LOAD, CONTRAST_LOAD = 0.016, 10.0, 3.0
FAMILIES = ("axial", "diagonal", "vertical", "cross", "cross_diagonal")
GRID = (9, 9)


def cells(full: bool) -> list[Cell]:
    """E with the load scaled, load numbers at fixed load, one family out of proportion."""
    step = 1 if full else 2
    every: list[Cell] = [{"young": float(10.0**d)} for d in [*range(0, 13, step), 13]]
    every += [{"load_number": float(10.0**d)} for d in range(-6, 5, step)]
    decades = range(-6, 7) if full else (-6, -4, -2, -1, 1, 2, 4, 6)
    every += [{"family": name, "contrast": float(10.0**d)} for name in FAMILIES for d in decades]
    return every


def measure(
    young: float | None = None,
    load_number: float = SCALED_LOAD,
    family: str = "",
    contrast: float = 1.0,
) -> Row:
    """The row of a cell."""
    if not family:
        return compare(sheet(SLENDERNESS, load_number, young=young or 1e7), GRID, single=True)
    scene = sheet(SLENDERNESS, CONTRAST_LOAD)
    calibrated = consistent(scene)(GRID)
    changed = {family: contrast * getattr(calibrated.springs, family)}
    uneven = replace(calibrated, springs=calibrated.springs.replace(**changed))

    def springs(grid: Grid) -> lumped.Calibration:
        """The same constants on every grid."""
        return replace(uneven, grid=(*grid, uneven.grid[2]))

    return compare(scene, GRID, springs=springs)


def draw(figure: Figure, rows: list[Row]) -> None:
    """Above: both sweeps as strips. Below: families against contrast."""
    top, bottom = figure.subplots(2, 1, height_ratios=(1.0, 2.0))
    scaled = [r for r in rows if "young" in r["cell"]]
    fixed = [r for r in rows if "load_number" in r["cell"]]
    uneven = [r for r in rows if "family" in r["cell"]]
    if scaled and fixed:
        left, right = top.get_subplotspec().subgridspec(1, 2).subplots()
        top.remove()
        for axis, shown, key in ((left, scaled, "young"), (right, fixed, "load_number")):
            maps.tiles(axis, shown, key, lambda r: 0.0, scale=("log", "linear"))
        right.axvline(WEIGHT_LIMIT * 12.0 * (1.0 - POISSON**2) / SLENDERNESS**2, **maps.THEORY)
        left.set(xlabel="Young's modulus [Pa]", yticks=[])
        right.set(xlabel="load number ρ g h a³/D", yticks=[])
        left.set_title("Load scaled with E: error [%]")
        right.set_title("At fixed load: error [%]")
    if uneven:
        maps.strips(bottom, uneven, "contrast", lambda r: r["cell"]["family"], FAMILIES)
        bottom.axvline(1.0, color=DARK, lw=0.8, ls=":")
    bottom.set_yticks(range(len(FAMILIES)), [name.replace("_", " ") for name in FAMILIES])
    bottom.set_xlabel("stiffness of one family over its calibrated value")
    bottom.set_title("One family out of proportion: error [%]")
    maps.legend(figure, rows, maps.theory("ρ g a/E = 0.05"))


STUDY = Study(
    name="stiffness",
    title="Stiffness over fourteen decades, and families out of proportion (one edge clamped, 9×9×2)",
    says="E from 1 Pa to 1e13 Pa with the density that keeps the load number at 10; load numbers from 1e-6 "
    "to 1e4 at E = 10 MPa; one family of springs multiplied by 1e-6 to 1e6. `error` against the shell; "
    "`single error`: of single precision against double. Boundary: ρ g a/E = 0.05.",
    cells=cells,
    measure="studies.stability.stiffness:measure",
    columns=columns(
        young=Unit("Pa", "Pa")("g"),
        load_number="g",
        family="",
        contrast="g",
        single_error=PERCENT(".1e"),
        single_status="",
    ),
    draw=draw,
    size=(7.2, 3.9),
)
