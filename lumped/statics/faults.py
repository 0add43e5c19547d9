"""Invalid states, with the place on the sheet: numbers overflowed, collapsed links, inverted cells.

collapsed  a link shorter than 1e-6 of its rest length: its direction is undefined.
inverted   the normal of a mid-surface cell points from the top layer to the bottom.
"""

import numpy as np

from lumped.assembly import Assembly
from lumped.lattice import Lattice
from lumped.statics.soundness import examine
from sheetbench.answers.solution import Status
from sheetbench.numerics.continuation.path import Fault

COLLAPSED = 1e-6  # of a link's rest length
FAULTS = (  # by the number that `soundness.examine` returns
    (Status.NON_FINITE, "the displacement of the mass at {} has overflowed"),
    (Status.INVERTED, "the link at {} has collapsed to a point: refine the grid"),
    (Status.INVERTED, "the cell at {} has turned inside out: refine the grid"),
)


def inspect(assembly: Assembly, states: np.ndarray) -> tuple[np.ndarray, Fault | None]:
    """Return the largest strain of a link in a layer at each of the displacements (k, n, 3) [m] before the
    first invalid one, and its fault: a number that is not finite, a collapsed link or an inverted cell."""
    lattice, fault, of_families = assembly.lattice, None, []
    for links in assembly.all_families.all_links:
        strains, kind, mass = examine(states, links.arrays, COLLAPSED, *lattice.plan)
        of_families.append(strains)
        if kind >= 0:
            states, (status, message) = states[: len(strains)], FAULTS[kind]
            fault = Fault(status, message.format(place(lattice, mass)))
    return of_families[0][: len(states)], fault


def place(lattice: Lattice, mass: int) -> str:
    """Return a mass's place on the flat sheet in words."""
    x, y, _ = lattice.positions[mass]
    return f"x = {x:.4g} m, y = {y:.4g} m"


def fastest(lattice: Lattice, v: np.ndarray) -> str:
    """Return the place of the fastest mass in words, of the first whose speed is not a number, if any; v: (n,
    3) [m/s]."""
    speed = np.abs(v[: lattice.mass_count]).max(axis=1)
    return place(lattice, int(np.argmax(np.where(np.isfinite(speed), speed, np.inf))))
