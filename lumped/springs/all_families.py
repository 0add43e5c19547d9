"""The springs of a lattice: made of a spring set, and summed over their families, each of which has compiled
loops of its own. Springs with an energy are links, cells of the layers and of the mid-surface, and upright
faces; links of a per-direction law have none."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from lumped.lattice import STEPS, Cells, Lattice
from lumped.pattern import SHARED_UP_TO, MassPattern
from lumped.spring_constants import FACES, of_edge_cells, of_rubber
from lumped.spring_constants import Springs as Constants
from lumped.springs import cells, links
from lumped.springs.cell_blocks import mirror_blocks
from lumped.springs.families import DirectionalLinks, Family, Links, SpringCells
from lumped.springs.law_table import FACE, RUBBER
from sheetbench.errors import BadInput
from sheetbench.numerics.cache import cached
from sheetbench.scenes import SpringSet
from sheetbench.scenes.objects.springs import DamperSet


class Survey(NamedTuple):
    """energies: of the springs under each name in the spring set [J]; strain: the largest relative change of
    length of the links in a layer; stretch: of their energy that of the layers' mean stretch [J]."""

    energies: dict[str, float]
    strain: float
    stretch: float


Stresses = tuple[np.ndarray, ...]  # of the families with an energy, each (m,) of links, (m, 4) of cells
NAMES = tuple(dict.fromkeys(name for name, *_ in STEPS))  # of the links' families
NUMBERS = np.array([NAMES.index(name) for name, *_ in STEPS])


class AllFamilies:
    """Families of springs together, links first. Displacements and forces are (n, 3) [m], [N]; stresses one
    array a family with an energy, in turn."""

    def __init__(self, families: Sequence[Family], pattern: MassPattern):
        self.families, self._pattern = tuple(families), pattern
        self.all_links = [family for family in families if isinstance(family, Links)]
        self._others = [family for family in families if isinstance(family, DirectionalLinks)]
        self._cells = [family for family in families if isinstance(family, SpringCells)]
        self.links, self.conservative = self.all_links[0], not self._others
        self.any_strain = any(family.law is RUBBER for family in self._cells)
        self._own: Stresses = (np.empty(0), *len(self._cells) * (np.empty((0, 4)),))

    @cached_property
    def link_stiffness(self) -> np.ndarray:
        """Stiffness of the central links at every row of the arrays, summed, (size,) [N/m]."""
        both = np.repeat(self.links.stiffness, 2)
        return np.bincount(self.links.nodes.ravel(), both, minlength=self._pattern.size)

    @cached_property
    def link_stiffness_norm(self) -> float:
        return float(np.linalg.norm(self.link_stiffness))

    def damped(self, time: float) -> list[Family]:
        """Return the dampers of the families, with `time` [s], of all links together."""
        links: Family = self.links.damped(time)
        for more in (family.damped(time) for family in self._others):
            names = ("nodes", "stiffness", "slots", "offset", "rest_length", "kind")
            each = {name: np.append(getattr(links, name), getattr(more, name), axis=0) for name in names}
            links = replace(links, **each)
        return [links, *(family.damped(time) for family in self._cells)]

    def survey(self, u: np.ndarray, layers: int) -> Survey:
        """Return what the springs of a lattice of so many layers store at u, and how far they are
        strained."""
        along, kind, names = self.links.arrays, self.links.kind, self.links.names
        of_links, stretch = links.energies(u, along, kind, len(names), layers)
        energies = dict(zip(names, of_links.tolist(), strict=True))
        for family in self._cells:
            energies[family.name] = float(cells.energies(u, family.arrays).sum())
        return Survey(energies, self.links.largest_strain(u), stretch)

    def force(self, u: np.ndarray) -> tuple[float, np.ndarray]:
        """Return the energy [J] and the internal force, its gradient; and of springs without an energy the
        force."""
        u, force = np.ascontiguousarray(u), np.zeros(u.shape)
        energy = links.add_forces(u, self.links.arrays, force)
        for family in self._cells:
            energy += cells.add_forces(u, family.arrays, force)
        for other in self._others:
            other.add_force(u, force)
        return energy, force

    def average_force(self, start: np.ndarray, end: np.ndarray) -> np.ndarray:
        """Return the internal force whose work from `start` to `end` is the elastic energy stored; of springs
        without one the force in the middle."""
        force = np.zeros_like(start)
        for family in (self.links, *self._cells):
            family.loops.add_average_forces(start, end, family.arrays, force)
        for other in self._others:
            other.add_force(0.5 * (start + end), force)
        return force

    def extrapolated(self, u: np.ndarray, step: np.ndarray) -> Stresses:
        """Return the stresses that the linearisation at u predicts after a step (n, 3) [m]."""
        first = links.extrapolated(u, step, self.links.arrays, not self.any_strain)
        return (first, *[cells.extrapolated(u, step, family.arrays) for family in self._cells])

    def nonnegative_tangent(self, u: np.ndarray) -> np.ndarray:
        """Return blocks (b, 3, 3) [N/m] of the tangent at u less what could make it indefinite: a sum of
        squares, with negative area springs (ν < 1/3) only while strains are small."""
        stress = tuple(family.nonnegative_part(u) for family in (self.links, *self._cells))
        return self.tangent(u, stress, 0.0)

    def tangent(
        self,
        u: np.ndarray,
        stress: Stresses | None = None,
        share: float = 1.0,
        scale: float = 1.0,
        inertia: np.ndarray | None = None,
        extrapolated: bool = False,
    ) -> np.ndarray:
        """Return scale × the blocks (b, 3, 3) [N/m] of the tangent with these stresses, or the share of the
        springs' own where there are none, and with M + share (D − M); inertia: (n,) [N/m] on the diagonal;
        extrapolated: whether the stresses are those that `extrapolated` predicts."""
        u, pattern = np.ascontiguousarray(u), self._pattern
        blocks, (first, *of_cells) = np.zeros((pattern.blocks, 3, 3)), stress or self._own
        by_strain = extrapolated and not self.any_strain
        links.add_tangent(u, self.links.arrays, first, by_strain, share, blocks)
        for family, own in zip(self._cells, of_cells, strict=True):
            cells.add_tangent(u, family.arrays, own, extrapolated, share, blocks)
        mirror_blocks(blocks, pattern.mirror)
        for other in self._others:
            other.add_tangent(u, blocks)
        if scale != 1.0:
            blocks *= scale
        if inertia is not None:
            blocks[pattern.diagonal[: len(inertia)]] += inertia[:, None, None] * np.eye(3)
        return blocks


def link_springs(lattice: Lattice, pattern: MassPattern, springs: Constants) -> Iterator[Links]:
    """Central links, first and even where there are none; then those of a per-direction law."""
    links = lattice.links
    each = np.stack(np.broadcast_arrays(*(springs.of_links(*family) for *family, _ in STEPS)))
    of_cells = each[links.step, links.cells if each.shape[1] > 1 else 0]
    k = (links.shares[:, :, None] * of_cells).sum(axis=0)
    if (more := springs.upward).of:
        rise = np.stack(np.broadcast_arrays(*(more.of_links(*family)[:, 0] for *family, _ in STEPS)))
        rise = rise[links.step, links.cells if rise.shape[1] > 1 else 0]
        at = _levels(lattice.grid[2])[links.nodes[:, 0] % lattice.grid[2]]
        k = k + (at * (links.shares * rise).sum(axis=0))[:, None]
    unequal = (k != k[:, :1]).any(axis=1)

    def family(kind: type[Links], which: np.ndarray, k: np.ndarray) -> Links:
        nodes, number = links.nodes[which], NUMBERS[links.step[which]]
        slots = pattern.among(nodes).reshape(-1, 4)
        return kind(nodes, k[which], slots, links.offset[which], links.rest_length[which], number, NAMES)

    yield family(Links, ~unequal & (k[:, 0] > 0.0), k[:, 0])
    if unequal.any():
        yield family(DirectionalLinks, unequal, k)


def _levels(layers: int) -> np.ndarray:
    """Heights (layers,) from the middle, in layers."""
    return np.arange(layers) - 0.5 * (layers - 1)


def _cells(at_rest: Cells, pattern: MassPattern, stiffness: np.ndarray, *law: Any) -> SpringCells:
    nodes, sides, area = at_rest
    slots = pattern.among(nodes.reshape(len(nodes), -1))
    return SpringCells(nodes, stiffness, slots, sides, area, *law)


def cell_springs(lattice: Lattice, pattern: MassPattern, springs: Constants) -> Iterator[SpringCells]:
    """On the cells of the layers and of the mid-surface, with what the edges take off the twist."""
    edges = of_edge_cells(springs, lattice.grid, lattice.twisting)
    layers, shape = lattice.grid[2], lattice.cell_areas.shape

    def kept_cells(values: np.ndarray) -> np.ndarray:
        spread = np.broadcast_to(values, (*shape, *values.shape[2:]))
        return spread.reshape(-1, *values.shape[2:])[lattice.kept]

    kinds = (
        ("area", lattice.layer_cells, "cells", layers),
        ("mid_area", lattice.middle_cells, "mid_cells", 1),
    )
    for of_cells, at_rest, name, every in kinds:
        if of_cells == "area" and springs.rubber:
            sides, area = (part[: len(part) // every] for part in at_rest[1:])
            squares, twist = (sides**2).sum(axis=2), edges[lattice.kept, 2]
            found = of_rubber(springs, squares, area, twist, kept_cells)
            stiffness, others = (np.concatenate([each] * every) for each in found)
            yield _cells(at_rest, pattern, stiffness, "rubber", RUBBER, others)
            continue
        strains = kept_cells(springs.strains(of_cells))
        strains = strains + (1 if of_cells == "area" else -layers) * edges[lattice.kept]
        stiffness = np.concatenate(
            [np.column_stack([kept_cells(springs.along(of_cells, 0)), strains])] * every
        )
        if of_cells == "area" and springs.upward.of:
            more = [kept_cells(springs.upward.along("area", 0)), kept_cells(springs.upward.strains("area"))]
            stiffness += np.kron(_levels(layers)[:, None], np.column_stack(more))
        if stiffness.any():
            yield _cells(at_rest, pattern, stiffness, name)


def face_springs(lattice: Lattice, pattern: MassPattern, springs: Constants) -> Iterator[SpringCells]:
    """On the upright faces between the layers, against their shear."""
    if not springs.of.keys() & FACES:
        return
    faces, area = lattice.faces, lattice.faces.at_rest.area
    along = [springs.along("face_shear", axis) for axis in (0, 1)]
    over, one = (springs.along(name, 0) for name in FACES[1:])
    each = (*along, over + np.maximum(one, 0.0), over + np.maximum(-one, 0.0))
    stored = np.stack([(k * lattice.cell_areas).ravel() for k in each])[faces.axis, faces.cells]
    stiffness = np.zeros((len(area), 4))
    stiffness[:, 3] = (faces.shares * stored).sum(axis=0) / area
    others = stiffness[:, 3:] / area[:, None]
    yield _cells(faces.at_rest, pattern, stiffness, "face_shear", FACE, others)


@cached(last=16, most=SHARED_UP_TO, size=lambda lattice, *_: lattice.mass_count)
def springs_of(lattice: Lattice, pattern: MassPattern, springs: SpringSet) -> AllFamilies:
    """The springs of a spring set on a lattice; of a small one the same every time."""
    of = lattice, pattern, Constants.read(springs)
    central, *others = link_springs(*of)
    return AllFamilies([central, *cell_springs(*of), *face_springs(*of), *others], pattern)


def table_dampers(lattice: Lattice, pattern: MassPattern, table: DamperSet) -> Links:
    """The dampers of a scene's [dampers] table, along the links. Raises BadInput for x, y and z apart."""
    along_links, *others = link_springs(lattice, pattern, Constants.read(table))
    if others:
        name = others[0].names[others[0].kind[0]]
        raise BadInput(f"dampers.{name}: a damper acts along its link; give one number, or x and y")
    return along_links
