"""Stiffness of the sheet's section per width, from its constants, also of cells that several parts share.

    A = E h/(1 − ν²) [[1, ν, 0], [ν, 1, 0], [0, 0, (1 − ν)/2]],    D = A h²/12,    S = κ G h,    κ = 5/6,

and for fibres and layers from `lumped.plies`; layers with B ≠ 0 bend when pulled, N = A ε + B κ and
M = B ε + D κ.

A cell is divided DIVISIONS × DIVISIONS, and at the sides of parts along the axes; each division has the mean
of its parts by area. Across a line between two divisions, e.g. at constant x, N_x, M_x and Q_x are
continuous, and so are the stretch and the curvature along the line and the twist (Kirchhoff's continuity):
divisions in a row along x then have

    C11 = 1/⟨1/C11⟩,   C12 = C11 ⟨C12/C11⟩,   C22 = ⟨C22 − C12²/C11⟩ + C11 ⟨C12/C11⟩²,   C66 = ⟨C66⟩,

C being A or D, and Sx = 1/⟨1/Sx⟩, Sy = ⟨Sy⟩. (A66 would be 1/⟨1/A66⟩; the mean keeps a lattice's layers
together.) So a patch whose sides are along the grid may end anywhere in a cell. The cell's section is the
mean of two sections: rows in series along x, then in series along y; and columns first, then rows.
Source: Kohn and Vogelius, Int. J. Solids Struct. 20 (1984), plates whose thickness varies along one axis.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any, Self

import numpy as np

from lumped import plies
from lumped.coverage import ObliqueRims, clamped_stiffness, oblique_rims, union_of
from lumped.grid_lines import Lines, grid_lines
from sheetbench.scenes import Cells, Constants, Scene, held_axes, require_rectangle, require_uniform
from sheetbench.scenes.meaning.composition import of_sheet, parts_between, shares_of, sides_of
from sheetbench.scenes.meaning.natural_state import growth_of_cells
from sheetbench.scenes.objects.cells import NUMBERS
from sheetbench.scenes.objects.grading import Graded
from sheetbench.scenes.objects.grid import Grid
from sheetbench.scenes.objects.shapes import COINCIDENT
from sheetbench.scenes.objects.supports import Point, place

SHEAR_CORRECTION = 5.0 / 6.0
DIVISIONS = 4
ROUNDING = 1e-12  # of moduli: a smaller one is 0


@dataclass(frozen=True, eq=False)
class CellSection:
    """Stiffness and mass of a section; for cells the dots are (rows, columns). membrane: A (…, 3, 3) [N/m]
    and bending: D (…, 3, 3) [N·m] over (x, y, xy); shear: (…, 2, 2) [N/m] along x and y; mixed: B (…, 3, 3)
    [N]; per_area: (…) [kg/m²]; rims: parts of cells near oblique rims, if any; share: of each cell that the
    sheet covers, if some are cut; growth: of the sides of each cell, if patches have grown."""

    membrane: np.ndarray
    bending: np.ndarray
    shear: np.ndarray
    mixed: np.ndarray
    per_area: np.ndarray
    rims: ObliqueRims | None = None
    share: np.ndarray | None = None
    growth: np.ndarray | None = None

    @classmethod
    def of(cls, constants: Constants) -> Self:
        """Return the section of a sheet with given constants."""
        if constants.plies:
            parts = plies.section(constants.plies, constants.thickness)
            return cls(*parts, np.asarray(constants.per_area))
        numbers = (np.float64(getattr(constants, name)) for name in NUMBERS)
        h, young, nu, density = np.broadcast_arrays(*numbers)
        unit = np.zeros((*nu.shape, 3, 3))
        unit[..., 0, 0] = unit[..., 1, 1] = 1.0
        unit[..., 0, 1] = unit[..., 1, 0] = nu
        unit[..., 2, 2] = (1.0 - nu) / 2.0
        stretching = young * h / (1.0 - nu**2)
        rigidity = stretching * h**2 / 12.0
        shear = SHEAR_CORRECTION * young / (2.0 * (1.0 + nu)) * h
        membrane, bending = (k[..., None, None] * unit for k in (stretching, rigidity))
        return cls(membrane, bending, shear[..., None, None] * np.eye(2), 0.0 * membrane, density * h)

    def map(self, change: Callable[[np.ndarray], np.ndarray]) -> Self:
        """Return the section with a function applied to every array of PARTS."""
        parts: dict[str, Any] = {name: change(getattr(self, name)) for name in PARTS}
        return replace(self, **parts)

    def __add__(self, other: CellSection) -> CellSection:
        return CellSection(**{name: getattr(self, name) + getattr(other, name) for name in PARTS})

    @property
    def free_shear(self) -> np.ndarray:
        """Return S along x and y (…, 2) [N/m] without a force that shears the other way."""
        return free(np.diagonal(self.shear, axis1=-2, axis2=-1), self.shear[..., 0, 1])

    @property
    def layer_width(self) -> np.ndarray:
        """Width λ (…, 2) [m] of the layer in which the twisting moment fades at free edges normal to x and to
        y: √(D/S), D `twisting` and S along the edge, without shear across it; h/√10 of an isotropic sheet."""
        twist = twisting(free_bending(self.membrane, self.mixed, self.bending))
        return np.sqrt(ratio(twist, self.free_shear[..., ::-1]))


PARTS = ("membrane", "bending", "shear", "mixed", "per_area")


def free_bending(membrane: np.ndarray, mixed: np.ndarray, bending: np.ndarray) -> np.ndarray:
    """Return D − B A⁻¹ B (…, 3, 3) [N·m], the bending stiffness without tension."""
    if not mixed.any():
        return bending
    present = membrane[..., :1, :1] > 0.0
    return np.asarray(bending - mixed @ np.linalg.solve(np.where(present, membrane, np.eye(3)), mixed))


def free(shear: np.ndarray, coupling: np.ndarray) -> np.ndarray:
    """Return S along x and y (…, 2) without a force the other way, from shear (…, 2) and coupling (…)."""
    return np.asarray(shear - ratio((coupling**2)[..., None] + 0.0 * shear, shear[..., ::-1]))


def twisting(bending: np.ndarray) -> np.ndarray:
    """Return the twisting stiffness (…, 2) [N·m] at edges normal to x and to y, D66 less D16²/D11 and
    D26²/D22: at an edge that bends freely the moment across it stays 0, and fibres at an angle turn twist
    into bending."""
    normal = np.diagonal(bending, axis1=-2, axis2=-1)[..., :2]
    return np.asarray(bending[..., 2, 2, None] - ratio(bending[..., :2, 2] ** 2, normal))


def stretch_by_twist(bending: np.ndarray) -> np.ndarray:
    """Return r (…, 2) of edges normal to x and to y: without a moment across the edge, the twisting moment is
    `twisting` (2 κ_nt + r κ_tt), κ_tt the curvature along the edge; r = 0 for fibres along the sides."""
    twist, skew = bending[..., 2, 2], bending[..., :2, 2][..., ::-1]  # D66; D26, D16
    normal = np.diagonal(bending, axis1=-2, axis2=-1)[..., :2]
    along = skew - ratio(bending[..., 0, 1, None] * bending[..., :2, 2], normal)
    skewed = np.abs(along) > ROUNDING * twist[..., None]
    return np.where(skewed, ratio(along, twisting(bending)), 0.0)


def ratio(part: np.ndarray, whole: np.ndarray) -> np.ndarray:
    """Return part/whole, 0 for absent cells."""
    return np.divide(part, whole, out=np.zeros(np.broadcast(part, whole).shape), where=whole > 0.0)


def of_cells(cells: Cells, grid: Grid) -> CellSection:
    """Return the sections of a table of cells. Raises BadInput for a table of another grid."""
    cells.require_grid(grid)
    shape = grid[1] - 1, grid[0] - 1
    return CellSection.of(cells.arrays(shape))


def require_alike(scene: Scene, who: str, instead: str) -> None:
    """Raise Impossible for a sheet whose cells differ or that has an outline.

    Parameters
    ----------
    scene : Scene
        Scene to check.
    who : str
        Name of the model that needs equal cells, for the message.
    instead : str
        Model that the message recommends.

    Raises
    ------
    Impossible
        If parts of the sheet differ, or it has an outline or cutouts.
    """
    require_uniform(scene, who, instead)
    if scene.pierced:
        require_rectangle(scene, who, instead)


def sections_of(scene: Scene, grid: Grid, grading: Graded = 0.0) -> CellSection | None:
    """Return the sections of the cells of a scene's sheet.

    Parameters
    ----------
    scene : Scene
        Scene with sheet, material, patches and layers.
    grid : tuple of int
        Masses along x, along y and through the thickness.
    grading : float or Grading, default 0
        Grading of the grid's lines (`lumped.grid_lines`).

    Returns
    -------
    CellSection, optional
        Stiffness per width and mass per area of each cell, (rows, columns, …), or None for a uniform
        isotropic sheet. A cell that the outline cuts has stiffness and mass times its share of sheet.

    Notes
    -----
    Several parts in a cell are homogenised as divisions in series (Kohn and Vogelius 1984).
    """
    lines = grid_lines(scene.sheet, grid, grading)
    uncut, clamped = _without_outline(scene, grid, lines), clamped_stiffness(scene, lines)
    cut = bool(np.any(np.abs(clamped - 1.0) > COINCIDENT))
    growth = growth_of_cells(scene, lines[0].at, lines[1].at)
    if not (scene.pierced or cut or growth is not None):
        return uncut
    if uncut is None:
        uncut = of_cells(Cells.of(scene.sheet, scene.material), grid)
    uncut = replace(uncut, growth=growth)
    if cut:
        uncut = replace(_scaled(uncut, clamped), per_area=uncut.per_area)
    if not scene.pierced:
        return uncut
    share = shares_of(scene.region, lines[0].at, lines[1].at)
    # a held area beyond the rim bends as part of the cell: `clamped` is the factor of the cell's free part
    held = [s for s in scene.supports if place(s) and not isinstance(s, Point) and held_axes(s) == (0, 1, 2)]
    bent = share
    if held:
        with_held = scene.region.union(union_of(held))
        bent = np.where(share > 0.0, shares_of(with_held, lines[0].at, lines[1].at), 0.0)
    of_mass = _scaled(uncut, share).per_area
    rims = oblique_rims(scene, lines, share)
    return replace(_scaled(uncut, bent), per_area=of_mass, rims=rims, share=share)


def _without_outline(scene: Scene, grid: Grid, lines: tuple[Lines, Lines]) -> CellSection | None:
    """Return the sections of cells as if the sheet had no outline, or None for a uniform isotropic sheet."""
    if scene.uniform:
        return None
    if scene.homogeneous:
        return of_cells(Cells(**vars(of_sheet(scene))), grid)
    x, y = (_division_lines(side, at) for side, at in zip(lines, sides_of(scene), strict=True))
    sections = [_scaled(CellSection.of(part.constants), part.share) for part in parts_between(scene, x, y)]
    total = sum(sections[1:], sections[0])
    places = (_divisions(fine, side) for fine, side in zip((x, y), lines, strict=True))
    (along_x, over_x), (along_y, over_y) = places
    by_rows = _in_series(_in_series(total, 0, along_x, over_x), 1, along_y, over_y)
    by_columns = _in_series(_in_series(total, 1, along_y, over_y), 0, along_x, over_x)
    return _scaled(by_rows + by_columns, np.array(0.5))


def _division_lines(lines: Lines, sides: np.ndarray) -> np.ndarray:
    """Return the places [m] of the lines, of DIVISIONS − 1 lines within each cell, and of the parts'
    sides."""
    within = lines.at[:-1, None] + np.outer(lines.widths, np.arange(DIVISIONS) / DIVISIONS)
    finer = np.append(within, lines.at[-1])
    on_line = np.isclose(sides[:, None], finer, rtol=0.0, atol=COINCIDENT * lines.at[-1]).any(axis=1)
    return np.sort(np.concatenate([finer, sides[~on_line]]))


def _divisions(fine: np.ndarray, lines: Lines) -> tuple[np.ndarray, np.ndarray]:
    """Return the index of each cell's first division, and the share of each division in its cell."""
    begin = np.searchsorted(fine, lines.at[:-1])
    counts = np.diff(np.append(begin, len(fine) - 1))
    return begin, np.diff(fine) / np.repeat(lines.widths, counts)


def _scaled(section: CellSection, factor: np.ndarray) -> CellSection:
    return section.map(lambda part: part * factor.reshape(*factor.shape, *(1,) * (part.ndim - factor.ndim)))


def _in_series(section: CellSection, axis: int, begin: np.ndarray, share: np.ndarray) -> CellSection:
    """Return the section of the divisions in series along an axis of the plan (0 = x, 1 = y), cell by
    cell."""
    along = 1 - axis  # of the arrays

    def mean(part: np.ndarray) -> np.ndarray:
        weights = share.reshape(-1, *(1,) * (part.ndim - along - 1))
        return np.asarray(np.add.reduceat(weights * part, begin, axis=along))

    def form(part: np.ndarray) -> np.ndarray:
        row, diagonal = part[..., axis], part[..., axis, axis]
        share_of_row = row / diagonal[..., None]
        mixed, compliance = mean(share_of_row), mean(1.0 / diagonal)
        rest = mean(part - row[..., :, None] * share_of_row[..., None, :])
        return rest + mixed[..., :, None] * mixed[..., None, :] / compliance[..., None, None]

    parts: dict[str, Any] = {name: form(getattr(section, name)) for name in PARTS[:3]}
    return CellSection(**parts, mixed=mean(section.mixed), per_area=mean(section.per_area))
