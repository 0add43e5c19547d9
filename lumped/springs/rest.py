"""What springs have whatever their stiffness: masses, rest geometry and blocks of the tangent.

A small lattice's are found once and kept: lattices on one grid differ in stiffness alone more often than not.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property, lru_cache
from typing import Any, NamedTuple

import numpy as np

from lumped.lattice import Lattice
from lumped.pattern import ASKED, KEPT, Pattern


class LinkRest(NamedTuple):
    """nodes (m, 2) masses; slots (m, 4) blocks; offset (m, 3), rest_length (m,) [m]; kind: (m,) numbers into
    the lattice's names of links."""

    nodes: np.ndarray
    slots: np.ndarray
    offset: np.ndarray
    rest_length: np.ndarray
    kind: np.ndarray


class CellRest(NamedTuple):
    """nodes (c, 4, p) masses; slots (c, 4p, 4p) blocks; diagonals (c, 2, 3) [m]; rest_area (c,) [m²]; on:
    which of the lattice's cells of that name they are, (all of them,)."""

    nodes: np.ndarray
    slots: np.ndarray
    diagonals: np.ndarray
    rest_area: np.ndarray
    on: np.ndarray


class Rest:
    """The springs of a lattice at rest. No array of it is to be written to."""

    def __init__(self, lattice: Lattice, pattern: Pattern):
        self._lattice, self._pattern = lattice, pattern
        self._found: dict[tuple[str, bytes], Any] = {}

    @cached_property
    def weight(self) -> np.ndarray:
        """Share of its family's stiffness that each link carries where all cells are alike, (m,)."""
        return np.concatenate([family.weight for family in self._lattice.links])

    @cached_property
    def counts(self) -> np.ndarray:
        """How many links each family has."""
        return np.array([len(family.nodes) for family in self._lattice.links])

    def links(self, which: np.ndarray) -> LinkRest:
        """Those of all the lattice's links that `which` (m,) tells."""
        return self._kept("", which, self._links)

    def cells(self, name: str, which: np.ndarray) -> CellRest:
        """Those of the lattice's cells of this name that `which` (c,) tells."""
        return self._kept(name, which, lambda chosen: self._cells(name, chosen))

    def _kept(self, name: str, which: np.ndarray, make: Callable[[np.ndarray], Any]) -> Any:
        key = name, which.tobytes()
        found = self._found.get(key)
        if found is None:
            if len(self._found) == ASKED:
                self._found.clear()
            found = self._found[key] = make(which)
        return found

    def _links(self, which: np.ndarray) -> LinkRest:
        joined = self._lattice.joined
        nodes, offset, rest, kind = joined if which.all() else (part[which] for part in joined)
        return LinkRest(nodes, self._pattern.among(nodes).reshape(-1, 4), offset, rest, kind)

    def _cells(self, name: str, which: np.ndarray) -> CellRest:
        (cells,) = (family for family in self._lattice.cells if family.name == name)
        nodes, diagonals = cells.nodes, self._lattice.diagonals[name]
        if not which.all():
            nodes, diagonals = nodes[which], diagonals[which]
        slots = self._pattern.among(nodes.reshape(len(nodes), -1))
        (x, y, z), (p, q, r) = diagonals[:, 0].T, diagonals[:, 1].T
        area = 0.5 * np.sqrt((y * r - z * q) ** 2 + (z * p - x * r) ** 2 + (x * q - y * p) ** 2)
        return CellRest(nodes, slots, diagonals, area, which.copy())


class Itself:
    """A lattice as a key: the same one, not one like it."""

    def __init__(self, lattice: Lattice):
        self.lattice = lattice

    def __hash__(self) -> int:
        return id(self.lattice)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Itself) and self.lattice is other.lattice


def rest_of(lattice: Lattice, pattern: Pattern) -> Rest:
    """The springs of a lattice at rest, their blocks of this pattern; of a small one the same every time."""
    if lattice.mass_count > KEPT:
        return Rest(lattice, pattern)
    return _kept_rest(Itself(lattice), pattern)


@lru_cache(maxsize=16)
def _kept_rest(itself: Itself, pattern: Pattern) -> Rest:
    return Rest(itself.lattice, pattern)
