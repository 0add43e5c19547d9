"""The springs of a sheet with a natural strain e0 and curvature k0: what each measures where it is at rest.

At the height z over the mid-surface the sheet has the stretch U(z) = 1 + e0 − z k0 where nothing holds it. A
link along d in the plane, whose ends are at the heights z₁ and z₂, and the sides a, b of a cell then have

    g₀ = (z₂ − z₁)² + (U(z₁) d)·(U(z₂) d),     g₀ = (|U a|², |U b|², U a · U b)

in place of what they measure on the flat sheet; columns and upright faces keep what they have. Of links
across the layers that is the diagonal of an isosceles trapezoid, diagonal² = leg² + the product of the
parallel sides: exact, not of first order, so that a cylinder of any curvature k0 is a state without energy,
its masses on a circle of exactly 1/k0 and its cells turned by 2 asin(l k0/2) each: the error of an arc is
(l k0)²/24 of it. A cell that several parts share has the mean of their e0 and k0, a link between cells the
mean of their g₀.

The springs' laws see δg − δg₀ for δg and g₀ for g at rest, so that no digits are lost; springs of cells
resist strains of their natural sides. Derived here.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from lumped.lattice import Lattice
from lumped.springs.cell_laws import AREA_AND_STRAINS, NATURAL
from lumped.springs.families import DirectionalLinks, Family, Links, SpringCells
from lumped.springs.laws import of_stiffness
from sheetbench.errors import BadInput
from sheetbench.scenes.meaning.natural_state import NaturalState


class NaturalSprings:
    """Springs of a lattice at a share of its cells' natural state, which `grow` sets in the families' arrays.

    families: in the order of those that are given, of a sheet that is flat at rest; state: of the cells that
    there are and are not, (rows, columns). Raises BadInput for springs of a per-direction law.
    """

    def __init__(self, lattice: Lattice, families: Sequence[Family], state: NaturalState):
        self.state, self._factors = state, np.array([np.nan])
        self._springs: list[_NaturalLinks | _NaturalCells] = []
        self.families = [self._natural(lattice, family) for family in families]
        self.grow()

    def _natural(self, lattice: Lattice, family: Family) -> Family:
        if isinstance(family, DirectionalLinks):
            raise BadInput("natural: springs of unequal stiffness along x, y and z have no natural length")
        if isinstance(family, Links):
            links = _NaturalLinks(lattice, family)
            self._springs.append(links)
            return links.family
        if isinstance(family, SpringCells) and family.law is AREA_AND_STRAINS and not family.upright:
            cells = _NaturalCells(lattice, family, self.state)
            self._springs.append(cells)
            return cells.family
        return family

    def grow(self, share: float = 1.0, time: float | None = None) -> None:
        """Set the springs to a share of the natural state at a time [s], without one the last."""
        self.set(share * self.state.factors(time))

    def set(self, factors: np.ndarray) -> None:
        """Set the springs to so many times what each source of the natural state has."""
        if np.array_equal(factors, self._factors):
            return
        self._factors = factors
        strain, curvature = (form.reshape(-1, 2, 2) for form in self.state.at(factors))
        for springs in self._springs:
            springs.set(strain, curvature)


class _NaturalLinks:
    """Links, the cells that each lies in or between (m, 4) and the shares of their means (m, 4)."""

    def __init__(self, lattice: Lattice, links: Links):
        cells, shares = (
            np.concatenate([np.pad(part, ((0, 0), (0, 4 - part.shape[1]))) for part in parts])
            for parts in zip(*((f.cells, f.shares) for f in lattice.links), strict=True)
        )
        every, own = (
            nodes[:, 0] * lattice.mass_count + nodes[:, 1] for nodes in (lattice.joined[0], links.nodes)
        )
        order = np.argsort(every)
        place = order[np.searchsorted(every[order], own)]
        self._cells, self._shares = cells[place], shares[place] / shares[place].sum(axis=1, keepdims=True)
        self._along, self._rest = links.offset[:, :2], (links.offset**2).sum(axis=1)
        self._heights = lattice.positions[links.nodes, 2]
        self._natural = np.zeros((2, len(links)))
        self.family = replace(links, rest_length=self._natural[0], natural=self._natural)

    def set(self, strain: np.ndarray, curvature: np.ndarray) -> None:
        """Set lengths and δg₀ of cells' strains and curvatures (c, 2, 2)."""
        stretched = np.einsum("mqij,mj->mqi", strain[self._cells], self._along)
        bent = np.einsum("mqij,mj->mqi", curvature[self._cells], self._along)
        first, second = (stretched - self._heights[:, end, None, None] * bent for end in (0, 1))
        change = np.einsum("mqi,mi->mq", first + second, self._along) + (first * second).sum(axis=2)
        self._natural[1] = (self._shares * change).sum(axis=1)
        self._natural[0] = np.sqrt(self._rest + self._natural[1])


class _NaturalCells:
    """Cells of the layers or of the mid-surface, and the number of the plan cell of each (m,)."""

    def __init__(self, lattice: Lattice, cells: SpringCells, state: NaturalState):
        kept = np.arange(lattice.cell_areas.size)[lattice.kept]
        self._plan = np.tile(kept, len(cells) // len(kept))
        self._heights = lattice.positions[cells.nodes, 2].mean(axis=(1, 2))[:, None]
        self._sides = cells.sides[:, :, :2]
        grown, _ = (form.reshape(-1, 2, 2)[self._plan] for form in state.at(state.factors()))
        sides = cells.sides.copy()
        sides[:, :, :2] += np.einsum("mij,msj->msi", grown, self._sides)
        area = np.linalg.norm(np.cross(sides[:, 0], sides[:, 1]), axis=1)
        springs = of_stiffness(cells.stiffness, sides, area)
        self._natural = np.column_stack([springs, np.zeros((len(cells), 4))])
        self.family = replace(cells, law=NATURAL, natural=self._natural)

    def set(self, strain: np.ndarray, curvature: np.ndarray) -> None:
        """Set δg₀ and areas of cells' strains and curvatures (c, 2, 2)."""
        (a, b), of = self._sides.swapaxes(0, 1), self._plan
        moved = [
            np.einsum("mij,mj->mi", strain[of], side)
            - self._heights * np.einsum("mij,mj->mi", curvature[of], side)
            for side in (a, b)
        ]
        pairs = ((a, b), moved)
        for column, (s, t) in enumerate(((0, 0), (1, 1), (0, 1)), start=7):
            (x, y), (dx, dy) = ((of_sides[s], of_sides[t]) for of_sides in pairs)
            self._natural[:, column] = (x * dy + dx * y + dx * dy).sum(axis=1)
        a, b = a + moved[0], b + moved[1]
        self._natural[:, 10] = np.abs(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0])
