"""What free rims of a sheet with an outline or cutouts take off the twisting stiffness.

Any side of a cell with no cell beyond it is a rim. Along each row and each column of cells those that are
there form runs; a run is the strip of `lumped.calibration.edge_twist`, of cells like that at its end, and the
cell at a free end of it has the factor of a strip with as many cells. Ends within the sheet's rectangle are
free; ends at its edges are the supports' to say, and stand in `edge_shear` and `strip_shear`.

Towards an oblique rim it is the twisting moment in the rim's own axes that fades. With n across the rim and t
along it, D in their axes and the factor f of a wide strip of cells as wide as the grid's, what of a cell lies
within its own length of the rim takes −(1 − f) D̃66/Σ z_k² as strain springs and couplings on

    γ_nt + r ε_tt = (2 n₁ t₁ + r t₁²) ε₁ + (2 n₂ t₂ + r t₂²) ε₂ + (n₁ t₂ + n₂ t₁ + r t₁ t₂) γ,

S along the rim being 1/(t₁²/Sx + t₂²/Sy). Along a rim that is cut out of the grid at any angle a lattice
without them loses 0.9 to 0.98 of the width of twist that it loses along one of its lines
(`tests/lumped/calibration/test_oblique_rims.py`).
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from lumped import moduli, sections
from lumped.calibration.cell_by_cell import EachCell
from lumped.calibration.edge_twist import AT_CORNERS, MOST, Twist, edge_factors, twist_of, with_edges
from lumped.coverage import ObliqueRims
from lumped.spring_constants import EDGES_OWN, RIMS_OWN, Springs, along_edge, either, rank_one

STRIP = 12  # cells across a strip whose far edge is not felt
ALIKE = 1e-9  # shares of cells that one straight line cuts


def with_twist(each: EachCell, springs: Springs, whole: moduli.Moduli) -> tuple[Springs, list[str]]:
    """The springs with the twist of their edges, and of rims where cells are absent or cut, and notes; whole:
    the moduli of the springs."""
    twist = twist_of(each, springs, whole)
    if each.there.all() and (each.cells is None or each.cells.rims is None):
        edges, notes = with_edges(each, springs, twist)
        return replace(springs, edges=edges), notes
    return with_rims(each, springs, twist, whole)


def with_rims(
    each: EachCell, springs: Springs, twist: Twist, whole: moduli.Moduli
) -> tuple[Springs, list[str]]:
    """The springs with the twist of their cells' rims, and a note for rims where no factor will do."""
    there, share = each.there, each.share()
    square = moduli.second_moment(each.grid[2]) * springs.layer_distance**2
    near_oblique = np.zeros(there.shape, dtype=bool)
    rims = np.zeros((*there.shape, len(RIMS_OWN)))
    notes: list[str] = []
    oblique = each.cells.rims if each.cells is not None and not springs.rubber else None
    if oblique is not None:
        near_oblique[oblique.rows, oblique.columns] = True
        rims, notes = at_oblique_rims(oblique, each, twist, whole)
        rims /= square
    found: dict[str, list[np.ndarray]] = {name: [] for name in EDGES_OWN}
    for axis in (0, 1):
        rows = there if axis == 0 else there.T
        corner = _beyond(there, 1 - axis)
        usable = _aligned(share, axis, near_oblique) & ~(near_oblique & corner)
        ends = np.diff(np.pad(rows.astype(int), ((0, 0), (1, 1))), axis=1)
        (places, start), (_, stop) = np.nonzero(ends == 1), np.nonzero(ends == -1)
        at_edges = {name: np.zeros(len(rows)) for name in found}
        for cell, outer, far in ((start, 0, ""), (stop - 1, rows.shape[1] - 1, "far_")):
            chosen = usable[(places, cell) if axis == 0 else (cell, places)]
            place, cells, count = places[chosen], cell[chosen], (stop - start)[chosen]
            at = (place, cells) if axis == 0 else (cells, place)
            two = _taken(each, twist, at, axis, count, True, corner, notes) / square
            one, whole_row = two.copy(), count == rows.shape[1]
            ends_alone = at[0][whole_row], at[1][whole_row]
            one[whole_row] = (
                _taken(each, twist, ends_alone, axis, count[whole_row], False, corner, notes) / square
            )
            stretch, inside = twist.stretch[(*at, axis)], cells != outer
            strain = along_edge(axis, stretch[inside])
            rims[at[0][inside], at[1][inside]] += rank_one(two[inside], *strain)
            edge = place[~inside]
            at_edges[f"{far}edge_coupling"][edge] = stretch[~inside]
            at_edges[f"{far}strip_shear"][edge] = two[~inside]
            at_edges[f"{far}edge_shear"][edge] = one[~inside]
        for name, values in at_edges.items():
            found[name].append(values)
    of = {
        name: values[None]
        for name, values in zip(RIMS_OWN, np.moveaxis(rims, -1, 0), strict=True)
        if values.any()
    }
    edges = {name: either(*pair) for name, pair in found.items()}
    return replace(springs, of=springs.of | of, edges=edges), list(dict.fromkeys(notes))


def _taken(
    each: EachCell,
    twist: Twist,
    at: tuple[np.ndarray, np.ndarray],
    axis: int,
    count: np.ndarray,
    both: bool,
    corner: np.ndarray,
    notes: list[str],
) -> np.ndarray:
    """What rims across an axis add to the cells `at` the ends of runs of so many cells, times Σ z_k²
    [N·m]."""
    factor = np.ones(len(count))
    width, twisting, shear, shares, lost = (
        part[(*at, axis)] for part in (each.sides, *twist[:3], twist.lost)
    )
    for cells in np.unique(count):
        of = count == cells
        strips = [np.repeat(part[of, None], cells, axis=1) for part in (width, twisting, shear, shares)]
        factor[of] = edge_factors(strips[0], strips[1], strips[2], strips[3], lost[of], both)
    if not np.all(factor > 0.0):
        notes.append("no twisting stiffness of the cells along a rim makes it right")
        factor = np.where(np.isnan(factor), MOST, factor)
    return (np.where(corner[at], np.maximum(factor, AT_CORNERS), factor) - 1.0) * twisting


def _beyond(there: np.ndarray, axis: int) -> np.ndarray:
    """Whether cells have none beside them before or after along an axis of the plan, (rows, columns)."""
    rows = there.T if axis else there
    around = np.pad(rows, ((0, 0), (1, 1)))
    found = ~(around[:, :-2] & around[:, 2:])
    return found.T if axis else found


def _aligned(share: np.ndarray, axis: int, near_oblique: np.ndarray) -> np.ndarray:
    """Whether cells are whole, or cut along the rim that crosses an axis as a neighbour along it is, and not
    near an oblique one, (rows, columns)."""
    lines = share.T if axis == 0 else share
    around = np.pad(lines, ((0, 0), (1, 1)), constant_values=np.inf)
    alike = (np.abs(around[:, :-2] - lines) < ALIKE) | (np.abs(around[:, 2:] - lines) < ALIKE)
    return (share > 1.0 - ALIKE) | (~near_oblique & (alike.T if axis == 0 else alike))


def at_oblique_rims(
    rims: ObliqueRims, each: EachCell, twist: Twist, whole: moduli.Moduli
) -> tuple[np.ndarray, list[str]]:
    """Return what the layers' cells take times Σ z_k², (rows, columns, 6) [N·m], as `Springs.strains` has it,
    and notes; whole: moduli of the cells' springs."""
    there = each.there[rims.rows, rims.columns]
    rows, columns, part, n = (each_of[there] for each_of in rims)
    at = rows, columns
    t = np.stack([-n[:, 1], n[:, 0]], axis=1)
    states = np.stack([_strains(a, b) for a, b in ((n, n), (t, t), (n, t))], axis=1)
    bending = states @ whole.bending[at] @ np.swapaxes(states, 1, 2)
    twisting, stretch = (form(bending)[:, 0] for form in (sections.twisting, sections.stretch_by_twist))
    shear, free = (
        1.0 / (t**2 / stiffness[at]).sum(axis=1) for stiffness in (whole.free_shear, each.section.free_shear)
    )
    share = (t**2 * twist.shares[at][:, ::-1]).sum(axis=1)
    width, lost = np.sqrt(each.sides[at].prod(axis=1)), np.sqrt(twisting / free)
    strips = np.repeat([width, twisting, shear, share], STRIP, axis=1).reshape(4, -1, STRIP)
    factor = edge_factors(strips[0], strips[1], strips[2], strips[3], lost, False)
    notes = []
    if not np.all(factor > 0.0):
        notes.append("no twisting stiffness of the cells along an oblique rim makes it right")
        factor = np.where(np.isnan(factor), 1.0, factor)
    # γ_nt + r ε_tt, whose strains along x and y count twice in the first
    strain = ([2.0, 2.0, 1.0] * states[:, 2] + stretch[:, None] * [1.0, 1.0, 0.5] * states[:, 1]).T
    taken = np.zeros((*each.there.shape, len(RIMS_OWN)))
    np.add.at(taken, at, rank_one(part * (np.maximum(factor, AT_CORNERS) - 1.0) * twisting, *strain))
    return taken, notes


def _strains(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """ε1, ε2 and γ (m, 3) of the strain of directions a and b, (m, 2)."""
    return np.column_stack([a * b, a[:, 0] * b[:, 1] + a[:, 1] * b[:, 0]])
