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
from lumped.springs.families import DirectionalLinks, Family, Links, SpringCells
from lumped.springs.law_table import AREA_AND_STRAINS
from lumped.springs.laws import of_stiffness
from sheetbench.errors import BadInput
from sheetbench.scenes.meaning.natural_state import NaturalState


def with_natural(
    lattice: Lattice, families: Sequence[Family], state: NaturalState
) -> Callable[..., list[Family]]:
    """Return what makes the families of a sheet that is not flat at rest, of its cells' strain and curvature.
    Raises BadInput for springs of a per-direction law."""

    def maker(family: Family) -> Callable[..., Family]:
        if isinstance(family, DirectionalLinks):
            raise BadInput("natural: springs of unequal stiffness along x, y and z have no natural length")
        if isinstance(family, Links):
            sides, stiffness = np.stack(2 * [family.offset[:, None]]), family.stiffness  # (2, m, p, 3)
            grid_links = lattice.links
            every, own = (nodes @ [lattice.mass_count, 1] for nodes in (grid_links.nodes, family.nodes))
            cells, shares = (part[:, np.isin(every, own)].T for part in (grid_links.cells, grid_links.shares))
            shares = shares / shares.sum(axis=1, keepdims=True)
        elif isinstance(family, SpringCells) and family.law is AREA_AND_STRAINS and len(family):
            sides = family.sides[:, [[0, 1, 0], [0, 1, 1]]].swapaxes(0, 1)
            cells = np.arange(lattice.cell_areas.size)[lattice.kept]
            cells = np.tile(cells, len(family) // len(cells))[:, None]
            shares = np.ones(cells.shape)
            grown = family.sides.copy()
            grown[..., :2] += family.sides[..., :2] @ state.at()[0].reshape(-1, 2, 2)[cells[:, 0]]
            natural = of_stiffness(family.stiffness, grown, np.abs(np.linalg.det(grown[..., :2])))
            drawn = of_stiffness(np.ones_like(family.stiffness), family.sides, family.area)
            stiffness = (natural / drawn)[:, : family.stiffness.shape[1]]  # [N/m] for sides as drawn
        else:
            return lambda strain, curvature: family
        flat, plan = sides.prod(axis=0).sum(axis=-1).T, sides[:, :, None, :, :2]  # products (p, m)
        ends = lattice.positions[family.nodes[:, :2], 2].reshape(len(family), 2, -1).mean(axis=2)

        def make(*forms: np.ndarray) -> Family:
            """The family with √g₀ of links or √det g₀ of cells and δg₀ (1 + p, m)."""
            e, k = (form.reshape(-1, 2, 2)[cells] for form in forms)
            moved = [side @ (e - z[:, None, None, None] * k) for side, z in zip(plan, ends.T, strict=True)]
            change = (plan * moved[::-1]).sum(axis=0) + moved[0] * moved[1]
            by = np.einsum("mq,mqpi->pm", shares, change)
            g = flat + by
            natural = np.stack([np.sqrt(g[0] if len(g) == 1 else g[0] * g[1] - g[2] ** 2), *by])
            if isinstance(family, Links):
                return replace(family, rest_length=natural[0], natural=natural[1])
            return replace(family, stiffness=stiffness, natural=natural)

        return make

    makers = [maker(family) for family in families]
    return lambda *forms: [make(*forms) for make in makers]
