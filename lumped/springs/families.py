"""Families of springs, with the operations that assembly, descent and integrators use, and their dampers.

A family is data (masses, rest geometry, the constants of every spring's law) and a module of compiled loops
over it, `lumped.springs.links` or `lumped.springs.cells`, whose functions take the displacement, then the
family's arrays. `lumped.springs.laws` defines stress S, stiffness D and its material part M.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, ClassVar

import numpy as np

from lumped.springs import cells, laws, links
from lumped.springs.cells import CellArrays
from lumped.springs.law_table import AREA_AND_STRAINS, CellLaw
from lumped.springs.links import LinkArrays
from sheetbench.numerics.options import typed


@dataclass(frozen=True, eq=False)
class Family:
    """Springs of one kind. nodes: (m, …) masses of each spring; stiffness: (m,) or (m, 4) [N/m]; slots: (m,
    …) block numbers of each spring's pairs of masses. Displacements and forces are (n, 3) [m], [N]."""

    nodes: np.ndarray
    stiffness: np.ndarray
    slots: np.ndarray

    loops: ClassVar[Any]
    arrays: ClassVar[Any]  # arguments of the loops after the displacement, `LinkArrays` or `CellArrays`
    measures: ClassVar[int] = 4  # number of measures of a spring

    def __len__(self) -> int:
        return len(self.nodes)

    def stresses(self, u: np.ndarray) -> np.ndarray:
        """Return the stress of every spring, (m, 1) of links, (m, 4) of cells [N/m]."""
        stress, change, none = np.zeros((3, len(self), self.measures))
        self.loops.add_forces(u, self.arrays, np.zeros_like(u), (0.0, none, stress, change))
        return stress

    def damped(self, time: float) -> Family:
        """Return dampers that resist the rates of the measures: springs with coefficients time [s] ×
        stiffness [N·s/m] in its place, of stress M ġ; they take the power ġ·M ġ."""
        return replace(self, stiffness=time * self.stiffness)


@dataclass(frozen=True, eq=False)
class Links(Family):
    """Central links of all directions. offset: (m, 3) [m] rest vectors; rest_length: (m,) [m]; kind: (m,)
    numbers into `names`; natural: δg₀ (m,) [m²] of a sheet that is not flat at rest."""

    offset: np.ndarray
    rest_length: np.ndarray
    kind: np.ndarray
    names: tuple[str, ...]
    natural: np.ndarray | float = 0.0

    loops: ClassVar[Any] = links
    measures: ClassVar[int] = 1

    @cached_property
    def arrays(self) -> LinkArrays:
        """Arrays for the loops."""
        rest = np.stack(np.broadcast_arrays(self.rest_length, self.natural))
        return typed(LinkArrays(self.nodes, self.offset, rest, self.stiffness, self.slots))

    def largest_strain(self, u: np.ndarray) -> float:
        """Return the largest relative change of length of the in-plane links at a displacement (n, 3) [m]."""
        return float(links.strains(u[None], self.arrays, 0.0)[0][0])

    def nonnegative_part(self, u: np.ndarray) -> np.ndarray:
        """Return the stresses of stretched links."""
        return np.maximum(self.stresses(u)[:, 0], 0.0)

    def stretched(self, u: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return the position (m, 3) [m] of every link's second end relative to its first, its length and its
        elongation (m,) [m]."""
        d = u[self.nodes[:, 1]] - u[self.nodes[:, 0]]
        r, change = self.offset + d, ((2.0 * self.offset + d) * d).sum(axis=1) - self.natural
        length = np.linalg.norm(r, axis=1)
        return r, length, change / (length + self.rest_length)


@dataclass(frozen=True, eq=False)
class DirectionalLinks(Links):
    """Links of the per-direction law of Habibi et al., F_q = k_q Δ_q (1 − L/r), stiffness (m, 3); neither
    energy nor stress."""

    def add_force(self, u: np.ndarray, force: np.ndarray) -> None:
        """Add the internal force."""
        r, length, elongation = self.stretched(u)
        pull = self.stiffness * (elongation / length)[:, None] * r
        np.add.at(force, self.nodes, np.stack([-pull, pull], axis=1))

    def add_tangent(self, u: np.ndarray, blocks: np.ndarray) -> None:
        """Add the tangent diag(k) [n nᵀ + (e/r) (I − n nᵀ)], unsymmetric, to the 3×3 blocks [N/m]."""
        r, length, elongation = self.stretched(u)
        along = r[:, :, None] * r[:, None, :] / (length**2)[:, None, None]
        across = (elongation / length)[:, None, None] * (np.eye(3) - along)
        block = self.stiffness[:, :, None] * (along + across)
        np.add.at(blocks, self.slots, np.stack([block, -block, -block, block], axis=1))

    def damped(self, time: float) -> Links:
        """Return dampers along the links, of the mean stiffness."""
        mean = time * self.stiffness.mean(axis=1)
        return Links(self.nodes, mean, self.slots, self.offset, self.rest_length, self.kind, self.names)


@dataclass(frozen=True, eq=False)
class SpringCells(Family):
    """Springs on the cells of the layers, of the mid-surface or on upright faces. nodes: (c, 4, p);
    stiffness: (c, 4) [N/m] of small strains, against the change of area and the Green strains ε1, ε2, γ of
    the mean sides, or (c, 7) with their couplings; dampers are proportional to it; sides: (c, 2, 3) [m] and
    area: (c,) [m²] at rest; name: among energies; law: of the springs, others: (c, n) its further constants;
    natural: (4, c) area and δg₀ of a sheet that is not flat at rest."""

    sides: np.ndarray
    area: np.ndarray
    name: str
    law: CellLaw = AREA_AND_STRAINS
    others: np.ndarray | None = None
    natural: np.ndarray | None = None

    loops: ClassVar[Any] = cells

    @cached_property
    def constants(self) -> np.ndarray:
        """The law's constants, first of small strains [N/m³]: (c, 7), or (c, 4 + n)."""
        springs = laws.of_stiffness(self.stiffness, self.sides, self.area)
        return springs if self.others is None else np.column_stack([springs[:, :4], self.others])

    @cached_property
    def arrays(self) -> CellArrays:
        """Arrays for the loops."""
        rest = self.natural
        if rest is None:
            rest = np.vstack([self.area, np.zeros((3, len(self)))])
        return typed(CellArrays(self.nodes, self.sides, rest, self.law.tag(self.constants), self.slots))

    def nonnegative_part(self, u: np.ndarray) -> np.ndarray:
        """Return the positive semidefinite part of the stresses as matrices ((S₁, S₃/2), (S₃/2, S₂)), and the
        positive part of S₄."""
        s = self.stresses(u)
        values, vectors = np.linalg.eigh(s[:, [[0, 2], [2, 1]]] * [[1.0, 0.5], [0.5, 1.0]])
        part = (vectors * np.maximum(values, 0.0)[:, None]) @ vectors.swapaxes(1, 2)
        return np.column_stack([part[:, [0, 1], [0, 1]], 2.0 * part[:, 0, 1], np.maximum(s[:, 3], 0.0)])

    def damped(self, time: float) -> SpringCells:
        """Return dampers of coefficient time [s] × stiffness of small strains."""
        springs = replace(self, stiffness=time * self.stiffness, natural=None)
        return replace(springs, law=AREA_AND_STRAINS, others=None)


_NO_SLOTS, _NO_SIDES = np.empty((0, 4, 4), np.int32), np.empty((0, 2, 3))
NO_CELLS = SpringCells(np.empty((0, 4, 1), int), np.empty((0, 4)), _NO_SLOTS, _NO_SIDES, np.empty(0), "")
