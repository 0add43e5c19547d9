"""States that mean nothing, with the place on the sheet: numbers overflowed, collapsed links, inverted cells.

collapsed  a link shorter than 1e-6 of its rest length: its direction means nothing.
inverted   the normal of a mid-surface cell no longer points the way from the bottom layer to the top.
"""

from __future__ import annotations

import numpy as np

from lumped.assembly import Assembly
from lumped.lattice import Lattice
from lumped.statics.soundness import examine
from sheetbench.answers.solution import Status
from sheetbench.numerics.continuation.path import Fault

COLLAPSED = 1e-6  # of a link's rest length
FAULTS = (  # as `soundness.examine` numbers them
    (Status.NON_FINITE, "the mass at {} has left the range of numbers"),
    (Status.INVERTED, "the link at {} has no length left: refine the grid"),
    (Status.INVERTED, "the cell at {} has turned inside out: refine the grid"),
)


def inspect(assembly: Assembly, states: np.ndarray) -> tuple[np.ndarray, Fault | None]:
    """Return the largest strain of a link in a layer at each of the displacements (k, n, 3) [m] before the
    first that means nothing, and why that one does not: a number that is not finite, or a collapsed link, or
    an inverted cell."""
    lattice, fault, of_families = assembly.lattice, None, []
    for links in assembly.all_families.all_links:
        found, kind, mass = examine(states, links.arrays, COLLAPSED, *lattice.plan)
        of_families.append(found)
        if kind >= 0:
            states, (status, message) = states[: len(found)], FAULTS[kind]
            fault = Fault(status, message.format(place(lattice, mass)))
    return of_families[0][: len(states)], fault


def place(lattice: Lattice, mass: int) -> str:
    """Where a mass lies on the flat sheet, in words."""
    x, y, _ = lattice.positions[mass]
    return f"x = {x:.4g} m, y = {y:.4g} m"


def fastest(lattice: Lattice, v: np.ndarray) -> str:
    """Where the fastest mass lies, v: (n, 3) [m/s]; the first whose speed is no number, if there is one."""
    speed = np.abs(v[: lattice.mass_count]).max(axis=1)
    return place(lattice, int(np.argmax(np.where(np.isfinite(speed), speed, np.inf))))
