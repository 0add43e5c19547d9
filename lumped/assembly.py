"""A lattice with its springs, ready to compute: energy, internal force, tangent over a fixed block pattern.

With precision "single" the internal force is computed from displacements, rest geometry and stiffness kept
in single precision, each link in it, cells in double within themselves; the tangent stays in double.

Only what the scene has is assembled: families of zero stiffness are left out. Links of the seed's
per-direction law (unequal x, y, z stiffness) are kept apart: they have no energy, and their tangent is
unsymmetric.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Literal, TypeVar

import numpy as np

from lumped.actuators import Coupling
from lumped.calibration import Calibration
from lumped.lattice import Lattice, Weights, build
from lumped.moduli import family_stiffness, strain_stiffness
from lumped.springs import areas as cells
from lumped.springs import links as springs
from lumped.springs import strains
from sheetbench.scenes import Sheet
from sheetbench.scenes.errors import BadInput

Precision = Literal["double", "single"]


@dataclass(frozen=True)
class Links:
    """Links of one kind, all families together: nodes (m, 2), offset (m, 3), rest_length (m,),
    stiffness (m,) or, per direction, (m, 3) [N/m]; family (m,) numbers into `families`."""

    nodes: np.ndarray
    offset: np.ndarray
    rest_length: np.ndarray
    stiffness: np.ndarray
    family: np.ndarray
    slots: np.ndarray

    def __len__(self) -> int:
        return len(self.nodes)


@dataclass(frozen=True)
class Cells:
    """Area or strain springs of one kind: nodes (c, 4, p), rest diagonals (c, 2, 3) [m], stiffness (c,) or,
    of the three strains, (c, 3) [N/m]."""

    name: str
    nodes: np.ndarray
    diagonals: np.ndarray
    stiffness: np.ndarray
    slots: np.ndarray

    def energies(self, stress: np.ndarray) -> np.ndarray:
        """Energy ½ τ²/k · a0 of each area spring under its stress τ [N/m], (c,) [J]."""
        rest_area = 0.5 * np.linalg.norm(np.cross(self.diagonals[:, 0], self.diagonals[:, 1]), axis=1)
        k = self.stiffness
        density = 0.5 * np.divide(stress**2, k, out=np.zeros_like(k), where=k != 0.0)
        energy: np.ndarray = rest_area * (density if density.ndim == 1 else density.sum(axis=1))
        return energy


Part = TypeVar("Part", Links, Cells)


@dataclass(frozen=True)
class Stresses:
    """The tension of every central link, (m,) [N], the stress of every area spring, (c,), and the stresses of
    every strain spring, (c, 3) [N/m]."""

    links: np.ndarray
    cells: tuple[np.ndarray, ...]
    strains: tuple[np.ndarray, ...]


class Pattern:
    """Block sparsity: sorted pairs (row, column) of masses that act on each other, stored as in BSR."""

    def __init__(self, size: int, rows: np.ndarray, columns: np.ndarray):
        keys = np.unique(rows.astype(np.int64) * size + columns)
        self.size, self._keys = size, keys
        self.rows, self.indices = keys // size, (keys % size).astype(np.int32)
        self.indptr = np.searchsorted(self.rows, np.arange(size + 1)).astype(np.int32)

    @property
    def blocks(self) -> int:
        return len(self._keys)

    def slots(self, rows: np.ndarray, columns: np.ndarray) -> np.ndarray:
        """Block numbers of pairs (any shape)."""
        found: np.ndarray = np.searchsorted(self._keys, np.asarray(rows, np.int64) * self.size + columns)
        return found.astype(np.int32)


class Assembly:
    """Energy, force and tangent of a calibrated lattice. Displacements and forces are (n, 3) [m], [N].

    couple: makes the actuators bound to the lattice; their rows follow those of the masses in every array.
    precision: of the internal force.
    """

    def __init__(
        self,
        sheet: Sheet,
        calibration: Calibration,
        weights: Weights = "tributary",
        couple: Callable[[Lattice], Coupling] | None = None,
        precision: Precision = "double",
    ):
        self.lattice: Lattice = build(sheet, calibration.grid, calibration.layer_distance, weights)
        self.families = tuple(dict.fromkeys(family.name for family in self.lattice.links))
        central, directional = [], []
        for family in self.lattice.links:
            k = family_stiffness(calibration.springs, family.name, family.direction)
            number = np.full(len(family.nodes), self.families.index(family.name))
            row = (family.nodes, family.offset, family.rest_length)
            if np.ndim(k) and len(set(np.atleast_1d(k))) > 1:
                directional.append((*row, family.weight[:, None] * np.array(k), number))
            elif np.max(k) > 0.0:
                central.append((*row, family.weight * float(np.max(k)), number))
        self.distribution = calibration.masses
        spring_set = calibration.springs
        areas, stretchy = [], []
        for cell in self.lattice.cells:
            k = getattr(spring_set, cell.name)
            if k != 0.0:
                areas.append((cell.name, cell.nodes, np.array(k)))
            name, three = strain_stiffness(spring_set, cell.name)
            if any(three):
                stretchy.append((name, cell.nodes, np.array(three)))

        pairs = _neighbours(self.lattice.columns())
        self.coupling = couple(self.lattice) if couple is not None else None
        if self.coupling is None:
            self.pattern = Pattern(self.lattice.mass_count, *pairs)
        else:
            own = self.coupling.pairs()
            both = (np.concatenate(part) for part in zip(pairs, own, strict=True))
            self.pattern = Pattern(self.coupling.size, *both)
            self.coupling_slots = self.pattern.slots(*own)
        self.links = self._links(central, 1)
        self.directional = self._links(directional, 3)
        self.cells = tuple(self._cells(*area) for area in areas)
        self.strains = tuple(self._cells(*row) for row in stretchy)
        self.precision = precision
        self._forcing = self.links, self.directional, self.cells, self.strains
        if precision == "single":
            self._forcing = (
                _rounded(self.links),
                _rounded(self.directional),
                tuple(_rounded(c) for c in self.cells),
                tuple(_rounded(c) for c in self.strains),
            )

    @property
    def rounding(self) -> float:
        """Relative spacing of the numbers that the internal force is computed with."""
        return float(np.finfo(np.float32 if self.precision == "single" else float).eps)

    @property
    def conservative(self) -> bool:
        """Whether the springs have an energy (and so a symmetric tangent)."""
        return len(self.directional) == 0

    def require_energy(self) -> None:
        """Raise BadInput when the springs have no energy."""
        if not self.conservative:
            raise BadInput(
                "per-direction springs have no energy: descent and energy-based methods do not apply"
            )

    def _links(self, rows: list, width: int) -> Links:
        if not rows:
            none = np.empty(0)
            stiffness = none if width == 1 else np.empty((0, 3))
            whole = np.empty((0, 2), np.int64)
            return Links(
                whole, np.empty((0, 3)), none, stiffness, np.empty(0, int), np.empty((0, 4), np.int32)
            )
        nodes, offset, rest, stiffness, family = (np.concatenate(part) for part in zip(*rows, strict=True))
        a, b = nodes.T
        pairs = ((a, a), (a, b), (b, a), (b, b))
        slots = np.stack([self.pattern.slots(*pair) for pair in pairs], axis=1)
        return Links(nodes, offset, rest, stiffness, family, slots)

    def _cells(self, name: str, nodes: np.ndarray, k: np.ndarray) -> Cells:
        corners = self.lattice.positions[nodes].mean(axis=2)
        diagonals = np.stack([corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1]], axis=1)
        flat = nodes.reshape(len(nodes), -1)
        slots = self.pattern.slots(flat[:, :, None], flat[:, None, :])
        return Cells(name, nodes, diagonals, np.full((len(nodes), *k.shape), k), slots)

    def force(self, u: np.ndarray) -> tuple[float, np.ndarray]:
        """Elastic energy [J] and its gradient, the internal force, (n, 3) [N]."""
        links, d, areas, stretches = self._forcing
        kept = u.astype(np.float32) if self.precision == "single" else u
        force = np.zeros_like(kept)
        energy = springs.add_forces(
            kept, links.nodes, links.offset, links.rest_length, links.stiffness, force
        )
        for c in areas:
            energy += cells.add_forces(kept, c.nodes, c.diagonals, c.stiffness, force)
        for c in stretches:
            energy += strains.add_forces(kept, c.nodes, c.diagonals, c.stiffness, force)
        if len(d):
            springs.add_directional_forces(kept, d.nodes, d.offset, d.rest_length, d.stiffness, force)
        return energy, force.astype(float, copy=False)

    def energies(self, u: np.ndarray) -> dict[str, float]:
        """Elastic energy of each spring family and of the area and strain springs [J]."""
        stresses = self.stresses(u)
        stored = 0.5 * stresses.links**2 / self.links.stiffness
        per_family = np.bincount(self.links.family, stored, minlength=len(self.families))
        energies = {name: float(value) for name, value in zip(self.families, per_family, strict=True)}
        for c, stress in self.cell_stresses(stresses):
            energies[c.name] = float(c.energies(stress).sum())
        return energies

    def cell_stresses(self, stresses: Stresses) -> list[tuple[Cells, np.ndarray]]:
        """Every kind of area and strain spring with its stresses."""
        return list(zip(self.cells + self.strains, stresses.cells + stresses.strains, strict=True))

    def stresses(self, u: np.ndarray) -> Stresses:
        """Tensions, area stresses and strain stresses at u."""
        links = self.links
        return Stresses(
            springs.tensions(u, links.nodes, links.offset, links.rest_length, links.stiffness),
            tuple(cells.stresses(u, c.nodes, c.diagonals, c.stiffness) for c in self.cells),
            tuple(strains.stresses(u, c.nodes, c.diagonals, c.stiffness) for c in self.strains),
        )

    def extrapolated(self, u: np.ndarray, step: np.ndarray) -> Stresses:
        """Tensions and stresses that the linearisation at u predicts after `step`."""
        links = self.links
        return Stresses(
            springs.extrapolated_tensions(
                u, step, links.nodes, links.offset, links.rest_length, links.stiffness
            ),
            tuple(
                cells.extrapolated_stresses(u, step, c.nodes, c.diagonals, c.stiffness) for c in self.cells
            ),
            tuple(
                strains.extrapolated_stresses(u, step, c.nodes, c.diagonals, c.stiffness)
                for c in self.strains
            ),
        )

    def tangent(self, u: np.ndarray, stresses: Stresses | None = None) -> np.ndarray:
        """Blocks (b, 3, 3) [N/m] of the tangent at u, with the stresses given or those at u."""
        stresses = stresses if stresses is not None else self.stresses(u)
        blocks = np.zeros((self.pattern.blocks, 3, 3))
        links = self.links
        springs.add_tangent(
            u,
            links.nodes,
            links.offset,
            links.rest_length,
            links.stiffness,
            stresses.links,
            links.slots,
            blocks,
        )
        for c, stress in zip(self.cells, stresses.cells, strict=True):
            cells.add_tangent(u, c.nodes, c.diagonals, c.stiffness, stress, c.slots, blocks)
        for c, stress in zip(self.strains, stresses.strains, strict=True):
            strains.add_tangent(u, c.nodes, c.diagonals, c.stiffness, stress, c.slots, blocks)
        d = self.directional
        if len(d):
            springs.add_directional_tangent(u, d.nodes, d.offset, d.rest_length, d.stiffness, d.slots, blocks)
        return blocks


def _rounded(row: Part) -> Part:
    """The same in single precision."""
    floats = {k: value for k, value in vars(row).items() if getattr(value, "dtype", None) == np.float64}
    return replace(row, **{name: value.astype(np.float32) for name, value in floats.items()})


def _neighbours(columns: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Ordered pairs of masses that may act on each other: any two in the four columns of one cell."""
    around = np.stack([columns[:-1, :-1], columns[:-1, 1:], columns[1:, 1:], columns[1:, :-1]], axis=2)
    nodes = around.reshape(-1, 4 * columns.shape[2])
    p = nodes.shape[1]
    return np.repeat(nodes, p, axis=1).ravel(), np.tile(nodes, (1, p)).ravel()
