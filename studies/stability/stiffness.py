"""Study `stiffness`: Young's modulus over fourteen decades, load numbers over ten, uneven families.

scaled    E with the density that keeps the load number: nothing but the units changes, nor may the answer
fixed     the seed's density and E such that ρ g h a³/D runs from 1e-6 to 1e4; beyond ρ g a/E = 0.05, that
          is L = 0.6 (1 − ν²) (a/h)², strains are outside of the model
contrast  one family of springs made stiffer or softer: another sheet, so errors are the wrong limit's;
          what is asked is an answer or a status
"""

from __future__ import annotations

from dataclasses import replace

from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from comparisons.stability import tiles as maps
from comparisons.stability.rows import Cell, Row
from sheetbench.answers.style import DARK
from sheetbench.answers.table import Column
from sheetbench.scenes.strains import WEIGHT_LIMIT
from studies.stability.equilibria import compare, sheet
from studies.stability.study import Study

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
    import lumped

    scene = sheet(SLENDERNESS, CONTRAST_LOAD)
    springs = lumped.calibrate(scene.sheet, scene.material, grid=GRID)
    changed = {family: contrast * getattr(springs.springs, family)}
    uneven = replace(springs, springs=springs.springs.replace(**changed))
    return compare(scene, GRID, springs=uneven)


def draw(figure: Figure, rows: list[Row]) -> None:
    """Above: both sweeps as strips. Below: families against contrast."""
    top, bottom = figure.subplots(2, 1, height_ratios=(1.0, 2.0))
    scaled = [r for r in rows if "young" in r["cell"]]
    fixed = [r for r in rows if "load_number" in r["cell"]]
    uneven = [r for r in rows if "family" in r["cell"]]
    if scaled and fixed:
        left, right = top.get_subplotspec().subgridspec(1, 2).subplots()
        top.remove()
        maps.tiles(left, scaled, lambda r: r["cell"]["young"], lambda r: 0.0, scale=("log", "linear"))
        maps.tiles(right, fixed, lambda r: r["cell"]["load_number"], lambda r: 0.0, scale=("log", "linear"))
        right.axvline(WEIGHT_LIMIT * 12.0 * (1.0 - 0.48**2) / SLENDERNESS**2, **maps.THEORY)
        left.set(xlabel="Young's modulus [Pa]", yticks=[])
        right.set(xlabel="load number ρ g h a³/D", yticks=[])
        left.set_title("Load scaled with E: error [%]")
        right.set_title("At fixed load: error [%]")
    if uneven:
        maps.tiles(
            bottom,
            uneven,
            lambda r: r["cell"]["contrast"],
            lambda r: float(FAMILIES.index(r["cell"]["family"])),
            scale=("log", "linear"),
        )
        bottom.axvline(1.0, color=DARK, lw=0.8, ls=":")
    bottom.set_yticks(range(len(FAMILIES)), [name.replace("_", " ") for name in FAMILIES])
    bottom.set_xlabel("stiffness of one family over its calibrated value")
    bottom.set_title("One family out of proportion: error [%]")
    line = Line2D([], [], label="ρ g a/E = 0.05", **{**maps.THEORY, "zorder": 1})
    maps.key(figure, [maps.outcome(r) for r in rows], line)


STUDY = Study(
    name="stiffness",
    title="Stiffness over fourteen decades, and families out of proportion (one edge clamped, 9×9×2)",
    says="E from 1 Pa to 1e13 Pa with the density that keeps the load number at 10; load numbers from 1e-6 "
    "to 1e4 at E = 10 MPa; one family of springs multiplied by 1e-6 to 1e6. `error` against the shell; "
    "`single error`: of single precision against double. Boundary: ρ g a/E = 0.05.",
    cells=cells,
    measure="studies.stability.stiffness:measure",
    columns=(
        Column("young", "Pa", "Pa", 1.0, "g"),
        Column("load number", form="g"),
        Column("family"),
        Column("contrast", form="g"),
        Column("single error", "", "%", 100.0, ".1e"),
        Column("single status"),
    ),
    draw=draw,
    size=(7.2, 3.9),
)
