"""All families of central springs in one compiled call: energy and force, stresses, tangent.

A call from Python costs microseconds, as much as a small lattice's springs do; so statics make one call, not
one a family. Its arrays always are of the same kinds, empty where a lattice has no such springs: links, then
two families of area springs and two of strain springs, as the layers and the mid-surface may have. The loops
themselves are each family's own; here they release the interpreter's lock.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache
from typing import NamedTuple

import numpy as np
from numba import njit

from lumped.springs import areas, links, strains
from lumped.springs.families import AreaSprings, Links, StrainSprings
from lumped.springs.family import Family


class LinkArrays(NamedTuple):
    """Arrays of `lumped.springs.links`."""

    nodes: np.ndarray
    offset: np.ndarray
    rest_length: np.ndarray
    stiffness: np.ndarray
    slots: np.ndarray


class CellArrays(NamedTuple):
    """Arrays of `lumped.springs.areas` or `lumped.springs.strains`."""

    nodes: np.ndarray
    diagonals: np.ndarray
    stiffness: np.ndarray
    slots: np.ndarray


class Springs(NamedTuple):
    """The springs of a lattice."""

    links: LinkArrays
    layers_area: CellArrays
    middle_area: CellArrays
    layers_strain: CellArrays
    middle_strain: CellArrays


Stresses = tuple[np.ndarray, ...]  # five, as `Springs`
KINDS: tuple[type[Family], ...] = (Links, AreaSprings, AreaSprings, StrainSprings, StrainSprings)


class Together:
    """Families of springs evaluated together. Displacements and forces are (n, 3) [m], [N]; stresses those of
    each family, in turn."""

    def __init__(self, families: Sequence[Family], places: Sequence[int]):
        found = dict(zip(places, families, strict=True))
        links_, *cells = [_arrays(found[at]) if at in found else _empty(k) for at, k in enumerate(KINDS)]
        self.springs = Springs(LinkArrays(*links_), *(CellArrays(*parts) for parts in cells))
        self._places = places
        self._none = [_empty(kind)[2] for kind in KINDS]

    def force(self, u: np.ndarray) -> tuple[float, np.ndarray]:
        """Energy [J] and internal force."""
        energy, internal = force(np.ascontiguousarray(u), self.springs)
        return energy, internal

    def stresses(self, u: np.ndarray) -> Stresses:
        """Stresses at u."""
        return self.of_families(stresses(np.ascontiguousarray(u), self.springs))

    def extrapolated(self, u: np.ndarray, step: np.ndarray) -> Stresses:
        """Stresses that the linearisation at u predicts after `step`."""
        return self.of_families(
            extrapolated(np.ascontiguousarray(u), np.ascontiguousarray(step), self.springs)
        )

    def tangent(self, u: np.ndarray, stress: Stresses, count: int) -> np.ndarray:
        """Blocks (count, 3, 3) [N/m] of the tangent with these stresses."""
        blocks: np.ndarray = tangent(np.ascontiguousarray(u), self.springs, self.every(stress), count)
        return blocks

    def every(self, stress: Stresses) -> Stresses:
        """The families' stresses, and those of none where there is no such family."""
        every = list(self._none)
        for at, values in zip(self._places, stress, strict=True):
            every[at] = values
        return tuple(every)

    def of_families(self, every: Stresses) -> Stresses:
        """The families' own again."""
        return tuple(every[at] for at in self._places)


def together(families: Sequence[Family]) -> Together | None:
    """Families evaluated together; None where one is of another kind."""
    places: list[int] = []
    for family in families:
        free = [at for at, kind in enumerate(KINDS) if type(family) is kind and at not in places]
        if not free:
            return None
        places.append(free[0])
    return Together(families, places) if 0 in places else None


def _arrays(family: Family) -> tuple[np.ndarray, ...]:
    parts = family.nodes, *family.geometry, family.stiffness, family.slots
    return tuple([np.ascontiguousarray(part) for part in parts])


@cache
def _empty(kind: type[Family]) -> tuple[np.ndarray, ...]:
    stiffness = np.empty((0, 3)) if kind is StrainSprings else np.empty(0)
    return np.empty((0, 4, 1), int), np.empty((0, 2, 3)), stiffness, np.empty((0, 4, 4), np.int32)


@njit(cache=True, nogil=True)
def force(u: np.ndarray, springs: Springs) -> tuple[float, np.ndarray]:
    """Energy [J] and internal force (n, 3) [N]."""
    out = np.zeros_like(u)
    s = springs.links
    energy = links.add_forces(u, s.nodes, s.offset, s.rest_length, s.stiffness, out)
    for c in (springs.layers_area, springs.middle_area):
        energy += areas.add_forces(u, c.nodes, c.diagonals, c.stiffness, out)
    for c in (springs.layers_strain, springs.middle_strain):
        energy += strains.add_forces(u, c.nodes, c.diagonals, c.stiffness, out)
    return energy, out


@njit(cache=True, nogil=True)
def stresses(u: np.ndarray, springs: Springs) -> Stresses:
    """Stresses at u."""
    s, a, b = springs.links, springs.layers_area, springs.middle_area
    c, d = springs.layers_strain, springs.middle_strain
    return (
        links.stresses(u, s.nodes, s.offset, s.rest_length, s.stiffness),
        areas.stresses(u, a.nodes, a.diagonals, a.stiffness),
        areas.stresses(u, b.nodes, b.diagonals, b.stiffness),
        strains.stresses(u, c.nodes, c.diagonals, c.stiffness),
        strains.stresses(u, d.nodes, d.diagonals, d.stiffness),
    )


@njit(cache=True, nogil=True)
def extrapolated(u: np.ndarray, step: np.ndarray, springs: Springs) -> Stresses:
    """Stresses that the linearisation at u predicts after `step`."""
    s, a, b = springs.links, springs.layers_area, springs.middle_area
    c, d = springs.layers_strain, springs.middle_strain
    return (
        links.extrapolated(u, step, s.nodes, s.offset, s.rest_length, s.stiffness),
        areas.extrapolated(u, step, a.nodes, a.diagonals, a.stiffness),
        areas.extrapolated(u, step, b.nodes, b.diagonals, b.stiffness),
        strains.extrapolated(u, step, c.nodes, c.diagonals, c.stiffness),
        strains.extrapolated(u, step, d.nodes, d.diagonals, d.stiffness),
    )


@njit(cache=True, nogil=True)
def tangent(u: np.ndarray, springs: Springs, stress: Stresses, count: int) -> np.ndarray:
    """Blocks (count, 3, 3) [N/m] of the tangent with these stresses."""
    blocks = np.zeros((count, 3, 3))
    add_tangent(u, springs, stress, blocks)
    return blocks


@njit(cache=True, nogil=True)
def add_tangent(u: np.ndarray, springs: Springs, stress: Stresses, blocks: np.ndarray) -> None:
    """Add the tangent with these stresses to blocks (count, 3, 3) [N/m]."""
    s = springs.links
    links.add_tangent(u, s.nodes, s.offset, s.rest_length, s.stiffness, stress[0], s.slots, blocks)
    c = springs.layers_area
    areas.add_tangent(u, c.nodes, c.diagonals, c.stiffness, stress[1], c.slots, blocks)
    c = springs.middle_area
    areas.add_tangent(u, c.nodes, c.diagonals, c.stiffness, stress[2], c.slots, blocks)
    c = springs.layers_strain
    strains.add_tangent(u, c.nodes, c.diagonals, c.stiffness, stress[3], c.slots, blocks)
    c = springs.middle_strain
    strains.add_tangent(u, c.nodes, c.diagonals, c.stiffness, stress[4], c.slots, blocks)


@njit(cache=True, nogil=True)
def own_tangent(u: np.ndarray, springs: Springs, share: float, count: int) -> np.ndarray:
    """Blocks (count, 3, 3) [N/m] of the tangent with this share of the stresses at u."""
    blocks = np.zeros((count, 3, 3))
    s = springs.links
    links.add_own_tangent(u, s.nodes, s.offset, s.rest_length, s.stiffness, share, s.slots, blocks)
    for c in (springs.layers_area, springs.middle_area):
        areas.add_own_tangent(u, c.nodes, c.diagonals, c.stiffness, share, c.slots, blocks)
    for c in (springs.layers_strain, springs.middle_strain):
        strains.add_own_tangent(u, c.nodes, c.diagonals, c.stiffness, share, c.slots, blocks)
    return blocks
