"""The springs of a lattice: built from a spring set, and called all at once.

A call from Python costs microseconds, as much as a small lattice's springs do; so springs with an energy have
one compiled call, not one a family. Its arrays are always links, the layers' cells, the mid-surface's cells
and upright faces, empty if a lattice has none. Each family has its loops; the calls of this module release
the interpreter's lock. Springs without an energy are added to the result.
"""

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
from lumped.springs.cells import CellArrays
from lumped.springs.families import NO_CELLS, DirectionalLinks, Family, Links, SpringCells
from lumped.springs.law_table import FACE, RUBBER, measures
from lumped.springs.links import LinkArrays
from sheetbench.errors import BadInput
from sheetbench.numerics.aliasing import zeros
from sheetbench.numerics.cache import cached
from sheetbench.numerics.options import Pointer, njit, pointer, typed
from sheetbench.scenes import SpringSet
from sheetbench.scenes.objects.springs import DamperSet


class SpringArrays(NamedTuple):
    """The springs of a lattice that have an energy, and the places of their tangent's blocks. blocks: number
    of blocks; mirror: `MassPattern.mirror`; diagonal: (n,) each mass's block with itself."""

    links: LinkArrays
    layers: CellArrays
    middle: CellArrays
    faces: CellArrays
    blocks: int
    mirror: np.ndarray
    diagonal: np.ndarray


class Survey(NamedTuple):
    """Energies and strain of springs. energies: [J] by the springs' name in the spring set; strain: the
    largest relative change of length of the links in a layer; stretch: [J] the part of their energy by the
    layers' mean stretch."""

    energies: dict[str, float]
    strain: float
    stretch: float


Stresses = tuple[np.ndarray, ...]  # four, of the springs of `SpringArrays`
NO_STRESSES: Stresses = (np.empty(0), *3 * (np.empty((0, 4)),))
NO_INERTIA = np.empty(0)
NAMES = tuple(dict.fromkeys(name for name, *_ in STEPS))  # of the links' families
NUMBERS = np.array([NAMES.index(name) for name, *_ in STEPS])
KINDS = tuple(dict.fromkeys((family, direction) for family, direction, _ in STEPS))
KIND = np.array([KINDS.index((family, direction)) for family, direction, _ in STEPS])


class AllFamilies:
    """All springs of a lattice: links, cells of the layers and of the mid-surface, upright faces, each
    perhaps empty, then springs without an energy. Displacements and forces are (n, 3) [m], [N]; stresses are
    in the order of `SpringArrays`."""

    def __init__(self, families: Sequence[Family], pattern: MassPattern):
        self.families = (*families, *[NO_CELLS] * (4 - len(families)))
        self._central: tuple[Any, ...] = self.families[:4]
        self._others = [family for family in self.families if isinstance(family, DirectionalLinks)]
        arrays = [family.arrays for family in self._central]
        where = pattern.blocks, pattern.mirror, pattern.diagonal
        self.springs = pointer(typed(SpringArrays._make([*arrays, *where])))
        self.all_links = [family for family in self.families if isinstance(family, Links)]
        self.links, self._pattern, self.conservative = self.all_links[0], pattern, not self._others
        self.any_strain = any(isinstance(one, SpringCells) and one.law is RUBBER for one in families)

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
        links, *cells = [family.damped(time) for family in self._central]
        for more in (family.damped(time) for family in self._others):
            names = ("nodes", "stiffness", "slots", "offset", "rest_length", "kind")
            joined = {name: np.append(getattr(links, name), getattr(more, name), axis=0) for name in names}
            links = replace(links, **joined)
        return [links, *cells]

    def survey(self, u: np.ndarray, layers: int) -> Survey:
        """Return the springs' energies and largest strain at u; layers: of the lattice."""
        along, kind, names = self.links.arrays, self.links.kind, self.links.names
        of_links, stretch, strain = links.survey(u, along, kind, len(names), layers)
        energies = dict(zip(names, of_links.tolist(), strict=True))
        for family in self._central[1:]:
            if len(family):
                energies[family.name] = float(cells.energies(u, family.arrays).sum())
        return Survey(energies, strain, stretch)

    def force(self, u: np.ndarray) -> tuple[float, np.ndarray]:
        """Return the energy [J] and the internal force, its gradient."""
        energy, internal = force(np.ascontiguousarray(u), self.springs)
        return energy, self.add_other_forces(u, internal)

    def add_other_forces(self, u: np.ndarray, internal: np.ndarray) -> np.ndarray:
        """Add the forces at u of springs without an energy to `internal`, and return it."""
        for family in self._others:
            family.add_force(u, internal)
        return internal

    def average_force(self, start: np.ndarray, end: np.ndarray) -> np.ndarray:
        """Return the internal force whose work from `start` to `end` is the change of elastic energy; springs
        without an energy contribute their force in the middle."""
        force = np.zeros_like(start)
        for family in self._central:
            family.loops.add_average_forces(start, end, family.arrays, force)
        return self.add_other_forces(0.5 * (start + end), force)

    def powers_by_constants(self, u: np.ndarray, v: np.ndarray) -> list[np.ndarray]:
        """Return the derivatives of the power v·f of every spring at u by its constants, then by its natural
        δg₀: links (m, 2), cells of each kind (c, n + 3). Raises BadInput for springs without an energy."""
        if self._others:
            raise BadInput("gradient: springs of unequal stiffness along x, y and z have no energy")
        at = np.ascontiguousarray(u), np.ascontiguousarray(v)
        return [family.loops.powers_by_constants(*at, family.arrays) for family in self._central]

    def nonnegative_tangent(self, u: np.ndarray) -> np.ndarray:
        """Return blocks (b, 3, 3) [N/m] of the tangent at u without parts that could make it indefinite: a
        sum of squares, with negative area springs (ν < 1/3) only while strains are small."""
        return self.tangent(u, tuple(family.nonnegative_part(u) for family in self._central), 0.0)

    def tangent(
        self,
        u: np.ndarray,
        stress: Stresses | None = None,
        share: float = 1.0,
        scale: float = 1.0,
        inertia: np.ndarray = NO_INERTIA,
        extrapolated: bool = False,
    ) -> np.ndarray:
        """Return scale × the blocks (b, 3, 3) [N/m] of the tangent with given stresses, or without them with
        the share of the stresses at u, and with M + share (D − M); inertia: (n,) [N/m] on the diagonal;
        extrapolated: whether the stresses are predictions of `extrapolated`."""
        blocks: np.ndarray = tangent(
            np.ascontiguousarray(u),
            stress or NO_STRESSES,
            extrapolated,
            share,
            scale,
            inertia,
            self.springs,
        )
        for family in self._others:
            unscaled = np.zeros_like(blocks)
            family.add_tangent(u, unscaled)
            blocks += scale * unscaled
        return blocks


@njit
def force(u: np.ndarray, springs: Pointer[SpringArrays]) -> tuple[float, np.ndarray]:
    """Return the energy [J] and the internal force (n, 3) [N]."""
    out, of = zeros(u.shape), springs.value
    energy = links.add_forces(u, of.links, out)
    energy += cells.add_forces(u, of.layers, out)
    energy += cells.add_forces(u, of.middle, out)
    energy += cells.add_forces(u, of.faces, out)
    return energy, out


@njit(inline="always")
def extrapolated(u: np.ndarray, step: np.ndarray, springs: Pointer[SpringArrays]) -> Stresses:
    """Return the stresses that the linearisation at u predicts after a step (n, 3) [m]."""
    of = springs.value
    return (
        links.extrapolated(u, step, of.links, measures(of.layers.law) == 3),
        cells.extrapolated(u, step, of.layers),
        cells.extrapolated(u, step, of.middle),
        cells.extrapolated(u, step, of.faces),
    )


@njit
def tangent(
    u: np.ndarray,
    stress: Stresses,
    extrapolated: bool,
    share: float,
    scale: float,
    inertia: np.ndarray,
    springs: Pointer[SpringArrays],
) -> np.ndarray:
    """Return scale × blocks (b, 3, 3) [N/m] of the tangent with given stresses, or if they are empty with the
    share of the stresses at u, and with M + share (D − M), and on the diagonal `inertia` (n,) [N/m]. The
    tangent is symmetric: blocks above the diagonal are copies."""
    of = springs.value
    blocks = zeros((of.blocks, 3, 3))
    strain = extrapolated and measures(of.layers.law) == 3
    links.add_tangent(u, of.links, stress[0], strain, share, blocks)
    cells.add_tangent(u, of.layers, stress[1], extrapolated, share, blocks)
    cells.add_tangent(u, of.middle, stress[2], extrapolated, share, blocks)
    cells.add_tangent(u, of.faces, stress[3], extrapolated, share, blocks)
    if scale != 1.0:
        entries = blocks.ravel()
        for e in range(len(entries)):
            entries[e] *= scale
    for i in range(len(inertia)):
        for q in range(3):
            blocks[of.diagonal[i], q, q] += inertia[i]
    for k in range(len(of.mirror)):
        below, above = blocks[np.uint64(of.mirror[k, 0])], blocks[np.uint64(of.mirror[k, 1])]
        for q in range(3):
            for r in range(3):
                above[q, r] = below[r, q]
    return blocks


def stiffness_by_cells(lattice: Lattice, springs: Constants) -> np.ndarray:
    """Return the contributions of the adjacent cells to the stiffness of every link of the grid, (4, links,
    components) [N/m]."""
    links = lattice.links

    def shared(springs: Constants) -> np.ndarray:
        by_kind = np.stack(np.broadcast_arrays(*(springs.of_links(*kind) for kind in KINDS)))
        of_cells = by_kind[KIND[links.step], links.cells if by_kind.shape[1] > 1 else 0]
        return np.asarray(links.shares[:, :, None] * of_cells)

    stiffness = shared(springs)
    if springs.upward.of:
        at = _levels(lattice.grid[2])[links.nodes[:, 0] % lattice.grid[2]]
        stiffness = stiffness + at[:, None] * shared(springs.upward)
    return stiffness


def link_springs(lattice: Lattice, pattern: MassPattern, springs: Constants) -> Iterator[Links]:
    """Yield the central links, even if there are none, then the links of a per-direction law, if any."""
    links, k = lattice.links, stiffness_by_cells(lattice, springs).sum(axis=0)
    unequal = (k != k[:, :1]).any(axis=1)

    def family(kind: type[Links], which: np.ndarray, k: np.ndarray) -> Links:
        nodes, number = links.nodes[which], NUMBERS[links.step[which]]
        slots = pattern.among(nodes).reshape(-1, 4)
        return kind(nodes, k[which], slots, links.offset[which], links.rest_length[which], number, NAMES)

    yield family(Links, ~unequal & (k[:, 0] > 0.0), k[:, 0])
    if unequal.any():
        yield family(DirectionalLinks, unequal, k)


def _levels(layers: int) -> np.ndarray:
    """Return the heights (layers,) from the middle, in layers."""
    return np.arange(layers) - 0.5 * (layers - 1)


def _cells(at_rest: Cells, pattern: MassPattern, stiffness: np.ndarray, *law: Any) -> SpringCells:
    nodes, sides, area = at_rest
    slots = pattern.among(nodes.reshape(len(nodes), -1))
    return SpringCells(nodes, stiffness, slots, sides, area, *law)


def cell_springs(lattice: Lattice, pattern: MassPattern, springs: Constants) -> Iterator[SpringCells]:
    """Yield the springs on the cells of the layers and of the mid-surface, with the edges' correction of the
    twisting stiffness."""
    edges = of_edge_cells(springs, lattice.grid, lattice.twisting)
    layers, shape = lattice.grid[2], lattice.cell_areas.shape

    def kept_cells(values: np.ndarray) -> np.ndarray:
        spread = np.broadcast_to(values, (*shape, *values.shape[2:]))
        return spread.reshape(-1, *values.shape[2:])[lattice.present_cells]

    kinds = (
        ("area", lattice.layer_cells, "cells", layers),
        ("mid_area", lattice.middle_cells, "mid_cells", 1),
    )
    for of_cells, at_rest, name, repeats in kinds:
        if of_cells == "area" and springs.rubber:
            sides, area = (part[: len(part) // repeats] for part in at_rest[1:])
            squares, twist = (sides**2).sum(axis=2), edges[lattice.present_cells, 2]
            of_layer = of_rubber(springs, squares, area, twist, kept_cells)
            stiffness, constants = (np.concatenate([part] * repeats) for part in of_layer)
            yield _cells(at_rest, pattern, stiffness, "rubber", RUBBER, constants)
            continue
        strains = kept_cells(springs.strains(of_cells))
        strains = strains + (1 if of_cells == "area" else -layers) * edges[lattice.present_cells]
        stiffness = np.concatenate(
            [np.column_stack([kept_cells(springs.along(of_cells, 0)), strains])] * repeats
        )
        if of_cells == "area" and springs.upward.of:
            more = [kept_cells(springs.upward.along("area", 0)), kept_cells(springs.upward.strains("area"))]
            stiffness += np.kron(_levels(layers)[:, None], np.column_stack(more))
        yield _cells(at_rest, pattern, stiffness, name) if stiffness.any() else NO_CELLS


def faces_by_cells(lattice: Lattice, springs: Constants) -> np.ndarray:
    """Return the contributions of the adjacent cells to every upright face's stiffness times its area, (4,
    faces) [N·m]."""
    along = [springs.along("face_shear", axis) for axis in (0, 1)]
    over, coupling = (springs.along(name, 0) for name in FACES[1:])
    by_axis = (*along, over + np.maximum(coupling, 0.0), over + np.maximum(-coupling, 0.0))
    stored = np.stack([(k * lattice.cell_areas).ravel() for k in by_axis])
    return np.asarray(lattice.faces.shares * stored[lattice.faces.axis, lattice.faces.cells])


def face_springs(lattice: Lattice, pattern: MassPattern, springs: Constants) -> SpringCells:
    """Return the springs against shear on the upright faces between the layers."""
    if not springs.of.keys() & FACES:
        return NO_CELLS
    faces, area = lattice.faces, lattice.faces.at_rest.area
    stiffness = np.zeros((len(area), 4))
    stiffness[:, 3] = faces_by_cells(lattice, springs).sum(axis=0) / area
    others = stiffness[:, 3:] / area[:, None]
    return _cells(faces.at_rest, pattern, stiffness, "face_shear", FACE, others)


@cached(last=16, most=SHARED_UP_TO, size=lambda lattice, *_: lattice.mass_count)
def springs_of(lattice: Lattice, pattern: MassPattern, springs: SpringSet) -> AllFamilies:
    """Return the springs of a spring set on a lattice, cached for small lattices."""
    return families_of(lattice, pattern, Constants.read(springs))


def families_of(lattice: Lattice, pattern: MassPattern, springs: Constants) -> AllFamilies:
    """Return the springs of given constants on a lattice."""
    of = lattice, pattern, springs
    central, *others = link_springs(*of)
    return AllFamilies([central, *cell_springs(*of), face_springs(*of), *others], pattern)


def table_dampers(lattice: Lattice, pattern: MassPattern, table: DamperSet) -> Links:
    """Return the dampers of a scene's [dampers] table, along the links. Raises BadInput for a damper with
    values along x, y and z."""
    along_links, *others = link_springs(lattice, pattern, Constants.read(table))
    if others:
        name = others[0].names[others[0].kind[0]]
        raise BadInput(f"dampers.{name}: a damper acts along its link; give one number, or x and y")
    return along_links
