"""What springs have whatever their stiffness: masses, rest geometry and blocks of the tangent.

A small lattice's are found once and kept: lattices on one grid differ in stiffness alone more often than not.
"""

from __future__ import annotations

from functools import cached_property
from typing import NamedTuple

import numpy as np

from lumped.lattice import Lattice, mean_sides
from lumped.pattern import PATTERN_CACHE, SHARED_UP_TO, MassPattern
from sheetbench.numerics.kept import kept


class LinkRest(NamedTuple):
    """nodes (m, 2) masses; slots (m, 4) blocks; offset (m, 3), rest_length (m,) [m]; kind: (m,) numbers into
    the lattice's names of links."""

    nodes: np.ndarray
    slots: np.ndarray
    offset: np.ndarray
    rest_length: np.ndarray
    kind: np.ndarray


class CellRest(NamedTuple):
    """nodes (c, 4, p) masses; slots (c, 4p, 4p) blocks; sides (c, 2, 3) [m], the means of opposite ones; area
    (c,) [m²]."""

    nodes: np.ndarray
    slots: np.ndarray
    sides: np.ndarray
    area: np.ndarray


class Faces(NamedTuple):
    """nodes (m, 4, 1) masses; cells, shares (m, q): the plan cells beside each and their shares; axis: (m,) 0
    along x, 1 along y, 2 over diagonals along x and y, 3 over the others."""

    nodes: np.ndarray
    cells: np.ndarray
    shares: np.ndarray
    axis: np.ndarray


class Rest:
    """The springs of a lattice at rest. No array of it is to be written to."""

    def __init__(self, lattice: Lattice, pattern: MassPattern):
        self._lattice, self._pattern = lattice, pattern
        self._found: dict[bytes, LinkRest] = {}
        self._cells: dict[str, CellRest] = {}

    def links(self, which: np.ndarray) -> LinkRest:
        """Return those of all the lattice's links that `which` (m,) tells."""
        key = which.tobytes()
        found = self._found.get(key)
        if found is None:
            if len(self._found) == PATTERN_CACHE:
                self._found.clear()
            joined = self._lattice.joined
            nodes, offset, rest, kind = joined if which.all() else (part[which] for part in joined)
            slots = self._pattern.among(nodes).reshape(-1, 4)
            found = self._found[key] = LinkRest(nodes, slots, offset, rest, kind)
        return found

    def cells(self, name: str) -> CellRest:
        """Return the lattice's cells of this name, or its upright "faces"."""
        if name not in self._cells:
            nodes = self.faces.nodes if name == "faces" else None
            if nodes is None:
                (nodes,) = (family.nodes for family in self._lattice.cells if family.name == name)
            slots = self._pattern.among(nodes.reshape(len(nodes), -1))
            sides = mean_sides(self._lattice.positions, nodes)
            area = np.sqrt((np.cross(sides[:, 0], sides[:, 1]) ** 2).sum(axis=1))
            self._cells[name] = CellRest(nodes, slots, sides, area)
        return self._cells[name]

    @cached_property
    def faces(self) -> Faces:
        """The faces between layers above links along x, along y, and over the cells' diagonals."""
        layers, parts = self._lattice.grid[2], []
        for axis, family in enumerate(f for f in self._lattice.links if f.name in ("axial", "diagonal")):
            low = family.nodes[:, 0] % layers < layers - 1
            a, b = family.nodes[low].T
            nodes = np.stack([a, b, b + 1, a + 1], axis=1)[:, :, None]
            cells, shares = family.cells[low], family.shares[low]
            if axis > 1:  # of one cell each
                cells, shares = np.repeat(cells, 2, axis=1), 0.5 * np.repeat(shares, 2, axis=1)
            parts.append((nodes, cells, shares, np.full(len(a), axis)))
        return Faces(*(np.concatenate(part) for part in zip(*parts, strict=True)))


@kept(last=16, most=SHARED_UP_TO, size=lambda lattice, pattern: lattice.mass_count)
def rest_of(lattice: Lattice, pattern: MassPattern) -> Rest:
    """The springs of a lattice at rest, their blocks of this pattern; of a small one the same every time."""
    return Rest(lattice, pattern)
