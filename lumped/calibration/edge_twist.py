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

import math
from functools import lru_cache
from typing import Any

import numpy as np
from scipy.linalg import LinAlgError, solveh_banded

from lumped import moduli, sections
from lumped import spring_constants as constants
from lumped.calibration.calibration import either
from lumped.grid_lines import Lines, grid_lines
from lumped.sections import Section
from sheetbench.numerics.kept import kept
from sheetbench.scenes import Sheet, SpringSet
from sheetbench.scenes.grading import Graded
from sheetbench.scenes.grid import Grid

Each = float | np.ndarray
AT_CORNERS = 0.55  # f is at least this where two reductions may add, 1 − 2 (1 − f) > 0
MOST = 3.0  # f is sought up to this, and from where the cell's own twisting stiffness is positive


def layer_width(thickness: float) -> float:
    """λ [m] of a plate with the shear correction 5/6, whatever its ν."""
    return thickness / math.sqrt(10.0)


def with_edges(
    sheet: Sheet, grid: Grid, springs: SpringSet, grading: Graded = 0.0, cells: Section | None = None
) -> tuple[SpringSet, list[str]]:
    """The springs with `edge_shear`, `strip_shear` and `edge_coupling`, and a note for edges where no factor
    will do.

    A layer's cell takes −(1 − f) D̃66/Σ z_k² on γ + r ε_tt, z_k [m] the heights of the layers. On a graded
    grid every cell along an edge has the f of the strip of cells that begins with it, or the largest there
    is. Where cells are finer towards one of two opposite edges each has its own, `far_edge_shear` and so on
    at the far one; of a strip whose edges are both free, that of the strip and its mirror image together.
    """
    lines = grid_lines(sheet, grid, grading)
    notes: list[str] = []
    lost = np.broadcast_to(
        layer_width(sheet.thickness) if cells is None else cells.layer_width, (grid[1] - 1, grid[0] - 1, 2)
    )
    alike = cells is None and all(_alike(side) for side in lines)
    edges = _of_edges(lost, lines, springs, grid[2], False, cells is not None, notes)
    if not alike:
        far = _of_edges(lost, lines, springs, grid[2], True, cells is not None, notes)
        edges |= {f"far_{name}": value for name, value in far.items()}
    return springs.model_copy(update=edges), list(dict.fromkeys(notes))


def _alike(lines: Lines) -> bool:
    """Whether a side's cells are the same from either end."""
    return np.allclose(lines.widths, lines.widths[::-1], rtol=1e-9)


def _of_edges(
    lost: np.ndarray,
    lines: tuple[Lines, Lines],
    springs: SpringSet,
    layers: int,
    far: bool,
    differ: bool,
    notes: list[str],
) -> dict[str, Any]:
    """Constants of x0 and y0 by name, or of x1 and y1 (`far`); adds to the notes. lost: λ of the cells
    (rows, columns, 2) [m]; differ: whether they have sections of their own, and each is taken as if all
    across the sheet were like it."""
    square = moduli.second_moment(layers) * springs.layer_distance**2
    unequal = constants.varies(springs)
    found: dict[bool, list[Any]] = {False: [], True: []}
    couplings: list[Any] = []
    for axis in range(2):
        across, along = lines[axis], lines[1 - axis]
        skewed = not _alike(across)
        edge = f"{'xy'[axis]}{int(far)}"
        places = range(len(along.widths)) if unequal else range(1)
        strips = [_strip(springs, lines, axis, place, layers, far) for place in places]
        stretch = tuple(float(strip[3][0]) for strip in strips)
        couplings.append(stretch if any(stretch) else 0.0)
        if differ:
            strips = [tuple(np.full_like(part, part[0]) for part in strip) for strip in strips]
        widths = across.widths[::-1] if far else across.widths
        along_edge = np.moveaxis(lost[..., axis], 1 - axis, 0)[-int(far)]
        for both, values in found.items():
            taken = []
            mirrored = both and skewed
            for place, strip in zip(places, strips, strict=True):
                width, twisting, shear, shares = (_with_image(row, mirrored) for row in (widths, *strip[:3]))
                factor = edge_factor(
                    len(width), width, twisting, shear, shares, float(along_edge[place]), both
                )
                if factor is None:
                    notes.append(f"no twisting stiffness of the cells along {edge} makes their edge right")
                    factor = MOST if unequal else 1.0
                if place in (0, len(along.widths) - 1) or not unequal:
                    factor = max(factor, AT_CORNERS)
                taken.append((factor - 1.0) * float(strip[0][0]) / square)
            values.append(tuple(taken) if unequal else taken[0])
    edges = {"edge_shear": either(*found[False]), "strip_shear": either(*found[True])}
    return {**edges, "edge_coupling": either(*couplings)}


def _with_image(row: np.ndarray, mirrored: bool) -> np.ndarray:
    """Values of a row of cells, (n,), those of its mirror image behind them if `mirrored`, (2 n,)."""
    return np.concatenate([row, row[::-1]]) if mirrored else row


def _strip(
    springs: SpringSet, lines: tuple[Lines, Lines], axis: int, place: int, layers: int, far: bool
) -> tuple[np.ndarray, ...]:
    """Of the cells across the sheet along `axis`, at a place along its edge: D̃66 [N·m], S along the edge
    [N/m], the share of it in the furthest diagonals and r, (n,) each, from its far end on if `far`; (1,)
    where all cells are alike."""
    rows = []
    unequal = constants.varies(springs)
    for cell in range(len(lines[axis].widths)) if unequal else range(1):
        column, row = (cell, place) if axis == 0 else (place, cell)
        own = constants.of_cell(springs, row, column) if unequal else springs
        sides = (float(lines[0].widths[column]), float(lines[1].widths[row]), springs.layer_distance)
        twisting, shear, shares, stretch = of_cell(own, sides, layers)
        rows.append((twisting[axis], shear[1 - axis], shares[1 - axis], stretch[axis]))
    return tuple(np.array(rows[::-1] if far else rows).T)


@lru_cache(maxsize=4096)  # kinds of cells: strips have most in common
def of_cell(springs: SpringSet, sides: tuple[float, float, float], layers: int) -> tuple[list[float], ...]:
    """D̃66 [N·m] of a cell at edges normal to x and to y, its S along x and y [N/m], the diagonals' share, and
    r at edges normal to x and to y."""
    whole = moduli.of_springs(springs, sides, layers)
    at_edges = sections.twisting(whole.bending), sections.stretch_by_twist(whole.bending)
    return at_edges[0].tolist(), whole.shear.tolist(), _shares(springs, sides), at_edges[1].tolist()


def _shares(springs: SpringSet, spacing: tuple[float, float, float]) -> list[float]:
    """The share of S along x and along y that the furthest diagonals carry."""
    by_x, by_y, by_diagonals = moduli.gap_shear_per_stiffness(spacing)
    diagonals = by_diagonals * constants.along(springs, "cross_diagonal", "")[0]
    cross = [by * constants.along(springs, "cross", name)[0] for by, name in ((by_x, "x"), (by_y, "y"))]
    beside, over = constants.of_faces(springs, spacing[:2])
    pairs = zip(diagonals + over, cross + beside, strict=True)
    return [float(d / (d + c)) if d + c else 0.0 for d, c in pairs]


@kept(last=32, most=1 << 14)  # strips along x and along y of a square sheet are one
def edge_factor(
    cells: int, width: Each, twisting: Each, shear: Each, by_diagonals: Each, lost: float, both: bool
) -> float | None:
    """f of the cells along one edge, or along both; None where no factor makes the strip lose that width.

    cells: of `width` [m] across the strip; twisting: D66 [N·m]; shear: S along the edge [N/m], by_diagonals:
    the share of it in the cells' diagonals, each of all cells or (n,), the same from either edge of a strip
    with both; lost: λ [m].
    """
    width, twisting, shear, by_diagonals = np.broadcast_arrays(
        *(np.asarray(value, dtype=float) for value in (width, twisting, shear, by_diagonals)), np.empty(cells)
    )[:4]
    edges = (0, cells - 1) if both else (0,)
    rest = np.ones(cells)
    rest[list(edges)] = 0.0
    pulls = np.zeros((cells + 1, 2))  # by the twist of the cells inside; by the edges' cells
    pulls[1:, 0] += rest * twisting
    pulls[:-1, 0] -= rest * twisting
    for edge in edges:
        pulls[edge + 1, 1] += 1.0 / len(edges)
        pulls[edge, 1] -= 1.0 / len(edges)
    free = slice(None) if both else slice(None, -1)
    sheared_by = shear * width
    bands = _bands(rest * twisting / width, (1.0 - by_diagonals) * sheared_by, by_diagonals * sheared_by)
    bands = bands[:, free][-len(pulls[free]) :]  # a single unknown has no second band
    try:
        sheared = solveh_banded(bands, pulls[free])
    except LinAlgError:  # beside its twisting stiffness S is nothing: only rounding would hold the rows
        return None
    alone = 0.5 * (rest @ (twisting * width) - pulls[free, 0] @ sheared[:, 0])  # the energy of the rest
    opening, yielding = pulls[free, 1] @ sheared  # ψ_1 − ψ_0 of the rest, and by a unit pull of the edges'
    number = 1 if cells == 1 else len(edges)
    wanted = 0.5 * twisting[0] * (width.sum() - len(edges) * lost) - alone
    if wanted <= 0.0:
        return None
    compliance = 0.5 * (width[0] - opening) ** 2 / wanted - yielding
    if compliance <= 0.0:
        return None
    own = width[0] / (number * twisting[0] * compliance)  # all factors of an edge's cell together
    factor = 1.0 - (1.0 - own) / (2 if both and cells == 1 else 1)
    return float(factor) if factor <= MOST else None


def _bands(twist: np.ndarray, trapezoid: np.ndarray, middle: np.ndarray) -> np.ndarray:
    """The strip's matrix, upper bands (2, n + 1), from its cells' D66/b, and S b by trapezium and in the
    middle, (n,) each."""
    bands = np.zeros((2, len(twist) + 1))
    bands[0, 1:] = 0.25 * middle - twist
    for end in (slice(None, -1), slice(1, None)):
        bands[1, end] += twist + 0.5 * trapezoid + 0.25 * middle
    return bands
