"""States that mean nothing, with the place on the sheet: numbers overflowed, collapsed links, inverted cells.

collapsed  a link shorter than 1e-6 of its rest length: its direction means nothing.
inverted   the normal of a mid-surface cell no longer points the way from the bottom layer to the top.
"""

from __future__ import annotations

import numpy as np

from lumped.assembly import Assembly
from lumped.lattice import Lattice
from lumped.springs import links
from lumped.statics.soundness import first_inverted
from sheetbench.answers.solution import Status
from sheetbench.numerics.continuation.path import Fault

COLLAPSED = 1e-6  # of a link's rest length


def inspect(assembly: Assembly, states: np.ndarray) -> tuple[np.ndarray, Fault | None]:
    """Return the largest strain of a link in a layer at each of the displacements (k, n, 3) [m] before the
    first that means nothing, and why that one does not: a number that is not finite, or a collapsed link, or
    an inverted cell."""
    lattice, sound, fault = assembly.lattice, len(states), None
    finite = np.isfinite(states[:, : lattice.mass_count])
    if not finite.all():
        sound = int(np.argmin(finite.all(axis=(1, 2))))
        where = place(lattice, int(np.argmin(finite[sound].all(axis=1))))
        fault = Fault(Status.NON_FINITE, f"the mass at {where} has left the range of numbers")
    of_families = []
    for each in assembly.all_families.all_links:
        found, link = links.strains(states[:sound], each.arrays, COLLAPSED)
        of_families.append(found)
        if len(found) < sound:
            sound, where = len(found), place(lattice, int(each.nodes[link, 0]))
            fault = Fault(Status.INVERTED, f"the link at {where} has no length left: refine the grid")
    columns, positions, areas = assembly.plan
    i, row, column = first_inverted(columns, positions, areas, states[:sound])
    if i < sound:
        sound, where = i, place(lattice, int(columns[row, column, 0]))
        fault = Fault(Status.INVERTED, f"the cell at {where} has turned inside out: refine the grid")
    return of_families[0][:sound], fault


def place(lattice: Lattice, mass: int) -> str:
    """Where a mass lies on the flat sheet, in words."""
    x, y, _ = lattice.positions[mass]
    return f"x = {x:.4g} m, y = {y:.4g} m"


def fastest(lattice: Lattice, v: np.ndarray) -> str:
    """Where the fastest mass lies, v: (n, 3) [m/s]; the first whose speed is no number, if there is one."""
    speed = np.abs(v[: lattice.mass_count]).max(axis=1)
    return place(lattice, int(np.argmax(np.where(np.isfinite(speed), speed, np.inf))))
