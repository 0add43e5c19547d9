"""The springs of a sheet with a natural strain e0 and curvature k0: their measures g₀ at rest.

A free sheet has the stretch U(z) = 1 + e0 − z k0 at the height z over the mid-surface. A link along d in the
plane, with ends at the heights z₁ and z₂, and a cell with the sides a, b then have

    g₀ = (z₂ − z₁)² + (U(z₁) d)·(U(z₂) d),     g₀ = (|U a|², |U b|², U a · U b)

at rest; columns and upright faces keep their measures of the flat sheet. For links across the layers g₀ is
the diagonal of an isosceles trapezoid: exact, so that a cylinder of any curvature k0 is a state without
energy, its masses on a circle of 1/k0 and its cells turned by 2 asin(l k0/2) each. A cell that several parts
share has the mean of their e0 and k0, a link between cells the mean of their g₀.

The springs' laws take δg − δg₀ for δg and g₀ for g at rest, so that no digits are lost; springs of cells
resist strains of their natural sides. Derived for this project.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from lumped.lattice import Lattice
from lumped.springs.families import DirectionalLinks, Family, Links, SpringCells
from lumped.springs.law_table import AREA_AND_STRAINS
from lumped.springs.laws import of_stiffness
from sheetbench.errors import BadInput
from sheetbench.scenes.meaning.natural_state import NaturalState

XX_YY_XY = np.array([[[1.0, 0.0], [0.0, 0.0]], [[0.0, 0.0], [0.0, 1.0]], [[0.0, 1.0], [1.0, 0.0]]])
COMPONENTS = (0, 0), (1, 1), (0, 1), (1, 0)
# powers of a cell's area and of its sides' squares in the constants of `laws.of_stiffness`
SIZE_POWERS = np.array(
    [[-1, 0, 0], [1, -2, 0], [1, 0, -2], [1, -1, -1], [1, -1, -1], [1, -1.5, -0.5], [1, -0.5, -1.5]]
)


def with_natural(
    lattice: Lattice, families: Sequence[Family], state: NaturalState
) -> Callable[..., list[Family]]:
    """Return a function of the cells' natural strain and curvature that builds the springs of a sheet not
    flat at rest. Raises BadInput for springs of a per-direction law."""
    natural = _natural(lattice, families)
    grown = [springs and replace(springs, stiffness=springs.grown(state.at()[0])) for springs in natural]
    pairs = list(zip(families, grown, strict=True))
    return lambda *forms: [family if springs is None else springs.of(*forms) for family, springs in pairs]


def grown(lattice: Lattice, families: Sequence[Family], strain: np.ndarray) -> list[Family]:
    """Return the springs of the flat sheet with the stiffness of a sheet with a natural strain, (rows,
    columns, 2, 2)."""
    natural = _natural(lattice, families)
    grown = [None if one is None else replace(one.family, stiffness=one.grown(strain)) for one in natural]
    return [one or family for family, one in zip(families, grown, strict=True)]


def powers(
    lattice: Lattice, families: Sequence[Family], state: Sequence[np.ndarray], by: Sequence[np.ndarray]
) -> np.ndarray:
    """Return the derivatives of a power by the cells' natural strain and curvature, xx, yy and xy, (rows,
    columns, 6). families: of a flat sheet; state: both, (rows, columns, 2, 2); by: the derivatives by every
    spring's constants and natural δg₀ in this state."""
    rates = np.zeros((lattice.cell_areas.size, 6))
    for springs, power in zip(_natural(lattice, families), by, strict=True):
        if springs is not None:
            for out, of in zip(rates.T, springs.powers(state, power), strict=True):
                out += np.bincount(springs.cells.ravel(), of.ravel(), len(out))
    return rates.reshape(*lattice.cell_areas.shape, 6)


@dataclass(frozen=True)
class _Natural:
    """Springs of cells with a natural state. sides: the two factors of each product of sides that is
    measured, (2, m, p, 3) [m]; cells, shares: (m, q) of each spring; heights: (m, 2) of its ends [m];
    stiffness: of the grown sheet."""

    family: Links | SpringCells
    sides: np.ndarray
    cells: np.ndarray
    shares: np.ndarray
    heights: np.ndarray
    stiffness: np.ndarray = field(default_factory=lambda: np.empty(0))

    def grown(self, strain: np.ndarray) -> np.ndarray:
        """Return the stiffness relative to the drawn sides, of springs that resist strains relative to the
        natural sides."""
        family = self.family
        if isinstance(family, Links) or not strain.any():
            return family.stiffness
        grown = family.sides.copy()
        grown[..., :2] += family.sides[..., :2] @ strain.reshape(-1, 2, 2)[self.cells[:, 0]]
        natural = of_stiffness(family.stiffness, grown, np.abs(np.linalg.det(grown[..., :2])))
        drawn = of_stiffness(np.ones_like(family.stiffness), family.sides, family.area)
        return np.asarray((natural / drawn)[:, : family.stiffness.shape[1]])

    def _growth(self, *forms: np.ndarray) -> tuple[np.ndarray, list[np.ndarray]]:
        """Return the sides in the plan (2, m, 1, p, 2), and their changes by strain and curvature."""
        plan, ends = self.sides[:, :, None, :, :2], self.heights.T
        if not any(form.any() for form in forms):
            return plan, [0.0 * side for side in plan]
        e, k = (form.reshape(-1, 2, 2)[self.cells] for form in forms)
        stretch = [(e - z[:, None, None, None] * k)[:, :, None] for z in ends]
        # for many matrices of 2 × 2 products of components cost less than matrix products
        pairs = zip(plan, stretch, strict=True)
        return plan, [a[..., :1] * of[..., 0, :] + a[..., 1:] * of[..., 1, :] for a, of in pairs]

    def of(self, *forms: np.ndarray) -> Family:
        """Return the family with √g₀ of links or √det g₀ of cells and δg₀ (1 + p, m)."""
        plan, growth = self._growth(*forms)
        change = (plan * growth[::-1]).sum(axis=0) + growth[0] * growth[1]
        by = np.einsum("mq,mqpi->pm", self.shares, change)
        g = self.sides.prod(axis=0).sum(axis=-1).T + by
        natural = np.stack([np.sqrt(g[0] if len(g) == 1 else g[0] * g[1] - g[2] ** 2), *by])
        if isinstance(self.family, Links):
            return replace(self.family, rest_length=natural[0], natural=natural[1])
        return replace(self.family, stiffness=self.stiffness, natural=natural)

    def powers(self, state: Sequence[np.ndarray], power: np.ndarray) -> np.ndarray:
        """Return the derivatives (6, m, q); see `powers` above."""
        plan, growth = self._growth(*state)
        rates, by = np.zeros((6, *self.cells.shape)), power[:, None, -self.sides.shape[2] :]
        for a, other, other_growth, z in zip(plan, plan[::-1], growth[::-1], self.heights.T, strict=True):
            b = other + other_growth
            xx, yy, xy, yx = ((a[..., i] * b[..., j] * by).sum(axis=-1) for i, j in COMPONENTS)
            for number, of in enumerate((xx, yy, xy + yx)):
                rates[number] += of
                rates[number + 3] -= z[:, None] * of
        rates *= self.shares
        if isinstance(self.family, SpringCells):
            by_constants = self._of_stiffness(state[0])
            rates[:3, :, 0] += np.einsum("cnw,cn->wc", by_constants, power[:, : by_constants.shape[1]])
        return rates

    def _of_stiffness(self, strain: np.ndarray) -> np.ndarray:
        """Return the rates (c, n, 3) of a cell's constants, by the change of its natural sides."""
        drawn = self.family.sides[..., :2]  # type: ignore[union-attr]
        constants = replace(self.family, stiffness=self.grown(strain)).constants  # type: ignore[union-attr]
        sides = drawn + drawn @ strain.reshape(-1, 2, 2)[self.cells[:, 0]]
        change = np.einsum("cij,wjk->wcik", drawn, XX_YY_XY)
        of_area = np.einsum("cki,wcik->cw", np.linalg.inv(sides), change)
        of_sides = 2.0 * np.einsum("cik,wcik->ciw", sides, change) / (sides**2).sum(axis=2)[:, :, None]
        of_size = np.concatenate([of_area[:, None], of_sides], axis=1)
        return np.asarray(constants[:, :, None] * (SIZE_POWERS @ of_size))


def _natural(lattice: Lattice, families: Sequence[Family]) -> list[_Natural | None]:
    """Return the families as springs of cells, or None if a family keeps its measures at rest."""
    return [_of_cells(lattice, family) for family in families]


def _of_cells(lattice: Lattice, family: Family) -> _Natural | None:
    if isinstance(family, DirectionalLinks):
        raise BadInput("natural: springs of unequal stiffness along x, y and z have no natural length")
    if isinstance(family, Links):
        sides = np.stack(2 * [family.offset[:, None]])
        index = lattice.links_of(family.nodes)
        cells, shares = (part[:, index].T for part in (lattice.links.cells, lattice.links.shares))
        shares = shares / shares.sum(axis=1, keepdims=True)
    elif isinstance(family, SpringCells) and family.law is AREA_AND_STRAINS and len(family):
        sides = family.sides[:, [[0, 1, 0], [0, 1, 1]]].swapaxes(0, 1)
        cells = np.arange(lattice.cell_areas.size)[lattice.present_cells]
        cells = np.tile(cells, len(family) // len(cells))[:, None]
        shares = np.ones(cells.shape)
    else:
        return None
    heights = lattice.positions[family.nodes[:, :2], 2].reshape(len(family), 2, -1).mean(axis=2)
    return _Natural(family, sides, cells, shares, heights)
