"""Study `curved edge`: a clamp bent from flat to a full circle, both ways, with gravity for and against it.

A sheet clamped to a rod bent to curvature κ stands out like a tape spring. At the clamp its weight bends it
by ρ g h a²/2 per width; a tape of subtended angle κ a snaps into a fold, which it then carries with the
moment (1 + ν) D κ when it is bent against its curvature, (1 − ν) D κ when along with it (Wüst 1954, Seffen
and Pellegrino 1999). With the load number L = ρ g h a³/D the fold is reached where

    L/2 = (1 ± ν) |κ a|.

κ > 0 lifts the ends of the edge towards +z, weight acts along −z.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.figure import Figure

from comparisons.models.spec import GradingLike
from comparisons.stability import tiles as maps
from comparisons.stability.rows import Cell, Row, percent
from sheetbench.scenes import Curved
from studies.stability.equilibria import POISSON, SIDE, compare, consistent, sheet
from studies.stability.survey import Study, columns

SLENDERNESS, GRID, ELEMENTS = 0.008, (17, 17), 12


def cells(full: bool) -> list[Cell]:
    """Turns of the rod's ends, as a share of the full circle, by load number."""
    turns = (0.0, 0.05, 0.1, 0.25, 0.5, 0.75, 1.0) if full else (0.0, 0.1, 0.25, 0.5, 1.0)
    loads = (0.0, 0.3, 1.0, 3.0, 10.0, 30.0, 100.0) if full else (0.0, 1.0, 3.0, 10.0, 30.0)
    both = sorted({sign * turn for turn in turns for sign in (-1.0, 1.0)})
    return [{"turn": turn + 0.0, "load_number": L} for turn in both for L in loads if turn or L]


def measure(turn: float, load_number: float, grading: GradingLike = None) -> Row:
    """The row of a cell: a rod bent to `turn` of a full circle."""
    curvature = 2.0 * np.pi * turn / SIDE
    supports = (Curved(edge="x0", curvature=float(curvature)),)
    scene = sheet(SLENDERNESS, load_number, supports=supports)
    return compare(scene, GRID, elements=ELEMENTS, springs=consistent(scene, grading))


def _root(turn: Any) -> Any:
    """Where a turn is drawn: at its square root, for small ones to have room."""
    return np.copysign(np.sqrt(np.abs(turn)), turn)


def _label(row: Row) -> str:
    """The error, and `s` for each snap on the way."""
    return "\n".join(filter(None, [percent(row["error"]), "s" * len(row["snaps"])]))


def draw(figure: Figure, rows: list[Row]) -> None:
    """Lattice and shell: load number against the rod's turn."""
    left, right = figure.subplots(1, 2, sharey=True)
    lowest = 0.3 * min((r["cell"]["load_number"] for r in rows if r["cell"]["load_number"]), default=1.0)
    shells = maps.references(rows)
    turns = np.linspace(-1.2, 1.2, 400)
    folds = 2.0 * np.where(turns > 0.0, 1.0 - POISSON, 1.0 + POISSON) * 2.0 * np.pi * np.abs(turns)
    ticks = np.array([-1.0, -0.5, -0.25, -0.1, 0.0, 0.1, 0.25, 0.5, 1.0])
    for axis, shown, text in ((left, rows, _label), (right, shells, maps.iterations)):
        maps.tiles(
            axis, shown, lambda r: _root(r["cell"]["turn"]), lambda r: max(r["cell"]["load_number"], lowest),
            scale=("linear", "log"), text=text,
        )  # fmt: skip
        axis.plot(_root(turns), np.maximum(folds, 1e-3), **maps.THEORY)
        axis.set_xlabel("turn of the rod: κ a / 2π (drawn at its square root)")
        axis.set_xticks(_root(ticks), [f"{turn:g}" for turn in ticks])
    left.set_ylabel("load number ρ g h a³/D (lowest row: none)")
    left.set_title(f"Lattice {GRID[0]}×{GRID[1]}×2: error [%]; s: snapped on the way")
    right.set_title(f"Shell {ELEMENTS}×{ELEMENTS}: factorisations")
    maps.legend(figure, [*rows, *shells], maps.theory("weight carries a tape spring's fold"))


STUDY = Study(
    name="curved-edge",
    title="A clamp bent up to a full circle, with weight for and against it (h/a = 0.008)",
    says="The clamped edge bent to a share of a full circle, both ways, under its weight, at load numbers up "
    "to 30 (100 in the full map). Boundary: L/2 = (1 ± ν)|κ a|, where the weight can carry a tape spring's "
    "fold.",
    cells=cells,
    measure="studies.stability.curved_edge:measure",
    columns=columns(turn="g", load_number="g"),
    draw=draw,
    size=(7.2, 3.6),
    graded=True,
)
