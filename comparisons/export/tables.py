"""A lattice as CSV: one table a file, SI units, all digits, the names of the columns in the first line.

Masses that a corner, or what is held, is the mean of are joined by "+".
"""

from __future__ import annotations

import csv
import io
from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from sheetbench.scenes import Scene
from sheetbench.scenes.patches import composition_at, shares_of

if TYPE_CHECKING:
    from lumped import Description


AXES = "xyz"


def tables(lattice: Description) -> dict[str, str]:
    """Return the text of every file by its name."""
    x, y, z = (f"u{axis}" for axis in AXES)
    formulas = dict.fromkeys(f"{table.kind}: E = {table.energy}" for table in lattice.cells)
    width = max(3, *(table.stiffness.shape[1] for table in lattice.cells), 0)
    return {
        "nodes.csv": _csv(
            ["number", "i", "j", "k", "x", "y", "z", "mass"],
            (
                [number, *index, *position, mass]
                for number, (index, position, mass) in enumerate(
                    zip(
                        lattice.index.tolist(), lattice.positions.tolist(), lattice.mass.tolist(), strict=True
                    )
                )
            ),
        ),
        "links.csv": _csv(
            ["a", "b", "family", "rest_length", "stiffness", "damping"],
            (
                [*pair, *rest]
                for pair, *rest in zip(
                    *(values.tolist() for values in vars(lattice.links).values()), strict=True
                )
            ),
        ),
        "cells.csv": _csv(
            [
                "kind",
                *(f"corner_{n}" for n in range(1, 5)),
                "rest_area",
                *(f"stiffness_{n}" for n in range(1, width + 1)),
                *(f"damping_{n}" for n in range(1, 4)),
                "; ".join((*formulas, "force -dE/dx")),
            ],
            (
                [table.kind, *map(_joined, corners), area, *stiffness, *damping, table.energy]
                for table in lattice.cells
                for corners, area, stiffness, damping in zip(
                    table.corners.tolist(),
                    table.rest_area.tolist(),
                    _wide(table.stiffness, width),
                    _wide(table.damping[:, :3], 3),
                    strict=True,
                )
            ),
        ),
        "supports.csv": _csv(
            ["edge", "masses", "component", "displacement"],
            (
                [h.edge.replace(" ", "_"), _joined(h.masses), AXES[h.axis], h.displacement]
                for h in lattice.holds
            ),
        ),
        "loads.csv": _csv(
            ["number", "fx", "fy", "fz"],
            ([n, *force] for n, force in enumerate(lattice.dead.tolist()) if any(force)),
        ),
        "followers.csv": _csv(["kind", *(f"corner_{n}" for n in range(1, 5)), "value"], _followers(lattice)),
        "check.csv": _csv(
            ["state", "number", x, y, z, "fx", "fy", "fz"],
            (
                [state.name, number, *displacement, *force]
                for state in lattice.states
                for number, (displacement, force) in enumerate(
                    zip(state.displacement.tolist(), state.force.tolist(), strict=True)
                )
            ),
        ),
        "states.csv": _csv(
            ["state", "energy", "meaning"], ([s.name, s.energy, s.meaning] for s in lattice.states)
        ),
    }


def plan(lattice: Description, scene: Scene) -> str:
    """Return the table of the plan's cells: place of the first corner on the grid, middle [m], the share that
    is on the sheet, and what the sheet is made of there."""
    x, y = (np.unique(lattice.positions[:, axis]) for axis in (0, 1))
    share = shares_of(scene.region, x, y)
    rows, columns = np.nonzero(share)
    middle = np.column_stack([0.5 * (x[1:] + x[:-1])[columns], 0.5 * (y[1:] + y[:-1])[rows]])
    found = composition_at(scene, middle)
    values = [columns, rows, *middle.T, share[rows, columns], *found.values()]
    return _csv(["i", "j", "x", "y", "share", *found], zip(*(each.tolist() for each in values), strict=True))


def _followers(lattice: Description) -> Iterable[list[Any]]:
    """Loads that follow the sheet: pressed cells, and the couples of edges by their four groups of masses."""
    for corners, pressure in zip(lattice.pressed.tolist(), lattice.pressure.tolist(), strict=True):
        yield ["pressure", *map(_joined, corners), pressure]
    for couple in lattice.couples:
        yield [
            "moment",
            couple.top,
            couple.bottom,
            _joined(couple.before),
            _joined(couple.after),
            couple.moment,
        ]


def _wide(values: np.ndarray, width: int) -> list[list[float]]:
    """Rows with zeros behind them, of so many columns."""
    rows: list[list[float]] = np.pad(values, ((0, 0), (0, width - values.shape[1]))).tolist()
    return rows


def _joined(masses: Sequence[int]) -> str:
    return "+".join(map(str, masses))


def _csv(header: Sequence[str], rows: Iterable[Sequence[Any]]) -> str:
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(header)
    writer.writerows(rows)
    return text.getvalue()
