"""The springs of a sheet with a natural strain e0 and curvature k0: what each measures where it is at rest.

At the height z over the mid-surface the sheet has the stretch U(z) = 1 + e0 − z k0 where nothing holds it. A
link along d in the plane, whose ends are at the heights z₁ and z₂, and the sides a, b of a cell then have

    g₀ = (z₂ − z₁)² + (U(z₁) d)·(U(z₂) d),     g₀ = (|U a|², |U b|², U a · U b)

in place of what they measure on the flat sheet; columns and upright faces keep what they have. Of links
across the layers that is the diagonal of an isosceles trapezoid: exact, so that a cylinder of any curvature
k0 is a state without energy, its masses on a circle of 1/k0 and its cells turned by 2 asin(l k0/2) each. A
cell that several parts share has the mean of their e0 and k0, a link between cells the mean of their g₀.

The springs' laws see δg − δg₀ for δg and g₀ for g at rest, so that no digits are lost; springs of cells
resist strains of their natural sides. Derived here.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np

from lumped.lattice import Lattice
from lumped.springs.cell_laws import AREA_AND_STRAINS, NATURAL
from lumped.springs.families import DirectionalLinks, Family, Links, SpringCells
from lumped.springs.laws import of_stiffness
from sheetbench.errors import BadInput
from sheetbench.scenes.meaning.natural_state import NaturalState

Maker = Callable[[np.ndarray, np.ndarray], Family]  # of strains and curvatures of cells (rows, columns, 2, 2)


def with_natural(
    lattice: Lattice, families: Sequence[Family], state: NaturalState
) -> Callable[[np.ndarray, np.ndarray], list[Family]]:
    """Return what makes the families of a sheet that is not flat at rest, of its cells' strain and curvature.
    Raises BadInput for springs of a per-direction law."""

    def maker(family: Family) -> Maker:
        if isinstance(family, DirectionalLinks):
            raise BadInput("natural: springs of unequal stiffness along x, y and z have no natural length")
        if isinstance(family, Links):
            return _links(lattice, family)
        if isinstance(family, SpringCells) and family.law is AREA_AND_STRAINS and not family.upright:
            return _cells(lattice, family, state)
        return lambda strain, curvature: family

    makers = [maker(family) for family in families]
    return lambda *forms: [make(*forms) for make in makers]


def _links(lattice: Lattice, links: Links) -> Maker:
    cells, shares = (  # that each lies in or between (m, 4), and of their means
        np.concatenate([np.pad(part, ((0, 0), (0, 4 - part.shape[1]))) for part in parts])
        for parts in zip(*((f.cells, f.shares) for f in lattice.links), strict=True)
    )
    every, own = (n[:, 0] * lattice.mass_count + n[:, 1] for n in (lattice.joined[0], links.nodes))
    order = np.argsort(every)
    place = order[np.searchsorted(every[order], own)]
    cells, shares = cells[place], shares[place] / shares[place].sum(axis=1, keepdims=True)
    along, rest = links.offset[:, None, :2], (links.offset**2).sum(axis=1)
    heights = lattice.positions[links.nodes, 2]

    def make(strain: np.ndarray, curvature: np.ndarray) -> Family:
        e, k = (form.reshape(-1, 2, 2)[cells] for form in (strain, curvature))
        moved = [np.einsum("mqij,mkj->mqi", e - z[:, None, None, None] * k, along) for z in heights.T]
        change = (shares * _change(along, along, *moved)).sum(axis=1)
        natural = np.stack([np.sqrt(rest + change), change])
        return replace(links, rest_length=natural[0], natural=natural)

    return make


def _cells(lattice: Lattice, cells: SpringCells, state: NaturalState) -> Maker:
    """Of the layers or of the mid-surface."""
    kept = np.arange(lattice.cell_areas.size)[lattice.kept]
    plan = np.tile(kept, len(cells) // len(kept))
    heights = lattice.positions[cells.nodes, 2].mean(axis=(1, 2))[:, None, None]
    flat = cells.sides[:, :, :2]

    def changes(strain: np.ndarray, curvature: np.ndarray, at: np.ndarray) -> np.ndarray:
        e, k = (form.reshape(-1, 2, 2)[plan] for form in (strain, curvature))
        return np.asarray(flat @ (e - at * k))

    strain, curvature = state.at()
    sides = flat + changes(strain, curvature, np.zeros((1, 1, 1)))
    area = np.abs(np.linalg.det(sides))
    springs = of_stiffness(cells.stiffness, np.pad(sides, ((0, 0), (0, 0), (0, 1))), area)

    def make(strain: np.ndarray, curvature: np.ndarray) -> Family:
        moved, natural = changes(strain, curvature, heights), np.empty((len(cells), 11))
        natural[:, :7] = springs
        for column, (s, t) in enumerate(((0, 0), (1, 1), (0, 1)), start=7):
            natural[:, column] = _change(flat[:, s], flat[:, t], moved[:, s], moved[:, t])
        natural[:, 10] = np.abs(np.linalg.det(flat + moved))
        return replace(cells, law=NATURAL, natural=natural)

    return make


def _change(a: np.ndarray, b: np.ndarray, moved_a: np.ndarray, moved_b: np.ndarray) -> np.ndarray:
    """Change of a · b of sides that have moved by so much."""
    return np.asarray((a * moved_b + b * moved_a + moved_a * moved_b).sum(axis=-1))
