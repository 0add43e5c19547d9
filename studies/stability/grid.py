"""Study `grid`: from 2×2 to 257×257 masses, cells up to fifty times as long as wide, distorted elements.

The consistent calibration's error falls like the square of the cell's size; the uniform one's does not fall
below that of the sheet that it stands for. Inner nodes of the reference's mesh are moved at random by a share
of the element's size: from 0.5 on elements may fold over, and such a mesh is refused.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

import fem_reference
import lumped
from comparisons.stability import tiles as maps
from comparisons.stability.rows import LARGE, Cell, Row, percent
from sheetbench.answers.style import DARK, GREY
from sheetbench.scenes import Scene
from studies.stability.equilibria import EDGES, FALLEN, Grid, compare, distance, outcome, sheet
from studies.stability.survey import Study, columns

SLENDERNESS, LOAD = 0.016, 3.0
ASPECTS = (1, 2, 5, 10, 20, 50)
DISTORTED, SEEDS, FINE = 6, 2, 16
FINEST = (49, 49)
MARKERS = {"plate": "^", "shell": "o", "solid": "s"}
COLOURS = {
    ("consistent", 1): "#0072b2",
    ("consistent", 2): "#56b4e9",
    ("uniform", 1): "#d55e00",
    ("uniform", 2): "#e69f00",
}


def cells(full: bool) -> list[Cell]:
    """Masses a side, aspect ratios along and across the clamp, distortions."""
    sizes = (2, 3, 5, 9, 17, 33, 65, 129, 257) if full else (2, 3, 5, 9, 17, 33, 65)
    every: list[Cell] = [
        {"clamped": n, "masses": m, "calibration": c}
        for n in EDGES
        for c in ("consistent", "uniform")
        for m in sizes
        if c == "consistent" or m <= 65
    ]
    every += [{"clamped": 1, "aspect": a, "long": along} for along in ("x", "y") for a in ASPECTS]
    shares = (0.0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.8)
    every += [
        {"clamped": n, "model": model, "distortion": d, "seed": s}
        for model in MARKERS
        for n in EDGES
        for d in shares
        for s in range(SEEDS)
    ]
    return every


def measure(clamped: int, **cell: Any) -> Row:
    """The row of a cell."""
    scene = sheet(SLENDERNESS, LOAD, EDGES[clamped])
    if "distortion" in cell:
        return _distorted(scene, **cell)
    if "aspect" in cell:
        many = 4 * cell["aspect"] + 1
        return compare(scene, (5, many) if cell["long"] == "x" else (many, 5))
    grid = (cell["masses"], cell["masses"])
    if cell["calibration"] == "consistent":
        return compare(scene, grid, elements=16, explain=cell["masses"] <= 33)

    def springs(grid: Grid) -> lumped.Calibration:
        return lumped.calibrate(scene.sheet, scene.material, grid=grid, method=cell["calibration"])

    row = compare(scene, grid, springs=springs, elements=16, explain=False)
    if (row["error"] or 0.0) <= LARGE:
        return row
    left = compare(scene, FINEST, springs=springs, elements=16, explain=False)["error"]
    evidence = f"{FINEST[0]}×{FINEST[1]} masses of the same calibration leave {percent(left)} %"
    kind = "wrong limit" if left > FALLEN * row["error"] else "resolution"
    return {**row, "mechanism": kind, "evidence": evidence}


def _distorted(scene: Scene, model: str, distortion: float, seed: int) -> Row:
    """A reference on a mesh with its inner nodes moved at random, against itself on a fine regular one."""
    from fem_reference.plate import statics as plate
    from fem_reference.shell import statics as shell
    from fem_reference.solid import statics as solid
    from fem_reference.surface.mesh import rectangle

    on: dict[str, Any] = {"plate": plate.solve_on, "shell": shell.solve_on, "solid": solid.solve_on}
    mesh = rectangle(scene.sheet, (DISTORTED, DISTORTED))
    moved = mesh.p.copy()
    inside = np.setdiff1d(np.arange(moved.shape[1]), mesh.boundary_nodes())
    size = scene.sheet.length_x / DISTORTED
    shift = np.random.default_rng(seed).uniform(-1.0, 1.0, (2, len(inside)))
    moved[:, inside] += distortion * size * shift
    solution = on[model](type(mesh)(moved, mesh.t).with_boundaries(mesh.boundaries), scene)
    truth = fem_reference.solve(scene, model=model, elements=FINE)
    row = {**outcome(solution), "error": distance(scene, solution, truth)}
    if (row["error"] or 0.0) > LARGE:
        regular = distance(scene, on[model](mesh, scene), truth)
        row |= {"mechanism": "resolution", "evidence": f"the regular mesh is off by {percent(regular)} %"}
    return row


def _curve(axis: Axes, rows: list[Row], key: str, form: str, less: int = 0, **style: Any) -> None:
    """Errors in percent over a number of the cell, less so many."""
    at, errors = [r["cell"][key] - less for r in rows], [100 * r["error"] for r in rows]
    axis.plot(at, errors, form, **{"ms": 3, "lw": 0.9, **style})


def draw(figure: Figure, rows: list[Row]) -> None:
    """Error against the grid, the cells' aspect ratio, the elements' distortion."""
    left, middle, right = figure.subplots(1, 3, sharey=True)

    def of(**wanted: Any) -> list[Row]:
        return [r for r in rows if r["error"] and wanted.items() <= r["cell"].items()]

    for (name, n), colour in COLOURS.items():
        _curve(left, of(calibration=name, clamped=n), "masses", "-o", less=1, color=colour)
    cells_ = np.array([2.0, 64.0])
    left.plot(cells_, 40.0 / cells_**2, **maps.THEORY)
    left.set(xscale="log", yscale="log", xlabel="cells a side", ylabel="error at the probes [%]")
    left.set(ylim=(3e-3, 100), title="Grid")
    for along, colour in (("x", "#0072b2"), ("y", "#d55e00")):
        mine = of(long=along)
        _curve(middle, mine, "aspect", "-o", color=colour, label=f"long along {along}")
        unstable = [r for r in mine if r["status"] == "unstable"]
        _curve(middle, unstable, "aspect", "o", ms=5, mfc=maps.OUTCOMES["unstable"], mec=colour)
    middle.set(xscale="log", xlabel="length / width of a cell", title="Aspect ratio")
    middle.legend(frameon=False, fontsize=6.5)
    for model, marker in MARKERS.items():
        for n in EDGES:
            colour = COLOURS["consistent", n]
            _curve(right, of(model=model, clamped=n), "distortion", marker, mfc="white", color=colour)
    lost = [r["cell"]["distortion"] for r in rows if r["cell"].get("model") and not r["error"]]
    right.plot(lost, [50.0] * len(lost), "x", ms=5, color=maps.OUTCOMES["diverged"])
    right.axvline(0.5, **{**maps.THEORY, "ls": "--"})
    right.set(xlabel="nodes moved / element size", title="Distorted elements (references)")
    for axis in (left, middle, right):
        maps.plain(axis)
        axis.axhline(5.0, color=GREY, lw=0.6, ls=":")
    lines = [
        Line2D([], [], color=c, marker="o", ms=3, label=f"{name}, {n} clamped")
        for (name, n), c in COLOURS.items()
    ]
    white: Any = {"ls": "", "ms": 3, "mfc": "white", "color": DARK}
    lines += [Line2D([], [], marker=marker, label=model, **white) for model, marker in MARKERS.items()]
    lines += [
        maps.theory("second order"),
        maps.theory("elements may fold over", ls="--"),
        Line2D([], [], ls="", marker="x", color=maps.OUTCOMES["diverged"], label="refused"),
        Line2D([], [], ls="", marker="o", mfc=maps.OUTCOMES["unstable"], mec=DARK, label="unstable"),
    ]
    figure.legend(handles=lines, loc="outside lower center", ncols=5, frameon=False, fontsize=6.8)


STUDY = Study(
    name="grid",
    title="Grids, cells and elements (h/a = 0.016, load number 3)",
    says="Masses a side with the consistent and the uniform calibration, one and two edges clamped; cells "
    "longer than wide (five masses along the long side); the references on meshes of 6 × 6 elements whose "
    "inner nodes are moved at random, against themselves on 16 × 16. Theory: an error that falls like the "
    "square of the cell's size; elements that may fold over once nodes move by half their size, and are "
    "refused. Cells of 20 : 1 and more, narrower than the layers are apart, let the compressed layer zigzag "
    "between its short links: `unstable`, though the equilibrium is as good as with wider cells.",
    cells=cells,
    measure="studies.stability.grid:measure",
    columns=columns(clamped="d", masses="d", calibration="", aspect="d", long="", model="", distortion="g"),
    draw=draw,
)
