"""Study `curved edge`: a clamp bent from flat to a full circle, both ways, with gravity for and against it.

A sheet clamped to a rod bent to curvature κ stands out like a tape spring. At the clamp its weight bends it
by ρ g h a²/2 per width; a tape of subtended angle κ a snaps into a fold, which it then carries with the
moment (1 + ν) D κ when it is bent against its curvature, (1 − ν) D κ when along with it (Wüst 1954, Seffen
and Pellegrino 1999). With the load number L = ρ g h a³/D the fold is reached where

    L/2 = (1 ± ν) |κ a|.

κ > 0 lifts the ends of the edge towards +z, weight acts along −z.
"""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from comparisons.models.spec import GradingLike
from comparisons.stability import tiles as maps
from comparisons.stability.rows import Cell, Row, percent
from sheetbench.answers.table import Column
from sheetbench.scenes import Curved
from studies.stability.equilibria import SIDE, compare, sheet
from studies.stability.study import Study

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
    return compare(
        sheet(SLENDERNESS, load_number, supports=supports), GRID, elements=ELEMENTS, grading=grading
    )


def _along(row: Row) -> float:
    """Where a turn is drawn: at its square root, for small ones to have room."""
    turn = float(row["cell"]["turn"])
    return float(np.copysign(np.sqrt(abs(turn)), turn))


def _label(row: Row) -> str:
    """The error, and `s` for each snap on the way."""
    snaps = "s" * len(row["snaps"])
    return "\n".join(filter(None, [percent(row["error"]), snaps]))


def draw(figure: Figure, rows: list[Row]) -> None:
    """Lattice and shell: load number against the rod's turn."""
    left, right = figure.subplots(1, 2, sharey=True)
    levels = sorted({r["cell"]["load_number"] for r in rows})
    least = min([level for level in levels if level > 0.0], default=1.0)
    lowest = 0.3 * least

    def at(row: Row) -> float:
        return max(float(row["cell"]["load_number"]), lowest)

    maps.tiles(left, rows, _along, at, scale=("linear", "log"), text=_label)
    truths = [{**r["reference"], "cell": r["cell"], "error": None} for r in rows if r.get("reference")]
    maps.tiles(
        right,
        truths,
        _along,
        at,
        scale=("linear", "log"),
        text=lambda r: str(r["iterations"]),
    )
    turns = np.linspace(-1.2, 1.2, 400)
    nu = 0.48
    share = np.where(turns > 0.0, 1.0 - nu, 1.0 + nu)
    for axis in (left, right):
        axis.plot(
            np.sign(turns) * np.sqrt(np.abs(turns)),
            np.maximum(2.0 * share * 2.0 * np.pi * np.abs(turns), 1e-3),
            **maps.THEORY,
        )
        axis.set_xlabel("turn of the rod: κ a / 2π (drawn at its square root)")
        ticks = np.array([-1.0, -0.5, -0.25, -0.1, 0.0, 0.1, 0.25, 0.5, 1.0])
        axis.set_xticks(np.sign(ticks) * np.sqrt(np.abs(ticks)), [f"{turn:g}" for turn in ticks])
    left.set_ylabel("load number ρ g h a³/D (lowest row: none)")
    left.set_title(f"Lattice {GRID[0]}×{GRID[1]}×2: error [%]; s: snapped on the way")
    right.set_title(f"Shell {ELEMENTS}×{ELEMENTS}: factorisations")
    line = Line2D([], [], label="weight carries a tape spring's fold", **{**maps.THEORY, "zorder": 1})
    maps.key(figure, [maps.outcome(r) for r in rows] + [r["status"] for r in truths], line)


STUDY = Study(
    name="curved-edge",
    title="A clamp bent up to a full circle, with weight for and against it (h/a = 0.008)",
    says="The clamped edge bent to a share of a full circle, both ways, under its weight, at load numbers up "
    "to 30 (100 in the full map). Boundary: L/2 = (1 ± ν)|κ a|, where the weight can carry a tape spring's "
    "fold.",
    cells=cells,
    measure="studies.stability.curved_edge:measure",
    columns=(Column("turn", form="g"), Column("load number", form="g")),
    draw=draw,
    size=(7.2, 3.6),
    graded=True,
)
