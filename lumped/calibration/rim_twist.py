"""What free rims of a sheet with an outline or cutouts take off the twisting stiffness.

Any side of a cell with no cell beyond it is a rim. Along each row and each column of cells those that are
there form runs; a run is the strip of `lumped.calibration.edge_twist`, of cells like that at its end, and the
cell at a free end of it has the factor of a strip with as many cells. Ends within the sheet's rectangle are
free; ends at its edges are the supports' to say, and stand in `edge_shear` and `strip_shear`.

Towards an oblique rim it is the twisting moment in the rim's own axes that fades. Springs on 2 κ_nt + r κ_tt
there are strain springs and couplings in the grid's axes, of what of each cell lies within a cell's length l
of the rim, with the factor of a strip of cells of that width along the rim. Along a rim that is cut out of
the grid at any angle a lattice without them loses 0.9 to 0.98 of the width of twist that it loses along one
of its lines (`tests/lumped/calibration/test_oblique_rims.py`).
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from lumped import moduli
from lumped.calibration.cell_by_cell import EachCell
from lumped.calibration.edge_twist import AT_CORNERS, MOST, Twist, edge_factors, twist_of, with_edges
from lumped.calibration.oblique_rims import at_oblique_rims
from lumped.spring_constants import EDGES_OWN, RIMS_OWN, Springs, along_edge, either, rank_one

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
