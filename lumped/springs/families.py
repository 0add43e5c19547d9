"""The families of springs, and the table that makes them of a lattice and a spring set: `FAMILIES`.

Only what has stiffness is made. A new family is a module of compiled loops, a class here that says what its
arrays are, and a row of the table.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, ClassVar

import numpy as np

from lumped.lattice import Lattice
from lumped.pattern import Pattern
from lumped.springs import by_cell, cells, constants, directional, laws, links
from lumped.springs.cell_laws import AREA_AND_STRAINS, FACE, RUBBER, Law
from lumped.springs.cells import CellArrays
from lumped.springs.family import Dampers, Family
from lumped.springs.links import LinkArrays
from lumped.springs.rest import Rest, rest_of
from sheetbench.errors import BadInput
from sheetbench.scenes import SpringSet
from sheetbench.scenes.springs import DamperSet


@dataclass(frozen=True, eq=False)
class Links(Family):
    """Central links, all together: offset (m, 3) [m] rest vectors, rest_length (m,) [m], kind (m,) numbers
    into the lattice's `names`."""

    offset: np.ndarray
    rest_length: np.ndarray
    kind: np.ndarray
    names: tuple[str, ...]

    loops: ClassVar[Any] = links
    measures: ClassVar[int] = 1
    no_stress: ClassVar[np.ndarray] = np.empty(0)

    @cached_property
    def arrays(self) -> LinkArrays:
        """Return what the loops take."""
        return LinkArrays(self.nodes, self.offset, self.rest_length, self.stiffness, self.slots)

    def rounded(self) -> Links:
        """Return the same links with their rest data in single precision."""
        single = {
            name: getattr(self, name).astype(np.float32) for name in ("stiffness", "offset", "rest_length")
        }
        return replace(self, **single)

    def nonnegative_part(self, u: np.ndarray) -> np.ndarray:
        """Return the stresses of stretched links."""
        return np.maximum(self.stresses(u), 0.0)

    def elongations(self, u: np.ndarray, linear: bool = False) -> np.ndarray:
        """Return the elongation of every link, or what is linear in u of it, (m,) [m]."""
        if linear:
            a, b = self.nodes.T
            along: np.ndarray = np.einsum("mq,mq->m", self.offset, u[b] - u[a])
            return along / self.rest_length
        elongations: np.ndarray = links.elongations(u, self.arrays)
        return elongations

    def energies(self, u: np.ndarray, linear: bool = False) -> np.ndarray:
        """Return ½ k e² of every link."""
        return 0.5 * self.stiffness * self.elongations(u, linear) ** 2

    def by_name(self, energies: np.ndarray) -> dict[str, float]:
        """Return sums by kind of link."""
        sums = np.bincount(self.kind, energies, minlength=len(self.names))
        return dict(zip(self.names, sums.tolist(), strict=True))


@dataclass(frozen=True, eq=False)
class DirectionalLinks(Links):
    """Links of the per-direction law of Habibi et al., stiffness (m, 3); neither energy nor stress."""

    loops: ClassVar[Any] = directional
    conservative: ClassVar[bool] = False

    def add_average_force(self, start: np.ndarray, end: np.ndarray, force: np.ndarray) -> None:
        """Add the force in the middle of the step, for want of an energy."""
        self.add_force(0.5 * (start + end), force)

    def energies(self, u: np.ndarray, linear: bool = False) -> np.ndarray:
        """Return zero: this law has no energy."""
        return np.zeros(len(self))

    def damped(self, time: float) -> Dampers:
        """Return dampers along the links, of the mean stiffness."""
        mean = time * self.stiffness.mean(axis=1)
        return Dampers(
            Links(self.nodes, mean, self.slots, self.offset, self.rest_length, self.kind, self.names)
        )


@dataclass(frozen=True, eq=False)
class Cells(Family):
    """Springs on the cells of the layers, of the mid-surface or on upright faces: nodes (c, 4, p), stiffness
    (c, 4) of small strains, against the change of area and the Green strains ε1, ε2, γ of the mean sides,
    which dampers in proportion resist; at rest sides (c, 2, 3) [m] and area (c,) [m²]; the names of area
    springs and of springs against strain, or of all; their law, and what constants it has beside (c, n)."""

    sides: np.ndarray
    area: np.ndarray
    names: tuple[str, str]
    upright: bool = False  # faces between the layers
    law: Law = AREA_AND_STRAINS
    others: np.ndarray | None = None

    loops: ClassVar[Any] = cells

    @property
    def no_stress(self) -> np.ndarray:  # type: ignore[override]
        """Stresses of no cell."""
        return _NO_STRESS[self.law.measures]

    @cached_property
    def constants(self) -> np.ndarray:
        """Return the law's constants, (c, 4 + n), those of small strains first [N/m³]."""
        springs = laws.of_stiffness(self.stiffness, self.sides, self.area)
        return springs if self.others is None else np.column_stack([springs, self.others])

    @cached_property
    def arrays(self) -> CellArrays:
        """Return what the loops take."""
        return CellArrays(self.nodes, self.sides, self.area, self.law.tag(self.constants), self.slots)

    def nonnegative_part(self, u: np.ndarray) -> np.ndarray:
        """Return the positive semidefinite part of the stresses as matrices ((S₁, S₃/2), (S₃/2, S₂)), and
        where it is positive S₄."""
        s = self.stresses(u)
        mean, apart = 0.5 * (s[:, 0] + s[:, 1]), 0.5 * (s[:, 0] - s[:, 1])
        radius = np.hypot(apart, 0.5 * s[:, 2])
        low, high = mean - radius, np.maximum(mean + radius, 0.0)
        with np.errstate(invalid="ignore", divide="ignore"):
            share = np.where(low < 0.0, high / (2.0 * radius), 1.0)[:, None]
        parts = np.stack([s[:, 0] - low, s[:, 1] - low, s[:, 2]], axis=1) * share
        found = np.where((low < 0.0)[:, None], parts, s[:, :3])
        return np.column_stack([found, np.maximum(s[:, 3:], 0.0)])

    def energies(self, u: np.ndarray, linear: bool = False) -> np.ndarray:
        """Return the energy of the area spring and of the springs against strain of every cell; of rubber, at
        any strain, that of the membrane less that of the links along its sides."""
        if linear:
            corners = u[self.nodes].mean(axis=2)
            first, second = corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1]
            (a, b), (da, db) = np.moveaxis(self.sides, 1, 0), (0.5 * (first - second), 0.5 * (first + second))
            strains = [(a * da).sum(1), (b * db).sum(1), (a * db + b * da).sum(1)] / np.array(
                [(a * a).sum(1), (b * b).sum(1), np.sqrt((a * a).sum(1) * (b * b).sum(1))]
            )
            squares = np.stack([(strains[0] + strains[1]) ** 2, *strains**2], axis=1)
            stored = 0.5 * self.area[:, None] * self.stiffness * squares
            return np.stack([stored[:, 0], stored[:, 1:].sum(axis=1)], axis=1)
        if self.law is not AREA_AND_STRAINS:
            every: np.ndarray = cells.energies(u, self.arrays)
            return every[:, None]
        stored = np.zeros((len(self), 2))
        for column, part in enumerate((slice(0, 1), slice(1, None))):
            own = np.zeros_like(self.constants)
            own[:, part] = self.constants[:, part]
            if own.any():
                stored[:, column] = cells.energies(u, self.arrays._replace(law=self.law.tag(own)))
        return stored

    def by_name(self, energies: np.ndarray) -> dict[str, float]:
        """Return both sums, of the springs that there are."""
        there = self.stiffness[:, 0].any(), self.stiffness[:, 1:].any()
        if self.law is not AREA_AND_STRAINS:
            return {self.names[0]: float(energies.sum())}
        sums = zip(self.names, energies.sum(axis=0).tolist(), there, strict=True)
        return {name: energy for name, energy, has in sums if has}

    def damped(self, time: float) -> Dampers:
        """Return dampers of coefficient time [s] × stiffness of small strains."""
        return Dampers(replace(self, stiffness=time * self.stiffness, law=AREA_AND_STRAINS, others=None))


_NO_STRESS = {count: np.empty((0, count)) for count in (3, 4)}


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


def cell_springs(lattice: Lattice, pattern: Pattern, springs: SpringSet) -> Iterator[Cells]:
    """On the cells of the layers and of the mid-surface, with what the edges take off the twist."""
    twist = constants.of_edge_cells(springs, lattice.grid, lattice.twisting)
    layers, rest = lattice.grid[2], rest_of(lattice, pattern)
    for family in lattice.cells:
        nodes, slots, sides, area = rest.cells(family.name)
        every = len(family.nodes) // len(twist)
        if family.name == "area" and springs.rubber:
            found = constants.of_rubber(springs, sides[: len(twist)], area[: len(twist)], twist)
            stiffness, others = (np.concatenate([each] * every) for each in found)
            yield Cells(nodes, stiffness, slots, sides, area, ("rubber", ""), False, RUBBER, others)
            continue
        name, strains = constants.of_strains(springs, family.name, len(twist))
        of_area = by_cell.of_cells(getattr(springs, family.name), len(twist))
        strains[:, 2] += twist if family.name == "area" else -layers * twist
        stiffness = np.column_stack([of_area, strains])
        if stiffness.any():
            stiffness = np.concatenate([stiffness] * every)
            yield Cells(nodes, stiffness, slots, sides, area, (family.name, name))


def face_springs(lattice: Lattice, pattern: Pattern, springs: SpringSet) -> Iterator[Cells]:
    """On the upright faces between the layers, against their shear."""
    if springs.face_shear or springs.face_diagonal_shear:
        rest = rest_of(lattice, pattern)
        faces, (nodes, slots, sides, area) = rest.faces, rest.cells("faces")
        count = lattice.cell_areas.size
        diagonal = by_cell.of_cells(springs.face_diagonal_shear, count)
        per_area = np.vstack([constants.along_each(springs.face_shear, count), diagonal])
        per_area = per_area[faces.axis[:, None], faces.cells]
        stored = per_area * lattice.cell_areas.ravel()[faces.cells]
        stiffness = np.zeros((len(nodes), 4))
        stiffness[:, 3] = (faces.shares * stored).sum(axis=1) / area
        others = stiffness[:, 3:] / area[:, None]
        yield Cells(nodes, stiffness, slots, sides, area, ("face_shear", ""), True, FACE, others)


FAMILIES: tuple[Callable[[Lattice, Pattern, SpringSet], Iterator[Family]], ...] = (
    link_springs,
    cell_springs,
    face_springs,
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
