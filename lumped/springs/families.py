"""The families of springs, and the table that makes them of a lattice and a spring set: `FAMILIES`.

Only what has stiffness is made. A new family is a module of compiled loops, a class here that says what its
arrays are, and a row of the table.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from lumped.lattice import Lattice
from lumped.pattern import Pattern
from lumped.springs import (
    area_dampers,
    areas,
    by_cell,
    constants,
    directional,
    link_dampers,
    links,
    strain_dampers,
    strains,
)
from lumped.springs.family import Dampers, Family
from lumped.springs.rest import Rest, rest_of
from sheetbench.scenes import SpringSet
from sheetbench.scenes.errors import BadInput
from sheetbench.scenes.springs import DamperSet


@dataclass(frozen=True, eq=False)
class Links(Family):
    """Central links, all together: offset (m, 3) [m] rest vectors, rest_length (m,) [m], kind (m,) numbers
    into the lattice's `names`."""

    offset: np.ndarray
    rest_length: np.ndarray
    kind: np.ndarray
    names: tuple[str, ...]

    springs: ClassVar[Any] = links
    dampers: ClassVar[Any] = link_dampers

    @property
    def geometry(self) -> tuple[np.ndarray, ...]:
        """Rest vectors and their lengths."""
        return self.offset, self.rest_length

    def energies(self, stress: np.ndarray) -> np.ndarray:
        """½ N²/k."""
        return 0.5 * stress**2 / self.stiffness

    def by_name(self, energies: np.ndarray) -> dict[str, float]:
        """By kind of link."""
        sums = np.bincount(self.kind, energies, minlength=len(self.names))
        return dict(zip(self.names, sums.tolist(), strict=True))


@dataclass(frozen=True, eq=False)
class DirectionalLinks(Links):
    """Links of the seed's per-direction law, stiffness (m, 3); neither energy nor stress."""

    springs: ClassVar[Any] = directional
    conservative: ClassVar[bool] = False

    def add_average_force(self, start: np.ndarray, end: np.ndarray, force: np.ndarray) -> None:
        """The force in the middle of the step, for want of an energy."""
        self.add_force(0.5 * (start + end), force)

    def stresses(self, u: np.ndarray) -> np.ndarray:
        """None: the tangent takes none."""
        return np.zeros(len(self))

    def extrapolated(self, u: np.ndarray, step: np.ndarray) -> np.ndarray:
        """None."""
        return np.zeros(len(self))

    def energies(self, stress: np.ndarray) -> np.ndarray:
        """None."""
        return np.zeros(len(self))

    def symmetric(self) -> Links:
        """Central links as stiff as the stiffest direction."""
        return self._central(self.stiffness.max(axis=1))

    def damped(self, time: float) -> Dampers:
        """Dampers along the links, of the mean stiffness."""
        return Dampers(self._central(time * self.stiffness.mean(axis=1)))

    def _central(self, stiffness: np.ndarray) -> Links:
        return Links(self.nodes, stiffness, self.slots, self.offset, self.rest_length, self.kind, self.names)


@dataclass(frozen=True, eq=False)
class Cells(Family):
    """Springs of one kind on cells: nodes (c, 4, p), rest diagonals (c, 2, 3) [m] and areas (c,) [m²], and
    which of the lattice's cells of that kind they are on, (all of them,)."""

    diagonals: np.ndarray
    rest_area: np.ndarray
    name: str
    on: np.ndarray

    @property
    def geometry(self) -> tuple[np.ndarray, ...]:
        """Rest diagonals."""
        return (self.diagonals,)

    def energies(self, stress: np.ndarray) -> np.ndarray:
        """½ τ²/k a0, summed over a cell's strains where it has several."""
        k = self.stiffness
        density = 0.5 * np.divide(stress**2, k, out=np.zeros(k.shape), where=k != 0.0)
        return self.rest_area * (density if density.ndim == 1 else density.sum(axis=1))

    def by_name(self, energies: np.ndarray) -> dict[str, float]:
        """All under the one name."""
        return {self.name: float(energies.sum())}


@dataclass(frozen=True, eq=False)
class AreaSprings(Cells):
    """Area springs, stiffness (c,)."""

    springs: ClassVar[Any] = areas
    dampers: ClassVar[Any] = area_dampers


@dataclass(frozen=True, eq=False)
class StrainSprings(Cells):
    """Strain springs, stiffness (c, 3) of ε1, ε2, γ."""

    springs: ClassVar[Any] = strains
    dampers: ClassVar[Any] = strain_dampers

    def harmless(self, stress: np.ndarray) -> np.ndarray:
        """None: a shear stress of either sign softens some motion."""
        return np.zeros_like(stress)


def link_springs(lattice: Lattice, pattern: Pattern, table: SpringSet | DamperSet) -> Iterator[Links]:
    """Central links, first and even where there are none; then those of a per-direction law."""
    rest, names = rest_of(lattice, pattern), lattice.link_names
    numbers = [constants.number(table, family.name, family.direction) for family in lattice.links]
    if None not in numbers:
        central = rest.weight * np.repeat(np.array(numbers, dtype=float), rest.counts)
        yield _links(Links, rest, central > 0.0, central, names)
        return
    stiffness = []
    for family in lattice.links:
        k = constants.along(table, family.name, family.direction)
        if k.ndim == 2:  # every cell its own
            of_links = np.repeat((family.shares * k[family.cells, 0]).sum(axis=1)[:, None], 3, axis=1)
        else:
            of_links = family.weight[:, None] * k
        stiffness.append(of_links)
    k = np.concatenate(stiffness)
    unequal = (k != k[:, :1]).any(axis=1)
    yield _links(Links, rest, ~unequal & (k[:, 0] > 0.0), k[:, 0], names)
    if unequal.any():
        yield _links(DirectionalLinks, rest, unequal, k, names)


def _links(kind: type[Links], rest: Rest, which: np.ndarray, k: np.ndarray, names: tuple[str, ...]) -> Links:
    nodes, slots, offset, rest_length, number = rest.links(which)
    return kind(nodes, k[which], slots, offset, rest_length, number, names)


def area_springs(lattice: Lattice, pattern: Pattern, springs: SpringSet) -> Iterator[AreaSprings]:
    """On the cells of the layers and of the mid-surface."""
    count = (lattice.grid[0] - 1) * (lattice.grid[1] - 1)
    for cells in lattice.cells:
        stiffness = by_cell.of_cells(getattr(springs, cells.name), count)
        if stiffness.any():
            every = np.full(len(cells.nodes), True)
            stiffness = np.concatenate([stiffness] * (len(every) // count))
            nodes, slots, diagonals, area, on = rest_of(lattice, pattern).cells(cells.name, every)
            yield AreaSprings(nodes, stiffness, slots, diagonals, area, cells.name, on)


def strain_springs(lattice: Lattice, pattern: Pattern, springs: SpringSet) -> Iterator[StrainSprings]:
    """On the cells of the layers and of the mid-surface, with what the edges take off the twist."""
    twist = constants.of_edge_cells(springs, lattice.grid, lattice.twisting)
    for cells in lattice.cells:
        name, stiffness = constants.of_strains(springs, cells.name, len(twist))
        layers = lattice.grid[2]
        if cells.name == "area":
            stiffness[:, 2] += twist
            stiffness = np.concatenate([stiffness] * layers)
        else:
            stiffness[:, 2] -= layers * twist
        stiff = (stiffness != 0.0).any(axis=1)  # edges stiffen the cells along them alone
        if stiff.any():
            nodes, slots, diagonals, area, on = rest_of(lattice, pattern).cells(cells.name, stiff)
            yield StrainSprings(nodes, stiffness[stiff], slots, diagonals, area, name, on)


FAMILIES: tuple[Callable[[Lattice, Pattern, SpringSet], Iterator[Family]], ...] = (
    link_springs,
    area_springs,
    strain_springs,
)


def families(lattice: Lattice, pattern: Pattern, springs: SpringSet) -> tuple[Family, ...]:
    """The springs of a spring set on a lattice, the central links first."""
    return tuple(family for make in FAMILIES for family in make(lattice, pattern, springs))


def table_dampers(lattice: Lattice, pattern: Pattern, table: DamperSet) -> Dampers:
    """The dampers of a scene's [dampers] table, along the links. Raises BadInput for x, y and z apart."""
    along_links, *others = link_springs(lattice, pattern, table)
    if others:
        name = others[0].names[others[0].kind[0]]
        raise BadInput(f"dampers.{name}: a damper acts along its link; give one number, or x and y")
    return Dampers(along_links)
