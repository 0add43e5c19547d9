"""All families of springs with an energy in one compiled call: energy and force, stresses, tangent.

A call from Python costs microseconds, as much as a small lattice's springs do; so statics make one call, not
one a family. Its arrays always are of the same kinds, empty where a lattice has no such springs: links, the
layers' cells, the mid-surface's cells, upright faces. The loops themselves are each family's own; here they
release the interpreter's lock.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache
from typing import Any, NamedTuple

import numpy as np
from numba import njit

from lumped.pattern import Pattern
from lumped.springs import cells, links
from lumped.springs.cell_laws import AreaAndStrains
from lumped.springs.cells import CellArrays
from lumped.springs.families import Cells, Links
from lumped.springs.family import Family
from lumped.springs.links import LinkArrays
from lumped.springs.tiles import NUMBA_TRUE


class Springs(NamedTuple):
    """The springs of a lattice."""

    links: LinkArrays
    layers: CellArrays
    middle: CellArrays
    faces: CellArrays


Stresses = tuple[np.ndarray, ...]  # four, as `Springs`, where there is a table of those
NO_STRESSES: Stresses = (np.empty(0), *3 * (np.empty((0, 3)),))


class AllFamilies:
    """Families of springs in one call. Displacements and forces are (n, 3) [m], [N]; stresses those of
    each family, in turn."""

    def __init__(self, families: Sequence[Family], places: Sequence[int]):
        found = dict(zip(places, families, strict=True))
        links_, *cells_ = [_arrays(found[at]) if at in found else _no_cells() for at in range(4)]
        self.springs = Springs(LinkArrays(*links_), *(CellArrays(*parts) for parts in cells_))
        self._places = places

    def force(self, u: np.ndarray) -> tuple[float, np.ndarray]:
        """Return the energy [J] and the internal force."""
        energy, internal = force(np.ascontiguousarray(u), self.springs)
        return energy, internal

    def extrapolated(self, u: np.ndarray, step: np.ndarray) -> Stresses:
        """Return the stresses that the linearisation at u predicts after `step`, as `Springs`."""
        predicted: Stresses = extrapolated(np.ascontiguousarray(u), np.ascontiguousarray(step), self.springs)
        return predicted

    def tangent(self, u: np.ndarray, stress: Stresses, pattern: Pattern, share: float = 1.0) -> np.ndarray:
        """Return blocks (b, 3, 3) [N/m] of the tangent with these stresses, or the share of the springs' own
        where they are empty, and with M + share (D − M)."""
        place = pattern.blocks, pattern.mirror
        blocks: np.ndarray = tangent(np.ascontiguousarray(u), self.springs, stress, share, *place)
        return blocks

    def every(self, stress: Stresses) -> Stresses:
        """Return the families' stresses, and those of none where there is no such family."""
        every = list(NO_STRESSES)
        for at, values in zip(self._places, stress, strict=True):
            every[at] = values
        return tuple(every)


def all_families(families: Sequence[Family]) -> AllFamilies | None:
    """Return families in one call; None where one is of another kind."""
    places = [_place(family) for family in families]
    each_once = 0 in places and -1 not in places and len(set(places)) == len(places)
    return AllFamilies(families, places) if each_once else None


def _place(family: Family) -> int:
    """Which of the families in `Springs` it is; −1 if none."""
    if isinstance(family, Cells):
        return 3 if family.upright else 1 if family.nodes.shape[2] == 1 else 2
    return 0 if type(family) is Links else -1


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
def extrapolated(u: np.ndarray, step: np.ndarray, springs: Springs) -> Stresses:
    """Return the stresses that the linearisation at u predicts after `step`."""
    return (
        links.extrapolated(u, step, springs.links),
        cells.extrapolated(u, step, springs.layers),
        cells.extrapolated(u, step, springs.middle),
        cells.extrapolated(u, step, springs.faces),
    )


@njit(cache=True, nogil=True)
def tangent(
    u: np.ndarray, springs: Springs, stress: Stresses, share: float, count: int, mirror: np.ndarray
) -> np.ndarray:
    """Return blocks (count, 3, 3) [N/m] of the tangent with these stresses, or the share of the springs' own
    where they are empty, and with M + share (D − M). It is symmetric: what is above the diagonal is copied,
    mirror (k, 2) `Pattern.mirror`."""
    blocks = np.zeros((count, 3, 3))
    links.add_tangent(u, springs.links, stress[0], share, NUMBA_TRUE, blocks)
    cells.add_tangent(u, springs.layers, stress[1], share, NUMBA_TRUE, blocks)
    cells.add_tangent(u, springs.middle, stress[2], share, NUMBA_TRUE, blocks)
    cells.add_tangent(u, springs.faces, stress[3], share, NUMBA_TRUE, blocks)
    copy_above(blocks, mirror)
    return blocks


@njit(cache=True, nogil=True)
def copy_above(blocks: np.ndarray, mirror: np.ndarray) -> None:
    """Copy the blocks below the diagonal to those above it, mirror (k, 2) `Pattern.mirror`."""
    for k in range(len(mirror)):
        below, above = blocks[np.uint64(mirror[k, 0])], blocks[np.uint64(mirror[k, 1])]
        for q in range(3):
            for r in range(3):
                above[q, r] = below[r, q]
