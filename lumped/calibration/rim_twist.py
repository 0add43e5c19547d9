"""Reduction of the twisting stiffness at free rims of a sheet with an outline or cutouts.

Any side of a cell with no cell beyond it is a rim. The present cells of each row and column form runs; a run
is the strip of `lumped.calibration.edge_twist`, of cells like the one at its end, and the cell at a free end
has the factor of a strip with as many cells. Whole rectangles of unequal stiffness have strips of equal cells
too: a strip of unequal cells would make up at its ends for stiffness that it has or lacks elsewhere. Ends
within the sheet's rectangle are free; ends at its edges depend on the supports, and have constants
`edge_shear` and `strip_shear`.

The twisting moment in the axes of an oblique rim fades towards it. For n across the rim and t along it, D in
their axes and the factor f of a wide strip of cells as wide as the grid's, the part of a cell within its
length of the rim has −(1 − f) D̃66/Σ z_k² as strain springs and couplings on

    γ_nt + r ε_tt = (2 n₁ t₁ + r t₁²) ε₁ + (2 n₂ t₂ + r t₂²) ε₂ + (n₁ t₂ + n₂ t₁ + r t₁ t₂) γ,

S along the rim being 1/(t₁²/Sx + t₂²/Sy). A lattice without them loses, along a rim cut out of the grid at
any angle, 0.9 to 0.98 of the width of twist that it loses along one of its lines
(`tests/lumped/calibration/test_oblique_rims.py`).
"""

from collections import defaultdict
from dataclasses import replace

import numpy as np

from lumped import moduli, sections
from lumped.calibration.cell_by_cell import GridCells
from lumped.calibration.edge_twist import AT_CORNERS, Strips, Twist, edge_factors, symmetric, twist_of
from lumped.coverage import ObliqueRims
from lumped.spring_constants import RIMS_OWN, Springs, along_edge, either, rank_one

STRIP = 12  # cells across a strip whose far edge has no effect
EQUAL_SHARE = 1e-9  # tolerance for the shares of cells that one straight line cuts
EQUAL = 1e-9  # tolerance for equal twisting stiffness, of the largest


def with_twist(
    grid_cells: GridCells, springs: Springs, cell_moduli: moduli.Moduli
) -> tuple[Springs, list[str]]:
    """Return the springs with the twist of their edges, and of rims of absent or cut cells, and a note if no
    factor is right; cell_moduli: of the springs.

    A layer's cell has −(1 − f) D̃66/Σ z_k² on γ + r ε_tt, z_k [m] the heights of the layers: at the sheet's
    edges as `edge_shear`, `strip_shear` and `edge_coupling`, as `far_edge_shear` and so on at the far edges
    of unequal cells, elsewhere as the springs of rims.
    """
    covered, twist = grid_cells.covered, twist_of(grid_cells, springs, cell_moduli)
    oblique = None if grid_cells.cells is None else grid_cells.cells.rims
    drawn = oblique is not None or not covered.all()
    square = moduli.second_moment(grid_cells.grid[2]) * springs.layer_distance**2 * np.ones(covered.shape)
    near, rims = np.zeros(covered.shape, dtype=bool), np.zeros((*covered.shape, len(RIMS_OWN)))
    notes: list[str] = []
    if oblique is not None and not springs.rubber:
        near[oblique.rows, oblique.columns] = True
        rims, notes = at_oblique_rims(oblique, grid_cells, twist, cell_moduli)
        rims /= square[..., None]
    several, unequal = grid_cells.several, grid_cells.cells is not None
    unequal |= not all(map(symmetric, grid_cells.lines))
    constants: dict[str, list[np.ndarray]] = defaultdict(list)
    for axis, lines in enumerate(grid_cells.lines):
        # by place along the edges normal to the axis, and across from them
        of_cells, across = (covered, grid_cells.share(), near, rims, square), axis * (not several)
        rows, share, oblique_near, on_rims, heights = (part.swapaxes(0, across) for part in of_cells)
        of_axis = Twist._make(part[..., axis].swapaxes(0, across) for part in twist)
        corner = ~np.logical_and(*_neighbours(rows, False)) | several
        twisting = of_axis.twisting
        varied = grid_cells.cells is not None and np.ptp(twisting) > EQUAL * np.max(twisting)
        strips = Strips(of_axis, corner, None if drawn or varied else lines)
        usable = _aligned(share, oblique_near) & ~(oblique_near & corner) if drawn else rows
        (places, first), (_, last) = (np.nonzero(rows & ~other.T) for other in _neighbours(rows.T, False))
        for far in (False, True)[: 1 + unequal]:
            cells, outer = (last, rows.shape[1] - 1) if far else (first, 0)
            existing = usable[places, cells]
            place, cell, count = places[existing], cells[existing], (last - first)[existing] + 1
            strip, strip_exists = strips.reduction(place, cell, count, far, True)
            whole_row = count == rows.shape[1]
            edge = strip.copy()
            ends = place[whole_row], cell[whole_row], count[whole_row]
            edge[whole_row], edge_exists = strips.reduction(*ends, far, False)
            strip, edge = strip / heights[place, cell], edge / heights[place, cell]
            if not (strip_exists and edge_exists):
                name = "a rim" if drawn else f"{'xy'[axis]}{int(far)}"
                notes.append(f"no twisting stiffness of the cells along {name} corrects their edge")
            inside, stretch = cell != outer, of_axis.stretch[place, cell]
            if drawn:
                strain = along_edge(axis, stretch[inside])
                on_rims[place[inside], cell[inside]] += rank_one(strip[inside], *strain)
            kinds = ("edge_shear", edge), ("strip_shear", strip), ("edge_coupling", stretch)
            for name, values in kinds:
                along = np.zeros(len(rows))
                along[place[~inside]] = values[~inside]
                constants[f"{'far_' * far}{name}"].append(along)
    springs_of_rims = dict(zip(RIMS_OWN, np.moveaxis(rims, -1, 0)[:, None], strict=True))
    rims_of = {name: tuple(values) for name, values in springs_of_rims.items() if values.any()}
    edges = {name: either(*pair) for name, pair in constants.items()}
    return replace(springs, of={**springs.of, **rims_of, **edges}), list(dict.fromkeys(notes))


def _neighbours(rows: np.ndarray, beyond: float) -> tuple[np.ndarray, np.ndarray]:
    """Return the previous and the next value of each along the first axis, with `beyond` past the ends."""
    end = np.full_like(rows[:1], beyond)
    return np.concatenate([end, rows[:-1]]), np.concatenate([rows[1:], end])


def _aligned(share: np.ndarray, near_oblique: np.ndarray) -> np.ndarray:
    """Return whether cells are whole, or cut by a rim across the axis like a neighbour along the rim and not
    near an oblique rim, (places along the rim, across)."""
    equal = [np.abs(other - share) < EQUAL_SHARE for other in _neighbours(share, np.inf)]
    return (share > 1.0 - EQUAL_SHARE) | (~near_oblique & (equal[0] | equal[1]))


def at_oblique_rims(
    rims: ObliqueRims, grid_cells: GridCells, twist: Twist, cell_moduli: moduli.Moduli
) -> tuple[np.ndarray, list[str]]:
    """Return the change of strain springs of the layers' cells times Σ z_k², (rows, columns, 6) [N·m] (see
    `Springs.strains`), and notes; cell_moduli: of the cells' springs."""
    covered = grid_cells.covered[rims.rows, rims.columns]
    rows, columns, part, n = (values[covered] for values in rims)
    at = rows, columns
    t = np.stack([-n[:, 1], n[:, 0]], axis=1)
    states = np.stack([_strains(a, b) for a, b in ((n, n), (t, t), (n, t))], axis=1)
    bending = states @ cell_moduli.free_bending[at] @ np.swapaxes(states, 1, 2)
    twisting, stretch = (form(bending)[:, 0] for form in (sections.twisting, sections.stretch_by_twist))
    kinds = cell_moduli.free_shear, grid_cells.section.free_shear
    shear, free = (1.0 / (t**2 / stiffness[at]).sum(axis=1) for stiffness in kinds)
    share = (t**2 * twist.shares[at][:, ::-1]).sum(axis=1)
    width, lost = np.sqrt(grid_cells.sides[at].prod(axis=1)), np.sqrt(twisting / free)
    strips = np.repeat([width, twisting, shear, share], STRIP, axis=1).reshape(4, -1, STRIP)
    factor = edge_factors(strips[0], strips[1], strips[2], strips[3], lost, False)
    notes = []
    if not np.all(factor > 0.0):
        notes.append("no twisting stiffness of the cells along an oblique rim makes it right")
        factor = np.where(np.isnan(factor), 1.0, factor)
    # γ_nt + r ε_tt, whose strains along x and y count twice in the first
    strain = ([2.0, 2.0, 1.0] * states[:, 2] + stretch[:, None] * [1.0, 1.0, 0.5] * states[:, 1]).T
    change = np.zeros((*grid_cells.covered.shape, len(RIMS_OWN)))
    np.add.at(change, at, rank_one(part * (np.maximum(factor, AT_CORNERS) - 1.0) * twisting, *strain))
    return change, notes


def _strains(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Return ε1, ε2 and γ (m, 3) of the strain of directions a and b, (m, 2)."""
    return np.column_stack([a * b, a[:, 0] * b[:, 1] + a[:, 1] * b[:, 0]])
