"""What a free edge takes off the twisting stiffness, as a factor for the cells along it.

Where nothing holds a plate's director (free, hinged and held edges) the twisting moment fades within a layer
of width λ = √(D66/κGh) = h/√10: a strip twists as if it were that much narrower at either edge, which is the
0.63 h/b of the torsion constant b h³/3 (1 − 0.63 h/b). A lattice has such a layer too, but one of the width
of its cells and with the grid's S*, so it loses another width, and refining it by halves does not converge
at second order. In the cells along such an edge D66 is therefore multiplied by a factor f that makes the
width lost λ. In a corner cell between two such edges what they take adds; cells much narrower than the layer
is wide ask for f below ½, and two of those would leave the corner without twisting stiffness, so that the
sheet is unstable there: such corners have f = 0.55.

With fibres at an angle to the edge (normal n, tangent t) it is the twisting moment that fades, not the twist:
where M_nn = 0, M_nt = D̃66 (2 κ_nt + r κ_tt),

    D̃66 = D66 − D_n6²/D_nn,   D̃_t6 = D_t6 − D_nt D_n6/D_nn,   r = D̃_t6/D̃66,   λ = √(D̃66/S_t),

and the strip's energy is that of 2 κ_nt + r κ_tt in place of the twist, D̃66 in place of D66. So the cells'
springs act on γ + r ε_tt: a strip that a moment bends has M_nt = 0, and loses nothing.

A long strip of n cells of width b across, on a graded grid each with its own, with shear links along it
(stiffness S, a share s of it by the cells' diagonals), rate of twist 2θ = 1 and ψ_j the shear of row j,
minimises

    Σ_c ½ f_c D66 b ((ψ_{c+1} − ψ_c)/b − 1)² + Σ_c ½ S b [(1 − s)(ψ_c² + ψ_{c+1}²)/2 + s ((ψ_c + ψ_{c+1})/2)²]

and loses the width Σ_c [b − f_c (b − (ψ_{c+1} − ψ_c))], which is Σ_c b − 2 E/D66 at the least energy E. Both
edges free: f_0 = f_{n−1} = f (of a single cell both reductions add) and 2 λ is lost; else ψ_n = 0 at the far
edge and λ is lost. An edge's cell is a spring f D66/b in series with the rest of the strip, whose energy is
quadratic in ψ_1 − ψ_0 alone, so f follows from one solution for the rest. Derived for this project
(`docs/theory.md`); D̃66 and r are those of `lumped.sections`. The thin strip's torsion constant is
Saint-Venant's.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy.linalg.lapack import dptsv

from lumped import moduli, sections
from lumped.calibration.cell_by_cell import EachCell
from lumped.grid_lines import Lines
from lumped.spring_constants import Springs, of_faces
from sheetbench.numerics.cache import cached

AT_CORNERS = 0.55  # f is at least this where two reductions may add, 1 − 2 (1 − f) > 0
MOST = 3.0  # f is sought up to this, and from where the cell's own twisting stiffness is positive


class Twist(NamedTuple):
    """How cells twist at edges normal to x and to y, (rows, columns, 2): width across [m], D̃66 [N·m], S
    along the edge [N/m], the share of it in the furthest diagonals, r, and the width λ that a plate loses
    [m]."""

    width: np.ndarray
    twisting: np.ndarray
    shear: np.ndarray
    shares: np.ndarray
    stretch: np.ndarray
    lost: np.ndarray


def twist_of(each: EachCell, springs: Springs, whole: moduli.Moduli) -> Twist:
    """Return how cells twist; whole: the moduli of their springs."""
    shear, shares = whole.free_shear[..., ::-1], diagonals_share(each, springs)[..., ::-1]
    twisting, stretch = (of(whole.free_bending) for of in (sections.twisting, sections.stretch_by_twist))
    return Twist(each.sides, twisting, shear, shares, stretch, each.section.layer_width)


class Strips(NamedTuple):
    """Cells by their place along the edges normal to an axis and by how far across they are, (places, across)
    each: how they twist there, and whether a free edge beside them crosses this one (`corner`).

    lines: across which they lie, of a whole rectangle, whose strips are of its own cells, one where all are
    alike; others are of cells like that at their end."""

    twist: Twist
    corner: np.ndarray
    lines: Lines | None

    def taken(
        self, place: np.ndarray, cell: np.ndarray, count: np.ndarray, far: bool, both: bool
    ) -> tuple[np.ndarray, bool]:
        """Return what free edges add to D̃66 of the cells at the near or the far end of strips of so many
        cells, (m,) [N·m], and whether there is a factor for each; those without have the most.

        On a graded grid every cell along an edge has the f of the strip of cells that begins with it. Of a
        strip whose edges are both free and whose cells are finer towards one it is that of the strip and its
        mirror image together."""
        factor, step = np.ones(len(count)), -1 if far else 1
        for cells in set(count.tolist()):
            of = count == cells
            at = place[of], cell[of]
            if self.lines is None:
                strips, number = [part[at][:, None] for part in self.twist[:4]], cells
            else:
                strips, number = [part[at[0], ::step] for part in self.twist[:4]], len(self.lines.widths)
            if strips[0].shape[1] == 1:
                strips[0] = np.repeat(strips[0], number, axis=1)
            elif both and self.lines is not None and not symmetric(self.lines):
                strips = [np.hstack([row, row[:, ::-1]]) for row in strips]
            factor[of] = edge_factors(strips[0], strips[1], strips[2], strips[3], self.twist.lost[at], both)
        found = bool(np.all(factor > 0.0))
        factor = np.where(np.isnan(factor), MOST, factor)
        factor = np.where(self.corner[place, cell], np.maximum(factor, AT_CORNERS), factor)
        return (factor - 1.0) * self.twist.twisting[place, cell], found


def symmetric(lines: Lines) -> bool:
    """Whether a side's cells are the same from either end."""
    widths = lines.widths
    return bool(np.all(np.abs(widths - widths[::-1]) <= 1e-9 * widths))


def diagonals_share(each: EachCell, springs: Springs) -> np.ndarray:
    """The share of S along x and along y that the furthest diagonals carry, (rows, columns, 2)."""
    by_cross, by_diagonals = moduli.gap_shear_per_stiffness(each.sides, springs.layer_distance)
    beside, over = of_faces(springs, each.sides**2)
    diagonals = over + by_diagonals * springs.along("cross_diagonal", 0)[..., None]
    cross = np.stack([springs.along("cross", axis) for axis in (0, 1)], axis=-1)
    whole = diagonals + by_cross * cross + beside
    return np.divide(diagonals, whole, out=np.zeros_like(whole), where=whole != 0.0)


@cached(last=32, most=1 << 14)  # strips along x and along y of a square sheet are one
def edge_factors(
    width: np.ndarray,
    twisting: np.ndarray,
    shear: np.ndarray,
    by_diagonals: np.ndarray,
    lost: np.ndarray,
    both: bool,
) -> np.ndarray:
    """f of the cells along one edge of strips, or along both, (m,); 0 where even that loses less than it
    should, NaN where else no factor makes the strip lose that width.

    Of each cell across the strips, (m, n), or 1 in place of either for all: width [m]; twisting: D66 [N·m];
    shear: S along the edge [N/m]; by_diagonals: the share of it in the cells' diagonals; the same from either
    edge of strips with both. lost: λ (m,) [m]."""
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
    own, beside = np.zeros((2, strips, cells + 1))
    for end in (slice(None, -1), slice(1, None)):
        own[:, end] += twist + 0.5 * trapezoid + 0.25 * middle
    beside[:, :-1] = 0.25 * middle - twist
    beside[:, free - 1] = 0.0
    sheared, held = _solved(own[:, :free], beside[:, :free], pulls)
    # the energy of the rest; ψ_1 − ψ_0 of it, and by a unit pull of the edges'
    alone = 0.5 * ((inside * twisting * width).sum(axis=1) - (pulls[..., 0] * sheared[..., 0]).sum(axis=1))
    opening, yielding = (pulls[..., 1, None] * sheared).sum(axis=1).T
    number = 1 if cells == 1 else len(edges)
    left = width.sum(axis=1) - len(edges) * lost
    wanted = 0.5 * twisting[:, 0] * left - alone
    with np.errstate(divide="ignore", invalid="ignore"):
        compliance = 0.5 * (width[:, 0] - opening) ** 2 / wanted - yielding
        # all factors of an edge's cell together
        factor = width[:, 0] / (number * twisting[:, 0] * compliance)
    if both and cells == 1:
        factor = 1.0 - 0.5 * (1.0 - factor)
    found = held & (wanted > 0.0) & (compliance > 0.0) & (factor <= MOST)
    return np.where(held & (left > 0.0) & (wanted <= 0.0), 0.0, np.where(found, factor, np.nan))


def _solved(own: np.ndarray, beside: np.ndarray, pulls: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Of strips with these diagonals and what is beside them (m, k), ψ by pulls (m, k, 2), and whether the
    strip is held, (m,): beside its twisting stiffness S may be nothing, so that only rounding would hold its
    rows."""
    held = np.ones(len(own), dtype=bool)
    while True:
        *_, found, failed = dptsv(own.ravel(), beside.ravel()[: max(own.size - 1, 1)], pulls.reshape(-1, 2))
        if failed <= 0:
            return found.reshape(pulls.shape), held
        strip = (failed - 1) // own.shape[1]
        held[strip], own[strip], beside[strip] = False, 1.0, 0.0
