"""Study `load`: weights over nine decades, compression past buckling, links pulled to twice their length.

weight       Habibi et al.'s sheet, one edge clamped, from 1e-6 g to 1e3 g; ρ g a/E = 0.05 ends the model
reversed     the same weight up and down: mirror images, to rounding
compression  the clamped-free strip pressed along x up to ten times its Euler load π² E h³/48a² (per width),
             with a slight weight that chooses the side: both models bend to it
buckled      the same, the lattice requested a stable equilibrium: the same one
pull         the free edge pulled in its plane until the sheet doubles in length: a linear strip would at
             N = E h; strains beyond one half are outside of the model. Before, the two models differ by their
             laws: springs are linear in the change of length, the shell in Green's strain
tip          the middle of the free edge pulled by a point force, in units of E h a/10: the lattice spreads it
             over two cells, the shell's exact answer is infinite under it
"""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

import lumped
from comparisons.models.spec import GradingLike
from comparisons.stability import tiles as maps
from comparisons.stability.rows import Cell, Row, percent
from sheetbench.answers.table import Unit
from sheetbench.scenes import EdgeLoad, PointLoad
from sheetbench.scenes.strains import WEIGHT_LIMIT
from studies.stability.equilibria import POISSON, SIDE, compare, consistent, outcome, sheet
from studies.stability.survey import Study, columns

SLENDERNESS, ONE_G = 0.016, 2.0
GRID = (9, 9)
IMPERFECTION = 0.02  # load number of the weight that chooses the side a compressed sheet buckles to


def cells(full: bool) -> list[Cell]:
    """A kind of load and its size: in g, in Euler loads, in the pull that doubles the length."""
    decades = np.arange(-6.0, 3.01, 0.5 if full else 1.0)
    euler = (0.5, 0.8, 0.95, 1.05, 1.2, 1.5, 2.0, 3.0, 5.0, 7.0, 10.0)
    pulls = (0.001, 0.01, 0.1, 0.3, 0.6, 1.0, 1.5)
    every: list[Cell] = [{"kind": "weight", "size": float(10.0**d)} for d in decades]
    every += [{"kind": kind, "size": size} for kind in ("compression", "buckled") for size in euler]
    every += [{"kind": kind, "size": size} for kind in ("pull", "tip") for size in pulls]
    every += [{"kind": "reversed", "size": float(10.0**d)} for d in (-6, -3, 0, 1, 2)]
    return every


def measure(kind: str, size: float, grading: GradingLike = None) -> Row:
    """The row of a cell."""
    if kind == "reversed":
        return _mirrored(size, grading)
    scene = sheet(SLENDERNESS, ONE_G * size if kind == "weight" else IMPERFECTION)
    young, h, a = scene.material.young, scene.sheet.thickness, scene.sheet.length_x
    if kind == "tip":
        pull = PointLoad(at=(a, a / 2.0), force=(0.1 * size * young * h * a, 0.0, 0.0))
        scene = scene.replace(loads=(pull,))
    elif kind != "weight":
        euler = np.pi**2 * young * h**3 / 12.0 / (4.0 * a**2)
        force = float(size * young * h if kind == "pull" else -size * euler)
        scene = scene.replace(loads=(EdgeLoad(edge="x1", force_per_length=(force, 0.0, 0.0)),))
    springs = consistent(scene, grading)
    if kind == "buckled":
        stable = lumped.solve(scene, springs(GRID), branch="stable")
        moved = float(np.abs(stable.displacement(scene.probe_points())).max() / SIDE)
        return {**outcome(stable), "moved": moved}
    return compare(scene, GRID, springs=springs)


def _mirrored(size: float, grading: GradingLike) -> Row:
    """Weight up against weight down: the lattice's two answers as mirror images."""
    up, down = sheet(SLENDERNESS, -ONE_G * size), sheet(SLENDERNESS, ONE_G * size)
    above, below = (lumped.solve(scene, consistent(scene, grading)(GRID)) for scene in (up, down))
    points = down.probe_points()
    image = above.displacement(points) * np.array([1.0, 1.0, -1.0])
    there = below.displacement(points)
    off = float(np.abs(image - there).max() / np.abs(there).max())
    return {**outcome(above), "error": off, "reference": outcome(below)}


def draw(figure: Figure, rows: list[Row]) -> None:
    """A panel a kind, a strip of tiles a model, the boundary drawn over."""
    limit = WEIGHT_LIMIT * 12.0 * (1.0 - POISSON**2) / SLENDERNESS**2 / ONE_G
    panels = (
        ("weight", limit, "Weight [g] of Habibi et al.'s sheet; beyond the line ρ g a/E > 0.05"),
        ("compression", 1.0, "Compression / Euler load; band: between a beam's and a wide plate's"),
        ("pull", 0.5, "Pull on the edge / the pull that doubles the length; line: links half as long again"),
        ("tip", None, "Pull on a point / (E h a/10)"),
    )
    axes = figure.subplots(len(panels), 1, height_ratios=(2, 3, 2, 2))
    for axis, (kind, end, name) in zip(axes, panels, strict=True):
        mine = [row for row in rows if row["cell"]["kind"] == kind]
        strips = {
            "shell: factorisations": [(row, maps.iterations(row)) for row in maps.references(mine)],
            "lattice: error [%]": [(row, maps.error_in_percent(row)) for row in mine],
        }
        if kind == "compression":
            buckled = [row for row in rows if row["cell"]["kind"] == "buckled"]
            of_stable = [(row, percent(row.get("moved"))) for row in buckled]
            strips = {'branch = "stable": u/a [%]': of_stable, **strips}
            axis.axvspan(
                1.0, 1.0 / (1.0 - POISSON**2), color=maps.THEORY["color"], alpha=0.18, lw=0, zorder=4
            )
        shown = [{**row, "strip": strip, "text": text} for strip, of in strips.items() for row, text in of]
        if not shown:
            continue
        maps.strips(axis, shown, "size", lambda r: r["strip"], list(strips), text=lambda r: r["text"])
        if end is not None:
            axis.axvline(end, **maps.THEORY)
        axis.set_xlabel(name)
    maps.legend(figure, [*rows, *maps.references(rows)], maps.theory("boundary of theory"))


STUDY = Study(
    name="load",
    title="Loads: weight, compression and pull (one edge clamped, h/a = 0.016, 9×9×2)",
    says="Weight from 1e-6 g to 1e3 g; in-plane compression up to ten Euler loads, where a slight weight "
    'chooses the side that both models bend to (`buckled`: with branch = "stable", which finds the '
    "same); a pull on the edge up to one and a half times what doubles the length, and on a point of "
    "it; weights reversed (`error`: of the mirror image). Boundaries: ρ g a/E = 0.05; the Euler load of "
    "the clamped-free strip, as a beam and as a wide plate; links stretched by half. Pulled, the two "
    "models stand for different materials: springs are linear in the change of length, the shell in "
    "Green's strain, which hardens (a wrong limit, by as much as the strain). Under a point force the "
    "shell's exact answer is infinite, and each grid and mesh has its own.",
    cells=cells,
    measure="studies.stability.load:measure",
    columns=columns(kind="", size="g", moved=Unit("side", "%", 100.0)(".3g")),
    draw=draw,
    size=(7.2, 5.6),
    graded=True,
)
