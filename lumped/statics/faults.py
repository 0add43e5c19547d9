"""States that mean nothing, with the place on the sheet: numbers overflowed, collapsed links, inverted cells.

collapsed  a link shorter than 1e-6 of its rest length: its direction means nothing.
inverted   the normal of a mid-surface cell no longer points the way from the bottom layer to the top.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from lumped.assembly import Assembly
from lumped.lattice import Lattice
from lumped.springs.families import Links
from lumped.statics.limits import COLLAPSED
from lumped.statics.soundness import long_enough, surface, upright
from sheetbench.scenes import Status


class Fault(NamedTuple):
    """What makes a state worthless: the status it deserves and a sentence."""

    status: Status
    message: str


def broken(assembly: Assembly, u: np.ndarray) -> Fault | None:
    """The first of: a number that is not finite, a collapsed link, an inverted cell; u: (n, 3) [m]."""
    if _sound(assembly, u):
        return None
    lattice = assembly.lattice
    masses = u[: lattice.mass_count]
    finite = np.isfinite(masses).all(axis=1)
    if not finite.all():
        where = place(lattice, int(np.argmin(finite)))
        return Fault(Status.NON_FINITE, f"the mass at {where} has left the range of numbers")
    for links in assembly.springs:
        if isinstance(links, Links) and len(links):
            a, b = links.nodes.T
            share = np.linalg.norm(links.offset + u[b] - u[a], axis=1) / links.rest_length
            if share.min() < COLLAPSED:
                where = place(lattice, int(a[np.argmin(share)]))
                return Fault(Status.INVERTED, f"the link at {where} has no length left: refine the grid")
    facing = _facing(lattice, masses)
    if facing.min() <= 0.0:
        j, i = np.unravel_index(np.argmin(facing), facing.shape)
        where = place(lattice, int(lattice.columns()[j, i, 0]))
        return Fault(Status.INVERTED, f"the cell at {where} has turned inside out: refine the grid")
    return None


def _sound(assembly: Assembly, u: np.ndarray) -> bool:
    """Whether nothing is wrong, by compiled loops: a run looks at every sample."""
    if not upright(*assembly.plan, u):
        return False
    return all(long_enough(u, *links, COLLAPSED) for links in assembly.link_geometry)


def place(lattice: Lattice, mass: int) -> str:
    """Where a mass lies on the flat sheet, in words."""
    x, y, _ = lattice.positions[mass]
    return f"x = {x:.4g} m, y = {y:.4g} m"


def fastest(lattice: Lattice, v: np.ndarray) -> str:
    """Where the fastest mass lies, v: (n, 3) [m/s]; the first whose speed is no number, if there is one."""
    speed = np.abs(v[: lattice.mass_count]).max(axis=1)
    return place(lattice, int(np.argmax(np.where(np.isfinite(speed), speed, np.inf))))


def cell_corners(field: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Values of a field (ny, nx, …) at the four corners, in turn, of every cell."""
    return field[:-1, :-1], field[:-1, 1:], field[1:, 1:], field[1:, :-1]


def _facing(lattice: Lattice, u: np.ndarray) -> np.ndarray:
    """Normal times mean director of every cell, over their area when flat, (ny − 1, nx − 1)."""
    middle, director = surface(lattice.columns(), lattice.positions, u)
    a, b, c, d = cell_corners(middle)
    normal = 0.5 * np.cross(c - a, d - b)
    mean = sum(cell_corners(director)) / 4.0
    across = np.einsum("jiq,jiq->ji", normal, mean)
    there = lattice.cell_areas > 0.0
    return np.divide(across, lattice.cell_areas, out=np.ones_like(across), where=there)
