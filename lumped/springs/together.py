"""All families of central springs in one compiled call: energy and force, stresses, tangent.

A call from Python costs microseconds, as much as a small lattice's springs do; so statics make one call, not
one a family. Its arrays always are of the same kinds, empty where a lattice has no such springs: links, the
layers' cells, the mid-surface's cells. The loops themselves are each family's own; here they release the
interpreter's lock.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache
from typing import NamedTuple

import numpy as np
from numba import njit

from lumped.springs import cells, links
from lumped.springs.families import Cells, Links
from lumped.springs.family import Family


class LinkArrays(NamedTuple):
    """Arrays of `lumped.springs.links`."""

    nodes: np.ndarray
    offset: np.ndarray
    rest_length: np.ndarray
    constants: np.ndarray
    slots: np.ndarray


class CellArrays(NamedTuple):
    """Arrays of `lumped.springs.cells`."""

    nodes: np.ndarray
    sides: np.ndarray
    area: np.ndarray
    constants: np.ndarray
    slots: np.ndarray


class Springs(NamedTuple):
    """The springs of a lattice."""

    links: LinkArrays
    layers: CellArrays
    middle: CellArrays


Stresses = tuple[np.ndarray, ...]  # three, as `Springs`
KINDS: tuple[type[Family], ...] = (Links, Cells, Cells)


class Together:
    """Families of springs evaluated together. Displacements and forces are (n, 3) [m], [N]; stresses those of
    each family, in turn."""

    def __init__(self, families: Sequence[Family], places: Sequence[int]):
        found = dict(zip(places, families, strict=True))
        links_, *cells_ = [_arrays(found[at]) if at in found else _empty(k) for at, k in enumerate(KINDS)]
        self.springs = Springs(LinkArrays(*links_), *(CellArrays(*parts) for parts in cells_))
        self._places = places
        self._none = [kind.no_stress for kind in KINDS]

    def force(self, u: np.ndarray) -> tuple[float, np.ndarray]:
        """Return the energy [J] and the internal force."""
        energy, internal = force(np.ascontiguousarray(u), self.springs)
        return energy, internal

    def stresses(self, u: np.ndarray) -> Stresses:
        """Return the stresses at u."""
        return self.of_families(stresses(np.ascontiguousarray(u), self.springs))

    def extrapolated(self, u: np.ndarray, step: np.ndarray) -> Stresses:
        """Return the stresses that the linearisation at u predicts after `step`."""
        return self.of_families(
            extrapolated(np.ascontiguousarray(u), np.ascontiguousarray(step), self.springs)
        )

    def tangent(self, u: np.ndarray, stress: Stresses, count: int, share: float = 1.0) -> np.ndarray:
        """Return blocks (count, 3, 3) [N/m] of the tangent with these stresses, or the share of the springs'
        own where they are empty, and with M + share (D − M)."""
        blocks: np.ndarray = tangent(np.ascontiguousarray(u), self.springs, self.every(stress), share, count)
        return blocks

    def every(self, stress: Stresses) -> Stresses:
        """Return the families' stresses, and those of none where there is no such family."""
        every = list(self._none)
        for at, values in zip(self._places, stress, strict=True):
            every[at] = values
        return tuple(every)

    def of_families(self, every: Stresses) -> Stresses:
        """Return the families' own again."""
        return tuple(every[at] for at in self._places)


def together(families: Sequence[Family]) -> Together | None:
    """Return families evaluated together; None where one is of another kind."""
    places: list[int] = []
    for family in families:
        free = [at for at, kind in enumerate(KINDS) if type(family) is kind and at not in places]
        if not free:
            return None
        places.append(free[0])
    return Together(families, places) if 0 in places else None


def _arrays(family: Family) -> tuple[np.ndarray, ...]:
    return tuple([np.ascontiguousarray(part) for part in (*family.arrays, family.slots)])


@cache
def _empty(kind: type[Family]) -> tuple[np.ndarray, ...]:
    nodes, slots = np.empty((0, 4, 1), int), np.empty((0, 4, 4), np.int32)
    return nodes, np.empty((0, 2, 3)), np.empty(0), np.empty((0, 4)), slots


@njit(cache=True, nogil=True)
def force(u: np.ndarray, springs: Springs) -> tuple[float, np.ndarray]:
    """Return the energy [J] and the internal force (n, 3) [N]."""
    out = np.zeros_like(u)
    s = springs.links
    energy = links.add_forces(u, s.nodes, s.offset, s.rest_length, s.constants, out)
    for c in (springs.layers, springs.middle):
        energy += cells.add_forces(u, c.nodes, c.sides, c.area, c.constants, out)
    return energy, out


@njit(cache=True, nogil=True)
def stresses(u: np.ndarray, springs: Springs) -> Stresses:
    """Return the stresses at u."""
    s, a, b = springs.links, springs.layers, springs.middle
    return (
        links.stresses(u, s.nodes, s.offset, s.rest_length, s.constants),
        cells.stresses(u, a.nodes, a.sides, a.area, a.constants),
        cells.stresses(u, b.nodes, b.sides, b.area, b.constants),
    )


@njit(cache=True, nogil=True)
def extrapolated(u: np.ndarray, step: np.ndarray, springs: Springs) -> Stresses:
    """Return the stresses that the linearisation at u predicts after `step`."""
    s, a, b = springs.links, springs.layers, springs.middle
    return (
        links.extrapolated(u, step, s.nodes, s.offset, s.rest_length, s.constants),
        cells.extrapolated(u, step, a.nodes, a.sides, a.area, a.constants),
        cells.extrapolated(u, step, b.nodes, b.sides, b.area, b.constants),
    )


@njit(cache=True, nogil=True)
def tangent(u: np.ndarray, springs: Springs, stress: Stresses, share: float, count: int) -> np.ndarray:
    """Return blocks (count, 3, 3) [N/m] of the tangent (`add_tangent`)."""
    blocks = np.zeros((count, 3, 3))
    add_tangent(u, springs, stress, share, blocks)
    return blocks


@njit(cache=True, nogil=True)
def add_tangent(u: np.ndarray, springs: Springs, stress: Stresses, share: float, blocks: np.ndarray) -> None:
    """Add the tangent with these stresses, or the share of the springs' own where they are empty, and with
    M + share (D − M), to blocks (count, 3, 3) [N/m]."""
    s, a, b = springs.links, springs.layers, springs.middle
    links.add_tangent(u, s.nodes, s.offset, s.rest_length, s.constants, stress[0], share, s.slots, blocks)
    cells.add_tangent(u, a.nodes, a.sides, a.area, a.constants, stress[1], share, a.slots, blocks)
    cells.add_tangent(u, b.nodes, b.sides, b.area, b.constants, stress[2], share, b.slots, blocks)


@njit(cache=True, nogil=True)
def own_tangent(u: np.ndarray, springs: Springs, share: float, count: int) -> np.ndarray:
    """Return blocks (count, 3, 3) [N/m] of the tangent with this share of the springs' stresses at u."""
    return tangent(u, springs, (np.empty(0), np.empty((0, 3)), np.empty((0, 3))), share, count)
