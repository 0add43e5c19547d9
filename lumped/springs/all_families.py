"""All families of springs at once: energy and force, stresses, tangent.

A call from Python costs microseconds, as much as a small lattice's springs do; so those with an energy have
one compiled call, not one a family. Its arrays always are of the same kinds, empty where a lattice has no
such springs: links, the layers' cells, the mid-surface's cells, upright faces. The loops themselves are each
family's own; here they release the interpreter's lock. Springs without an energy are added to what it gives.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from functools import cache
from typing import Any, NamedTuple

import numpy as np
from numba import njit

from lumped.pattern import Pattern
from lumped.springs import cells, links
from lumped.springs.cell_laws import AreaAndStrains
from lumped.springs.cells import CellArrays
from lumped.springs.families import Cells
from lumped.springs.family import Family
from lumped.springs.links import LinkArrays
from lumped.springs.tiles import NUMBA_TRUE


class Springs(NamedTuple):
    """The springs of a lattice that have an energy."""

    links: LinkArrays
    layers: CellArrays
    middle: CellArrays
    faces: CellArrays


class Blocks(NamedTuple):
    """Where a tangent's blocks are: their number; `Pattern.mirror`; each mass's block with itself (n,)."""

    total: int
    mirror: np.ndarray
    diagonal: np.ndarray


Stresses = tuple[np.ndarray, ...]  # four, as `Springs`
NO_STRESSES: Stresses = (np.empty(0), *3 * (np.empty((0, 3)),))
NO_INERTIA = np.empty(0)


class AllFamilies:
    """Families of springs together. Displacements and forces are (n, 3) [m], [N]; stresses as `Springs`."""

    def __init__(self, families: Sequence[Family], pattern: Pattern):
        found = {_place(family): family for family in families}
        links_, *cells_ = [_arrays(found[at]) if at in found else _no_cells() for at in range(4)]
        self.springs = Springs(LinkArrays(*links_), *(CellArrays(*parts) for parts in cells_))
        self._found, self._pattern = found, pattern
        self._others = [family for place, family in found.items() if place < 0]

    def force(self, u: np.ndarray) -> tuple[float, np.ndarray]:
        """Return the energy [J] and the internal force."""
        energy, internal = force(np.ascontiguousarray(u), self.springs)
        for family in self._others:
            family.add_force(u, internal)
        return energy, internal

    def advance(
        self, u: np.ndarray, step: np.ndarray, predict: bool
    ) -> tuple[np.ndarray, float, np.ndarray, Stresses]:
        """Return where a step leads, how far at most [m], the internal force there, and the stresses that the
        linearisation at u predicts there, none unless asked to `predict`."""
        after, length, internal, stresses = advance(
            np.ascontiguousarray(u), np.ascontiguousarray(step), predict, self.springs
        )
        for family in self._others:
            family.add_force(after, internal)
        return after, length, internal, stresses

    def extrapolated(self, u: np.ndarray, step: np.ndarray) -> Stresses:
        """Return the stresses that the linearisation at u predicts after `step`."""
        return self.advance(u, step, True)[3]

    def nonnegative_parts(self, u: np.ndarray) -> Stresses:
        """Return the stresses less what could make the tangent indefinite."""
        return self.arranged(family.nonnegative_part(u) for family in self._found.values())

    def arranged(self, stresses: Iterable[np.ndarray]) -> Stresses:
        """Return the stresses of the families, in turn, as `Springs`."""
        found = dict(zip(self._found, stresses, strict=True))
        return tuple(found.get(at, none) for at, none in enumerate(NO_STRESSES))

    def tangent(
        self,
        u: np.ndarray,
        stress: Stresses = NO_STRESSES,
        share: float = 1.0,
        scale: float = 1.0,
        inertia: np.ndarray = NO_INERTIA,
    ) -> np.ndarray:
        """Return scale × the blocks (b, 3, 3) [N/m] of the tangent with these stresses, or the share of the
        springs' own where they are empty, and with M + share (D − M); inertia: (n,) [N/m] on the
        diagonal."""
        pattern = self._pattern
        where = Blocks(pattern.blocks, pattern.mirror, pattern.diagonal)
        blocks: np.ndarray = tangent(
            np.ascontiguousarray(u), stress, share, scale, inertia, self.springs, where
        )
        for family in self._others:
            apart = np.zeros_like(blocks)
            family.add_tangent(u, NO_STRESSES[0], apart)
            blocks += scale * apart
        return blocks


def _place(family: Family) -> int:
    """Which of the families in `Springs` it is; −1 if none."""
    if isinstance(family, Cells):
        return 3 if family.upright else 1 if family.nodes.shape[2] == 1 else 2
    return 0 if family.conservative else -1


def _arrays(family: Family) -> tuple[Any, ...]:
    return tuple([type(p)(*p) if isinstance(p, tuple) else np.ascontiguousarray(p) for p in family.arrays])


@cache
def _no_cells() -> tuple[Any, ...]:
    nodes, slots = np.empty((0, 4, 1), int), np.empty((0, 4, 4), np.int32)
    return nodes, np.empty((0, 2, 3)), np.empty(0), AreaAndStrains(np.empty((0, 4))), slots


@njit(cache=True, nogil=True)
def force(u: np.ndarray, springs: Springs) -> tuple[float, np.ndarray]:
    """Return the energy [J] and the internal force (n, 3) [N]."""
    out = np.zeros_like(u)
    energy = links.add_forces(u, springs.links, out)
    energy += cells.add_forces(u, springs.layers, out)
    energy += cells.add_forces(u, springs.middle, out)
    energy += cells.add_forces(u, springs.faces, out)
    return energy, out


@njit(cache=True, nogil=True)
def advance(
    u: np.ndarray, step: np.ndarray, predict: bool, springs: Springs
) -> tuple[np.ndarray, float, np.ndarray, Stresses]:
    """Return where a step (n, 3) [m] leads, how far at most [m], the internal force (n, 3) [N] there, and the
    stresses that the linearisation at u predicts there, none unless asked to `predict`."""
    after, length = np.empty_like(u), 0.0
    for i in range(len(u)):
        for q in range(3):
            after[i, q] = u[i, q] + step[i, q]
            length = max(length, abs(step[i, q]))
    none = np.empty((0, 3))
    stresses: Stresses = np.empty(0), none, none, none
    if predict:
        stresses = (
            links.extrapolated(u, step, springs.links),
            cells.extrapolated(u, step, springs.layers),
            cells.extrapolated(u, step, springs.middle),
            cells.extrapolated(u, step, springs.faces),
        )
    return after, length, force(after, springs)[1], stresses


@njit(cache=True, nogil=True)
def tangent(
    u: np.ndarray,
    stress: Stresses,
    share: float,
    scale: float,
    inertia: np.ndarray,
    springs: Springs,
    where: Blocks,
) -> np.ndarray:
    """Return scale × blocks (b, 3, 3) [N/m] of the tangent with these stresses, or the share of the
    springs' own where they are empty, and with M + share (D − M), and on the diagonal `inertia` (n,) [N/m].
    It is symmetric: what is above the diagonal is copied."""
    blocks = np.zeros((where.total, 3, 3))
    links.add_tangent(u, springs.links, stress[0], share, NUMBA_TRUE, blocks)
    cells.add_tangent(u, springs.layers, stress[1], share, NUMBA_TRUE, blocks)
    cells.add_tangent(u, springs.middle, stress[2], share, NUMBA_TRUE, blocks)
    cells.add_tangent(u, springs.faces, stress[3], share, NUMBA_TRUE, blocks)
    if scale != 1.0:
        entries = blocks.ravel()
        for e in range(len(entries)):
            entries[e] *= scale
    for i in range(len(inertia)):
        for q in range(3):
            blocks[where.diagonal[i], q, q] += inertia[i]
    for k in range(len(where.mirror)):
        below, above = blocks[np.uint64(where.mirror[k, 0])], blocks[np.uint64(where.mirror[k, 1])]
        for q in range(3):
            for r in range(3):
                above[q, r] = below[r, q]
    return blocks
