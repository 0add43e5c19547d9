"""Study `grid`: from 2×2 to 257×257 masses, cells up to fifty times as long as wide, distorted elements.

The consistent calibration's error falls like the square of the cell's size; the uniform one's does not fall
below that of the sheet that it stands for. Inner nodes of the reference's mesh are moved at random by a share
of the element's size: from 0.5 on elements may fold over, and such a mesh is refused.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from comparisons.stability import tiles as maps
from comparisons.stability.rows import LARGE, Cell, Row, percent
from sheetbench.answers.style import DARK, GREY
from sheetbench.answers.table import Column
from sheetbench.scenes.sheet import EdgeName
from studies.stability.equilibria import compare, distance, outcome, sheet
from studies.stability.study import Study

SLENDERNESS, LOAD = 0.016, 3.0
EDGES: dict[int, tuple[EdgeName, ...]] = {1: ("x0",), 2: ("x0", "y0")}
ASPECTS = (1, 2, 5, 10, 20, 50)
MODELS, DISTORTED, SEEDS, FINE = ("plate", "shell", "solid"), 6, 2, 16


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
        for model in MODELS
        for n in EDGES
        for d in shares
        for s in range(SEEDS)
    ]
    return every


def measure(clamped: int, **cell: Any) -> Row:
    """The row of a cell."""
    import lumped

    scene = sheet(SLENDERNESS, LOAD, EDGES[clamped])
    if "distortion" in cell:
        return _distorted(scene, **cell)
    if "aspect" in cell:
        many = 4 * cell["aspect"] + 1
        return compare(scene, (5, many) if cell["long"] == "x" else (many, 5))
    grid = (cell["masses"], cell["masses"])
    if cell["calibration"] == "consistent":
        return compare(scene, grid, elements=16, explain=cell["masses"] <= 33)
    springs = lumped.calibrate(scene.sheet, scene.material, grid=grid, method=cell["calibration"])
    row = compare(scene, grid, springs=springs, elements=16, explain=False)
    if (row["error"] or 0.0) > LARGE:
        row |= _limit(scene, cell, row["error"])
    return row


def _limit(scene: Any, cell: Cell, error: float) -> Row:
    """Wrong limit, where the finest lattice of the same calibration keeps the error; else resolution."""
    import lumped

    finest = (49, 49)
    springs = lumped.calibrate(scene.sheet, scene.material, grid=finest, method=cell["calibration"])
    left = compare(scene, finest, springs=springs, elements=16, explain=False)["error"]
    evidence = f"{finest[0]}×{finest[1]} masses of the same calibration leave {percent(left)} %"
    return {"mechanism": "wrong limit" if left > 2.0 / 3.0 * error else "resolution", "evidence": evidence}


def _distorted(scene: Any, model: str, distortion: float, seed: int) -> Row:
    """A reference on a mesh with its inner nodes moved at random, against itself on a fine regular one."""
    import fem_reference
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
        row |= {
            "mechanism": "resolution",
            "evidence": f"the regular mesh is off by {percent(regular)} %",
        }
    return row


def draw(figure: Figure, rows: list[Row]) -> None:
    """Error against the grid, the cells' aspect ratio, the elements' distortion."""
    left, middle, right = figure.subplots(1, 3, sharey=True)
    colours = {
        ("consistent", 1): "#0072b2",
        ("consistent", 2): "#56b4e9",
        ("uniform", 1): "#d55e00",
        ("uniform", 2): "#e69f00",
    }
    for (name, n), colour in colours.items():
        mine = [
            r
            for r in rows
            if r["cell"].get("calibration") == name and r["cell"]["clamped"] == n and r["error"]
        ]
        where = [r["cell"]["masses"] - 1 for r in mine]
        left.plot(where, [100 * r["error"] for r in mine], "-o", ms=3, lw=0.9, color=colour)
    cells_ = np.array([2.0, 64.0])
    left.plot(cells_, 40.0 / cells_**2, **maps.THEORY)
    left.set(
        xscale="log", yscale="log", xlabel="cells a side", ylabel="error at the probes [%]", ylim=(3e-3, 100)
    )
    left.set_title("Grid")
    for along, colour in (("x", "#0072b2"), ("y", "#d55e00")):
        mine = [r for r in rows if r["cell"].get("long") == along and r["error"]]
        at, errors = [r["cell"]["aspect"] for r in mine], [100 * r["error"] for r in mine]
        middle.plot(at, errors, "-o", ms=3, lw=0.9, color=colour, label=f"long along {along}")
        kinked = [r for r in mine if r["status"] == "unstable"]
        at, errors = [r["cell"]["aspect"] for r in kinked], [100 * r["error"] for r in kinked]
        middle.plot(at, errors, "o", ms=5, mfc=maps.OUTCOMES["unstable"], mec=colour)
    middle.set(xscale="log", xlabel="length / width of a cell")
    middle.set_title("Aspect ratio")
    middle.legend(frameon=False, fontsize=6.5)
    for model, marker in zip(MODELS, "^os", strict=True):
        for n, colour in ((1, "#0072b2"), (2, "#56b4e9")):
            mine = [r for r in rows if r["cell"].get("model") == model and r["cell"]["clamped"] == n]
            good = [r for r in mine if r["error"]]
            at, errors = [r["cell"]["distortion"] for r in good], [100 * r["error"] for r in good]
            right.plot(at, errors, marker, ms=3, mfc="white", color=colour)
            lost = [r["cell"]["distortion"] for r in mine if not r["error"]]
            right.plot(lost, [50.0] * len(lost), "x", ms=5, color=maps.OUTCOMES["diverged"])
    right.axvline(0.5, **{**maps.THEORY, "ls": "--"})
    right.set(xlabel="nodes moved / element size")
    right.set_title("Distorted elements (references)")
    for axis in (left, middle, right):
        maps.plain(axis)
        axis.axhline(5.0, color=GREY, lw=0.6, ls=":")
    lines = [
        Line2D([], [], color=c, marker="o", ms=3, label=f"{name}, {n} clamped")
        for (name, n), c in colours.items()
    ]
    lines += [
        Line2D([], [], ls="", marker=marker, ms=3, mfc="white", color=DARK, label=model)
        for model, marker in zip(MODELS, "^os", strict=True)
    ]
    lines += [
        Line2D([], [], label="second order", **{**maps.THEORY, "zorder": 1}),
        Line2D([], [], label="elements may fold over", **{**maps.THEORY, "ls": "--", "zorder": 1}),
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
    columns=(
        Column("clamped", form="d"),
        Column("masses", form="d"),
        Column("calibration"),
        Column("aspect", form="d"),
        Column("long"),
        Column("model"),
        Column("distortion", form="g"),
    ),
    draw=draw,
)
