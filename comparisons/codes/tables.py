"""A lattice as CSV: one table a file, SI units, all digits, the names of the columns in the first line.

Masses that a corner, or what is held, is the mean of are joined by "+".
"""

from __future__ import annotations

import csv
import io
from collections.abc import Iterable, Iterator, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from sheetbench.scenes import Scene
from sheetbench.scenes.meaning.composition import composition_at, shares_of

if TYPE_CHECKING:
    from lumped import Description

AXES = "xyz"
Row = Sequence[Any]


def tables(lattice: Description) -> dict[str, str]:
    """Return the text of every file by its name."""
    numbers, corners = np.arange(len(lattice.mass)), ",".join(f"corner_{n}" for n in range(1, 5))
    formulas = dict.fromkeys(f"{table.kind}: E = {table.energy}" for table in lattice.cells)
    width = max(3, *(table.stiffness.shape[1] for table in lattice.cells), 0)
    cells = [
        "kind", corners, "rest_area", *(f"stiffness_{n}" for n in range(1, width + 1)),
        *(f"damping_{n}" for n in range(1, 4)),
    ]  # fmt: skip
    loaded = np.flatnonzero(lattice.dead.any(axis=1))
    return {
        "nodes.csv": _csv(
            "number,i,j,k,x,y,z,mass", _rows(numbers, lattice.index, lattice.positions, lattice.mass)
        ),
        "links.csv": _csv("a,b,family,rest_length,stiffness,damping", _rows(*vars(lattice.links).values())),
        "cells.csv": _csv(",".join(cells), _cells(lattice, width), "; ".join((*formulas, "force -dE/dx"))),
        "supports.csv": _csv(
            "edge,masses,component,displacement",
            (
                [h.edge.replace(" ", "_"), _joined(h.masses), AXES[h.axis], h.displacement]
                for h in lattice.holds
            ),
        ),
        "loads.csv": _csv("number,fx,fy,fz", _rows(loaded, lattice.dead[loaded])),
        "followers.csv": _csv(f"kind,{corners},value", _followers(lattice)),
        "check.csv": _csv(
            "state,number,ux,uy,uz,fx,fy,fz",
            (
                row
                for state in lattice.states
                for row in _rows([state.name] * len(numbers), numbers, state.displacement, state.force)
            ),
        ),
        "states.csv": _csv("state,energy,meaning", ([s.name, s.energy, s.meaning] for s in lattice.states)),
        **(contacts(lattice) if len(lattice.contact["obstacle_kind"]) else {}),
    }


def plan(lattice: Description, scene: Scene) -> str:
    """Return the table of the plan's cells: place of the first corner on the grid, middle [m], the share that
    is on the sheet, and what the sheet is made of there."""
    x, y = (np.unique(lattice.positions[:, axis]) for axis in (0, 1))
    share = shares_of(scene.region, x, y)
    rows, columns = np.nonzero(share)
    middle = np.column_stack([0.5 * (x[1:] + x[:-1])[columns], 0.5 * (y[1:] + y[:-1])[rows]])
    found = composition_at(scene, middle)
    values = _rows(columns, rows, middle, share[rows, columns], *found.values())
    return _csv(",".join(["i,j,x,y,share", *found]), values)


def _followers(lattice: Description) -> Iterator[Row]:
    """Loads that follow the sheet: pressed cells, and the couples of edges by their four groups of masses."""
    for corners, pressure in zip(lattice.pressed.tolist(), lattice.pressure.tolist(), strict=True):
        yield ["pressure", *map(_joined, corners), pressure]
    for couple in lattice.couples:
        around = map(_joined, (couple.before, couple.after))
        yield ["moment", couple.top, couple.bottom, *around, couple.moment]


def _cells(lattice: Description, width: int) -> Iterator[Row]:
    """Kind, corners, area at rest, stiffness and damping of every cell with springs, and its energy."""
    for table in lattice.cells:
        corners = np.array([[*map(_joined, masses)] for masses in table.corners.tolist()])
        stiffness, damping = _wide(table.stiffness, width), _wide(table.damping[:, :3], 3)
        kind, energy = ([text] * len(corners) for text in (table.kind, table.energy))
        yield from _rows(kind, corners, table.rest_area, stiffness, damping, energy)


def natural(lattice: Description) -> str:
    """Return the table of A·A, B·B and A·B without stress [m²] of rows of cells.csv, from 0, with sides."""
    places = np.cumsum([0, *(len(table.corners) for table in lattice.cells)])
    rows = (
        row
        for first, table in zip(places, lattice.cells, strict=False)
        if table.kind in ("strain", "coupling")
        for row in _rows(first + np.arange(len(table.corners)), table.natural)
    )
    return _csv("cell,aa,bb,ab", rows)


def contacts(lattice: Description) -> dict[str, str]:
    """Return the tables of obstacles, with the largest stiffness of their points, and of the points."""
    of, corners = lattice.contact, [f"corner_{n}" for n in range(1, 5)]
    most = np.zeros(len(of["obstacle_kind"]))
    np.maximum.at(most, of["contact_obstacle"], of["contact_stiffness"])
    kinds = np.array(["plane", "sphere", "cylinder"])[of["obstacle_kind"]]
    place = (of[f"obstacle_{name}"] for name in ("position", "direction", "radius"))
    joined = np.array([[*map(_joined, masses)] for masses in of["contact_corners"].tolist()])
    numbers = (of[f"contact_{name}"] for name in ("weights", "area", "offset", "stiffness"))
    head = ["obstacle", *corners, *(f"weight_{n}" for n in range(1, 5)), "area", "offset", "stiffness"]
    return {
        "obstacles.csv": _csv("kind,x,y,z,ax,ay,az,radius,stiffness", _rows(kinds, *place, most)),
        "contacts.csv": _csv(",".join(head), _rows(of["contact_obstacle"], joined, *numbers)),
    }


def _wide(values: np.ndarray, width: int) -> np.ndarray:
    """Return rows with zeros behind them, of so many columns."""
    return np.pad(values, ((0, 0), (0, width - values.shape[1])))


def _rows(*parts: Sequence[Any] | np.ndarray) -> Iterator[Row]:
    """Return the rows of columns (n,) and of several at once (n, k), side by side, as plain numbers."""
    return zip(
        *(column for part in parts for column in np.atleast_2d(np.transpose(part)).tolist()), strict=True
    )


def _joined(masses: Sequence[int]) -> str:
    return "+".join(map(str, masses))


def _csv(header: str, rows: Iterable[Row], last: str = "") -> str:
    """Return a file's text; header: names with commas; last: of one more column, whatever it has in it."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerows([[*header.split(","), *([last] if last else [])], *rows])
    return text.getvalue()
