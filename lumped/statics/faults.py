"""States that mean nothing, with the place on the sheet: numbers overflowed, collapsed links, inverted cells.

collapsed  a link shorter than 1e-6 of its rest length: its direction means nothing.
inverted   the normal of a mid-surface cell no longer points the way from the bottom layer to the top.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from lumped.assembly import Assembly
from lumped.lattice import Lattice
from lumped.statics.limits import COLLAPSED
from lumped.statics.soundness import least_facing, shortest
from sheetbench.scenes import Status


class Fault(NamedTuple):
    """What makes a state worthless: the status it deserves and a sentence."""

    status: Status
    message: str


def broken(assembly: Assembly, u: np.ndarray) -> Fault | None:
    """The first of: a number that is not finite, a collapsed link, an inverted cell; u: (n, 3) [m]."""
    lattice = assembly.lattice
    finite = np.isfinite(u[: lattice.mass_count]).all(axis=1)
    if not finite.all():
        where = place(lattice, int(np.argmin(finite)))
        return Fault(Status.NON_FINITE, f"the mass at {where} has left the range of numbers")
    for nodes, offset, rest_length in assembly.link_geometry:
        share, link = shortest(u, nodes, offset, rest_length)
        if share < COLLAPSED:
            where = place(lattice, int(nodes[link, 0]))
            return Fault(Status.INVERTED, f"the link at {where} has no length left: refine the grid")
    columns, positions, areas = assembly.plan
    facing, j, i = least_facing(columns, positions, areas, u)
    if facing <= 0.0:
        where = place(lattice, int(columns[j, i, 0]))
        return Fault(Status.INVERTED, f"the cell at {where} has turned inside out: refine the grid")
    return None


def place(lattice: Lattice, mass: int) -> str:
    """Where a mass lies on the flat sheet, in words."""
    x, y, _ = lattice.positions[mass]
    return f"x = {x:.4g} m, y = {y:.4g} m"


def fastest(lattice: Lattice, v: np.ndarray) -> str:
    """Where the fastest mass lies, v: (n, 3) [m/s]; the first whose speed is no number, if there is one."""
    speed = np.abs(v[: lattice.mass_count]).max(axis=1)
    return place(lattice, int(np.argmax(np.where(np.isfinite(speed), speed, np.inf))))
