"""Reduction of the twisting stiffness at free edges, as a factor for the cells along them.

The twisting moment fades at an edge where nothing holds a plate's director (free, hinged and held edges),
within a layer of width λ = √(D66/κGh) = h/√10: a strip twists as if it were narrower by λ at either edge,
hence the 0.63 h/b of the torsion constant b h³/3 (1 − 0.63 h/b). The layer of a lattice has the width of its
cells and the grid's S*, so it loses another width, and refining it by halves does not converge at second
order. D66 of the cells along a free edge is therefore multiplied by a factor f that makes the width lost λ.
The reductions of two edges add in a corner cell; cells much narrower than λ need f below ½, which at both
edges would leave the corner without twisting stiffness and the sheet unstable: there f is at least 0.55.

Fibres at an angle to the edge (normal n, tangent t) couple twist and bending, so that the twisting moment
fades, not the twist; for M_nn = 0, M_nt = D̃66 (2 κ_nt + r κ_tt),

    D̃66 = D66 − D_n6²/D_nn,   D̃_t6 = D_t6 − D_nt D_n6/D_nn,   r = D̃_t6/D̃66,   λ = √(D̃66/S_t),

and the strip's energy has 2 κ_nt + r κ_tt in place of the twist, D̃66 in place of D66. So the cells' springs
act on γ + r ε_tt: a strip that a moment bends has M_nt = 0, and loses nothing.

A long strip of n cells of width b across (on a graded grid each cell has another b), with shear links along
it (stiffness S, a share s of it by the cells' diagonals), rate of twist 2θ = 1 and ψ_j the shear of row j,
minimises

    Σ_c ½ f_c D66 b ((ψ_{c+1} − ψ_c)/b − 1)² + Σ_c ½ S b [(1 − s)(ψ_c² + ψ_{c+1}²)/2 + s ((ψ_c + ψ_{c+1})/2)²]

and loses the width Σ_c [b − f_c (b − (ψ_{c+1} − ψ_c))], which is Σ_c b − 2 E/D66 at the least energy E. Both
edges free: f_0 = f_{n−1} = f (of a single cell both reductions add) and 2 λ is lost; else ψ_n = 0 at the far
edge and λ is lost. An edge's cell is a spring f D66/b in series with the rest of the strip, whose energy is
quadratic in ψ_1 − ψ_0 alone, so f follows from one solution for the rest. Derived for this project
(`docs/theory.md`); D̃66 and r are `twisting` and `stretch_by_twist` of `lumped.sections`. The thin strip's
torsion constant is Saint-Venant's.
"""

from typing import NamedTuple

import numpy as np
from scipy.linalg.lapack import dptsv

from lumped import moduli, sections
from lumped.calibration.cell_by_cell import GridCells
from lumped.grid_lines import Lines
from lumped.spring_constants import Springs, of_faces
from sheetbench.numerics.cache import cached

AT_CORNERS = 0.55  # least f of cells in which two reductions may add, 1 − 2 (1 − f) > 0
MOST = 3.0  # largest f


class Twist(NamedTuple):
    """Twisting of cells at edges normal to x and to y, (rows, columns, 2) each. width: across the edge [m];
    twisting: D̃66 [N·m]; shear: S along the edge [N/m]; shares: of S in the furthest diagonals; stretch: r;
    lost: the width λ [m] that a plate loses."""

    width: np.ndarray
    twisting: np.ndarray
    shear: np.ndarray
    shares: np.ndarray
    stretch: np.ndarray
    lost: np.ndarray


def twist_of(grid_cells: GridCells, springs: Springs, cell_moduli: moduli.Moduli) -> Twist:
    """Return the twisting of cells; cell_moduli: of their springs."""
    shear, shares = cell_moduli.free_shear[..., ::-1], diagonals_share(grid_cells, springs)[..., ::-1]
    bending = cell_moduli.free_bending
    twisting, stretch = sections.twisting(bending), sections.stretch_by_twist(bending)
    return Twist(grid_cells.sides, twisting, shear, shares, stretch, grid_cells.section.layer_width)


class Strips(NamedTuple):
    """Cells in strips across the edges normal to an axis, (places along the edge, cells across). twist: of
    the cells; corner: bool, whether a crossing free edge is next to a cell; lines: across the strip of a
    whole rectangle of equal stiffness, whose strips consist of the grid's cells, or None, where strips repeat
    the cell at their end."""

    twist: Twist
    corner: np.ndarray
    lines: Lines | None

    def reduction(
        self, place: np.ndarray, cell: np.ndarray, count: np.ndarray, far: bool, both: bool
    ) -> tuple[np.ndarray, bool]:
        """Return the change (f − 1) D̃66 (m,) [N·m] of the twisting stiffness of cells at the near or the far
        free end of strips of `count` cells (m,), and whether a factor exists for each; else it is the
        largest.

        On a graded grid every cell along an edge has the f of the strip of cells that begins with it. A strip
        with two free edges and cells finer towards one has the f of the strip and its mirror image as one."""
        factor, step = np.ones(len(count)), -1 if far else 1
        for cells in set(count.tolist()):
            usable = count == cells
            at = place[usable], cell[usable]
            if self.lines is None:
                strips, number = [part[at][:, None] for part in self.twist[:4]], cells
            else:
                strips, number = [part[at[0], ::step] for part in self.twist[:4]], len(self.lines.widths)
            if strips[0].shape[1] == 1:
                strips[0] = np.repeat(strips[0], number, axis=1)
            elif both and self.lines is not None and not symmetric(self.lines):
                strips = [np.hstack([row, row[:, ::-1]]) for row in strips]
            width, twisting, shear, shares = strips
            factor[usable] = edge_factors(width, twisting, shear, shares, self.twist.lost[at], both)
        all_found = bool(np.all(factor > 0.0))
        factor = np.where(np.isnan(factor), MOST, factor)
        factor = np.where(self.corner[place, cell], np.maximum(factor, AT_CORNERS), factor)
        return (factor - 1.0) * self.twist.twisting[place, cell], all_found


def symmetric(lines: Lines) -> bool:
    """Return whether the widths of a side's cells are symmetric about its middle."""
    widths = lines.widths
    return bool(np.all(np.abs(widths - widths[::-1]) <= 1e-9 * widths))


def diagonals_share(grid_cells: GridCells, springs: Springs) -> np.ndarray:
    """Return the share of S along x and along y that the furthest diagonals carry, (rows, columns, 2)."""
    by_cross, by_diagonals = moduli.gap_shear_per_stiffness(grid_cells.sides, springs.layer_distance)
    on_sides, over = of_faces(springs, grid_cells.sides**2)
    diagonals = over + by_diagonals * springs.along("cross_diagonal", 0)[..., None]
    cross = np.stack([springs.along("cross", axis) for axis in (0, 1)], axis=-1)
    total = diagonals + by_cross * cross + on_sides
    return np.divide(diagonals, total, out=np.zeros_like(total), where=total != 0.0)


@cached(last=32, most=1 << 14)  # strips along x and along y of a square sheet are one
def edge_factors(
    width: np.ndarray,
    twisting: np.ndarray,
    shear: np.ndarray,
    by_diagonals: np.ndarray,
    lost: np.ndarray,
    both: bool,
) -> np.ndarray:
    """Return the factors f (m,) of the twisting stiffness for cells along one free edge of strips, or along
    both. f = 0 if even then the strip is stiffer than one narrower by λ, NaN if no other factor matches that
    width.

    Arrays over the cells across the strips, (m, n), with m or n = 1 for equal ones: width [m]; twisting: D66
    [N·m]; shear: S along the edge [N/m]; by_diagonals: share of S in the cells' diagonals. lost: λ (m,) [m];
    both: whether both edges are free, of strips that are then symmetric."""
    width, twisting, shear, by_diagonals = np.broadcast_arrays(width, twisting, shear, by_diagonals)
    strips, cells = width.shape
    edges = (0, cells - 1) if both else (0,)
    inside = np.ones(cells)
    inside[list(edges)] = 0.0
    pulls = np.zeros((strips, cells + 1, 2))  # by the twist of the cells inside; by the edges' cells
    pulls[:, 1:, 0] += inside * twisting
    pulls[:, :-1, 0] -= inside * twisting
    for edge in edges:
        pulls[:, edge + 1, 1] += 1.0 / len(edges)
        pulls[:, edge, 1] -= 1.0 / len(edges)
    free = cells + 1 if both else cells
    pulls = pulls[:, :free]
    twist, trapezoid = inside * twisting / width, (1.0 - by_diagonals) * shear * width
    middle = by_diagonals * shear * width
    diagonal, off_diagonal = np.zeros((2, strips, cells + 1))
    for end in (slice(None, -1), slice(1, None)):
        diagonal[:, end] += twist + 0.5 * trapezoid + 0.25 * middle
    off_diagonal[:, :-1] = 0.25 * middle - twist
    off_diagonal[:, free - 1] = 0.0
    shear_rows, regular = _solve_strips(diagonal[:, :free], off_diagonal[:, :free], pulls)
    # the energy without the edges' cells; ψ_1 − ψ_0 without and by a unit pull of the edges' cells
    work = (pulls[..., 0] * shear_rows[..., 0]).sum(axis=1)
    inner_energy = 0.5 * ((inside * twisting * width).sum(axis=1) - work)
    opening, yielding = (pulls[..., 1, None] * shear_rows).sum(axis=1).T
    number = 1 if cells == 1 else len(edges)
    effective = width.sum(axis=1) - len(edges) * lost
    edge_energy = 0.5 * twisting[:, 0] * effective - inner_energy
    with np.errstate(divide="ignore", invalid="ignore"):
        compliance = 0.5 * (width[:, 0] - opening) ** 2 / edge_energy - yielding
        # the two factors of a single cell as one
        factor = width[:, 0] / (number * twisting[:, 0] * compliance)
    if both and cells == 1:
        factor = 1.0 - 0.5 * (1.0 - factor)
    exists = regular & (edge_energy > 0.0) & (compliance > 0.0) & (factor <= MOST)
    too_stiff = regular & (effective > 0.0) & (edge_energy <= 0.0)
    return np.where(too_stiff, 0.0, np.where(exists, factor, np.nan))


def _solve_strips(
    diagonal: np.ndarray, off_diagonal: np.ndarray, pulls: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Return ψ by pulls (m, k, 2) of strips with tridiagonal matrices (m, k), and whether each matrix is
    regular, (m,): it is singular but for rounding if S vanishes relative to the twisting stiffness."""
    regular = np.ones(len(diagonal), dtype=bool)
    while True:
        lower = off_diagonal.ravel()[: max(diagonal.size - 1, 1)]
        *_, solution, failed = dptsv(diagonal.ravel(), lower, pulls.reshape(-1, 2))
        if failed <= 0:
            return solution.reshape(pulls.shape), regular
        strip = (failed - 1) // diagonal.shape[1]
        regular[strip], diagonal[strip], off_diagonal[strip] = False, 1.0, 0.0
