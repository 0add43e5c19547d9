"""A lattice as CSV and as named arrays, SI units, all digits, numbers from 0.

A CSV file holds one table, the names of the columns in the first line; masses whose mean is a corner, or is
held, are joined by "+". The arrays are in `lattice.npz` and `lattice.mat`: a corner of a cell is the mean of
as many masses as the lattice has layers; where it is one mass alone, that stands there as often. So do the
masses of a hold.
"""

from __future__ import annotations

import csv
import io
from collections.abc import Iterable, Iterator, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from sheetbench.scenes import Scene

if TYPE_CHECKING:
    from lumped import Description


NAMES = {  # and what they are
    "positions": "(n, 3) rest positions of the masses [m]",
    "index": "(n, 3) of each mass along x, along y, through the thickness",
    "mass": "(n,) [kg]",
    "damping_rate": "damping of each mass over its mass [1/s]",
    "critical_damping_rate": "damping_rate at which the lowest mode is critically damped [1/s]",
    "symplectic_euler_step": "largest step [s]",
    "velocity_verlet_step": "largest step [s]",
    "link_masses": "(m, 2) masses at the ends",
    "link_family": "(m,) names",
    "link_rest_length": "(m,) [m]",
    "link_stiffness": "(m,) [N/m]",
    "link_damping": "(m,) [N s/m]",
    "area_corners": "(a, 4, p) masses of each corner (their mean), corners in turn",
    "area_rest": "(a,) rest area [m2]",
    "area_stiffness": "(a,) [N/m]",
    "area_damping": "(a,) [N s/m]",
    "strain_corners": "(s, 4, p) as area_corners",
    "strain_rest": "(s,) rest area [m2]",
    "strain_natural": "(s, 3) A.A, B.B, A.B of mean sides A, B without stress [m2]",
    "strain_stiffness": "(s, 3) of e1, e2, g [N/m]",
    "strain_damping": "(s, 3) [N s/m]",
    "coupling_corners": "(f, 4, p) as area_corners",
    "coupling_rest": "(f,) rest area [m2]",
    "coupling_natural": "(f, 3) A.A, B.B, A.B of mean sides without stress [m2]",
    "coupling_stiffness": "(f, 3) of e1 e2, e1 g, e2 g [N/m]",
    "coupling_damping": "(f, 3) [N s/m]",
    "rubber_corners": "(r, 4, p) as area_corners",
    "rubber_rest": "(r,) rest area [m2]",
    "rubber_stiffness": "(r, 8) c10, c01, c20, c30, volume [N/m], limit [-], two of the sides [N/m]",
    "face_corners": "(f, 4, p) as area_corners",
    "face_rest": "(f,) rest area [m2]",
    "face_stiffness": "(f,) [N/m]",
    "hold_masses": "(h, p) masses whose mean displacement is held",
    "hold_axis": "(h,) along 0 = x, 1 = y, 2 = z",
    "hold_displacement": "(h,) [m]",
    "load": "(n, 3) dead forces [N]",
    "pressure": "(c,) [Pa] on each cell under pressure",
    "pressed_corners": "(c, 4, p) as area_corners",
    "couple_masses": "(e, 2) top and bottom of an edge's column",
    "couple_before": "(e, p) masses of the column before it",
    "couple_after": "(e, p) masses of the column after it",
    "couple_moment": "(e,) [N m]",
    "contact_masses": "(t, q) masses around a point that may touch an obstacle",
    "contact_weights": "(t, q) their weights in the point's position",
    "contact_values": "(t, 10) columns of contacts.csv from x on",
    "state_name": "(q,) names",
    "state_displacement": "(q, n, 3) [m]",
    "state_force": "(q, n, 3) gradient of the energy of springs and contact [N]",
    "state_energy": "(q,) energy of springs and contact [J]",
}


def arrays(lattice: Description) -> dict[str, np.ndarray]:
    """Return the arrays by the names of `NAMES`."""
    layers = 1 + int(lattice.index[:, 2].max())
    values: dict[str, np.ndarray] = {
        "positions": lattice.positions,
        "index": lattice.index,
        "mass": lattice.mass,
        "damping_rate": np.array(lattice.damping_rate),
        "critical_damping_rate": np.array(lattice.steps.critical_rate),
        **{f"{name}_step": np.array(step) for name, step in lattice.steps.advised.items()},
        **{f"link_{name}": column for name, column in vars(lattice.links).items()},
        "hold_masses": _repeat_masses([hold.masses for hold in lattice.holds], layers),
        "hold_axis": np.array([hold.axis for hold in lattice.holds], dtype=int),
        "hold_displacement": np.array([hold.displacement for hold in lattice.holds]),
        "load": lattice.dead,
        "pressure": lattice.pressure,
        "pressed_corners": lattice.pressed,
        "couple_masses": np.array([(c.top, c.bottom) for c in lattice.couples], dtype=int).reshape(-1, 2),
        "couple_before": _repeat_masses([couple.before for couple in lattice.couples], layers),
        "couple_after": _repeat_masses([couple.after for couple in lattice.couples], layers),
        "couple_moment": np.array([couple.moment for couple in lattice.couples]),
        **dict(zip(("contact_masses", "contact_weights", "contact_values"), lattice.contact, strict=True)),
        **{
            f"state_{name}": np.array([getattr(state, name) for state in lattice.states])
            for name in ("name", "displacement", "force", "energy")
        },
    }
    for kind, components in (("area", 1), ("strain", 3), ("coupling", 3), ("rubber", 8), ("face", 1)):
        cells = [table for table in lattice.cells if table.kind == kind]
        corners = [np.repeat(t.corners, layers // t.corners.shape[2], axis=2) for t in cells]
        values[f"{kind}_corners"] = np.concatenate([np.empty((0, 4, layers), dtype=int), *corners])
        values[f"{kind}_rest"] = np.concatenate([np.empty(0), *(table.rest_area for table in cells)])
        values[f"{kind}_natural"] = np.concatenate([np.empty((0, 3)), *(table.natural for table in cells)])
        for name in ("stiffness", "damping"):
            column = np.concatenate([np.empty((0, components)), *(getattr(table, name) for table in cells)])
            values[f"{kind}_{name}"] = column[:, 0] if components == 1 else column
    return {name: values[name] for name in NAMES}


def _repeat_masses(groups: Sequence[tuple[int, ...]], width: int) -> np.ndarray:
    """Return the masses of each group, repeated to fill a row of `width`, (g, width)."""
    rows = [np.repeat(group, width // len(group)) for group in groups]
    return np.array(rows, dtype=int).reshape(-1, width)


Row = Sequence[Any]


def tables(lattice: Description) -> dict[str, str]:
    """Return the text of every file by its name."""
    numbers, corners = np.arange(len(lattice.mass)), ",".join(f"corner_{n}" for n in range(1, 5))
    width = max(3, *(table.stiffness.shape[1] for table in lattice.cells), 0)
    cells = ["kind", corners, "rest_area", *(f"stiffness_{n}" for n in range(1, width + 1))]
    cells += [f"damping_{n}" for n in range(1, 4)]
    nodes, loaded = [numbers, lattice.index, lattice.positions], np.flatnonzero(lattice.dead.any(axis=1))
    holds = (
        (h.edge.replace(" ", "_"), _join_numbers(h.masses), "xyz"[h.axis], h.displacement)
        for h in lattice.holds
    )
    states = [([s.name] * len(numbers), numbers, s.displacement, s.force) for s in lattice.states]
    files: dict[str, tuple[str, Iterable[Row]]] = {
        "nodes": ("number,i,j,k,x,y,z,mass", _zip(*nodes, lattice.mass)),
        "links": ("a,b,family,rest_length,stiffness,damping", _zip(*vars(lattice.links).values())),
        "cells": (",".join(cells), _list_cells(lattice, width)),
        "supports": ("edge,masses,component,displacement", holds),
        "loads": ("number,fx,fy,fz", _zip(loaded, lattice.dead[loaded])),
        "followers": (f"kind,{corners},value", _list_loads(lattice)),
        "check": ("state,number,ux,uy,uz,fx,fy,fz", (row for state in states for row in _zip(*state))),
        "states": ("state,energy,meaning", ([s.name, s.energy, s.meaning] for s in lattice.states)),
    }
    return {f"{name}.csv": _csv(*of) for name, of in files.items()}


def _list_loads(lattice: Description) -> Iterator[Row]:
    """Yield loads that follow the sheet: pressed cells, and couples of edges by their four groups of
    masses."""
    for corners, pressure in zip(lattice.pressed.tolist(), lattice.pressure.tolist(), strict=True):
        yield ["pressure", *map(_join_numbers, corners), pressure]
    for couple in lattice.couples:
        neighbours = map(_join_numbers, (couple.before, couple.after))
        yield ["moment", couple.top, couple.bottom, *neighbours, couple.moment]


def _list_cells(lattice: Description, width: int) -> Iterator[Row]:
    """Yield kind, corners, area at rest, stiffness and damping of every cell with springs."""
    for table in lattice.cells:
        corners = np.array([[*map(_join_numbers, masses)] for masses in table.corners.tolist()])
        stiffness, damping = _pad_columns(table.stiffness, width), _pad_columns(table.damping[:, :3], 3)
        yield from _zip([table.kind] * len(corners), corners, table.rest_area, stiffness, damping)


def natural(lattice: Description) -> str:
    """Return the CSV table of the stress-free metric A·A, B·B and A·B [m²] of strain and coupling springs, by
    row of cells.csv from 0."""
    places = np.cumsum([0, *(len(table.corners) for table in lattice.cells)])
    rows = (
        row
        for first, table in zip(places, lattice.cells, strict=False)
        if table.kind in ("strain", "coupling")
        for row in _zip(first + np.arange(len(table.corners)), table.natural)
    )
    return _csv("cell,aa,bb,ab", rows)


def contacts(lattice: Description, scene: Scene) -> dict[str, str]:
    """Return the tables of obstacles and of points that may touch them."""
    titles = (f"{name}_{n}" for name in ("mass", "weight") for n in range(1, 1 + lattice.contact[0].shape[1]))
    bodies = np.nan_to_num([[*o.place(), *o.direction, o.radius] for o in scene.obstacles], posinf=0.0)
    axes, kinds = "x,y,z,ax,ay,az,radius", [o.kind for o in scene.obstacles]
    return {
        "obstacles.csv": _csv(f"kind,{axes}", _zip(kinds, bodies)),
        "contacts.csv": _csv(",".join([*titles, axes, "area,offset,stiffness"]), _zip(*lattice.contact)),
    }


def _pad_columns(values: np.ndarray, width: int) -> np.ndarray:
    """Return rows padded with zeros to a number of columns."""
    return np.pad(values, ((0, 0), (0, width - values.shape[1])))


def _zip(*parts: Sequence[Any] | np.ndarray) -> Iterator[Row]:
    """Return the rows of columns (n,) and of several at once (n, k), side by side, as plain numbers."""
    return zip(
        *(column for part in parts for column in np.atleast_2d(np.transpose(part)).tolist()), strict=True
    )


def _join_numbers(masses: Sequence[int]) -> str:
    return "+".join(map(str, masses))


def _csv(header: str, rows: Iterable[Row]) -> str:
    """Return a file's text; header: names with commas."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerows([header.split(","), *rows])
    return text.getvalue()
