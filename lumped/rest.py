"""What springs have whatever their stiffness: masses, rest geometry and blocks of the tangent.

A small lattice's are found once and kept: lattices on one grid differ in stiffness alone more often than not.
"""

from __future__ import annotations

from typing import Literal

import numpy as np

from lumped.lattice import Lattice
from lumped.pattern import PATTERN_CACHE, SHARED_UP_TO, MassPattern
from sheetbench.numerics.kept import kept

CellKind = Literal["layer_cells", "mid_cells", "faces"]


class Rest:
    """The springs of a lattice at rest. No array of it is to be written to."""

    def __init__(self, lattice: Lattice, pattern: MassPattern):
        self._lattice, self._pattern = lattice, pattern
        self._found: dict[object, tuple[np.ndarray, ...]] = {}

    def links(self, which: np.ndarray) -> tuple[np.ndarray, ...]:
        """Return nodes (m, 2), blocks (m, 4), offsets (m, 3) and rest lengths (m,) [m] of those of all the
        lattice's links that `which` (m,) tells, and their numbers (m,)
        into the lattice's names of links."""
        key = which.tobytes()
        found = self._found.get(key)
        if found is None:
            if len(self._found) == PATTERN_CACHE:
                self._found.clear()
            joined = self._lattice.joined
            nodes, offset, rest, kind = joined if which.all() else (part[which] for part in joined)
            found = self._found[key] = (nodes, self._pattern.among(nodes).reshape(-1, 4), offset, rest, kind)
        return found

    def cells(self, kind: CellKind) -> tuple[np.ndarray, ...]:
        """Return nodes (c, 4, p), blocks (c, 4p, 4p), sides (c, 2, 3) [m], the means of opposite ones, and
        areas (c,) [m²] of the lattice's cells of this kind, or of its upright faces."""
        found = self._found.get(kind)
        if found is None:
            nodes = self._lattice.faces.nodes if kind == "faces" else getattr(self._lattice, kind)
            corners = self._lattice.positions[nodes].mean(axis=2)
            across, along = corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1]
            sides = 0.5 * np.stack([across - along, across + along], axis=1)
            area = np.sqrt((np.cross(sides[:, 0], sides[:, 1]) ** 2).sum(axis=1))
            slots = self._pattern.among(nodes.reshape(len(nodes), -1))
            found = self._found[kind] = (nodes, slots, sides, area)
        return found


@kept(last=16, most=SHARED_UP_TO, size=lambda lattice, pattern: lattice.mass_count)
def rest_of(lattice: Lattice, pattern: MassPattern) -> Rest:
    """The springs of a lattice at rest, their blocks of this pattern; of a small one the same every time."""
    return Rest(lattice, pattern)
