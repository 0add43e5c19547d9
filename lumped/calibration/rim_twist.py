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
from typing import Any

import numpy as np

from lumped import moduli
from lumped import spring_constants as constants
from lumped.calibration.calibration import Calibration, either
from lumped.calibration.cell_by_cell import Kinds
from lumped.calibration.edge_twist import AT_CORNERS, MOST, edge_factor, of_cell, with_edges
from lumped.calibration.oblique_rims import at_oblique_rims
from sheetbench.scenes import Sheet, SpringSet

ALIKE = 1e-9  # shares of cells that one straight line cuts


def with_twist(sheet: Sheet, kinds: Kinds, found: Calibration) -> Calibration:
    """The calibration with the twist of its edges, and of its rims where cells are absent or cut."""
    if found.present is None and (found.cells is None or found.cells.rims is None):
        springs, notes = with_edges(sheet, found.grid, found.springs, found.grading, found.cells)
    else:
        springs, notes = with_rims(kinds, found)
    return replace(found, springs=springs, remarks=(*found.remarks, *notes))


def with_rims(kinds: Kinds, found: Calibration) -> tuple[SpringSet, list[str]]:
    """The springs of a calibration with the twist of its cells' rims, and a note for rims where no factor
    will do."""
    assert found.cells is not None
    springs, layers, there = found.springs, found.grid[2], found.cells.per_area > 0.0
    share = there.astype(float) if found.cells.share is None else found.cells.share
    lost = np.broadcast_to(found.cells.layer_width, (*there.shape, 2))
    square = moduli.second_moment(layers) * springs.layer_distance**2
    first = {int(n): np.argwhere((kinds.which == n) & (kinds.factor == 1.0))[0] for n in range(len(kinds.of))}
    own = [constants.of_cell(springs, *first[n]) for n in range(len(kinds.of))]
    of_kind = [
        of_cell(cell, (*sides, springs.layer_distance), layers)
        for cell, (sides, _) in zip(own, kinds.of, strict=True)
    ]
    rims = np.zeros((*there.shape, len(constants.RIMS_OWN)))
    notes: list[str] = []
    factors: dict[tuple[int, int, int, bool], float] = {}

    def taken(at: tuple[int, int], axis: int, count: int, both: bool) -> float:
        """What a rim across an axis adds to the cell `at` the end of a run [N/m]."""
        kind = int(kinds.which[at])
        key = kind, axis, count, both
        twisting, shear, by_diagonals, _ = of_kind[kind]
        if key not in factors:
            width = kinds.of[kind][0][axis]
            strip = width, twisting[axis], shear[1 - axis], by_diagonals[1 - axis]
            factor = edge_factor(count, *strip, float(lost[at][axis]), both)
            if factor is None:
                notes.append("no twisting stiffness of the cells along a rim makes it right")
            factors[key] = MOST if factor is None else factor
        corner = any(_beyond(there, at, 1 - axis))
        factor = max(factors[key], AT_CORNERS) if corner else factors[key]
        return (factor - 1.0) * twisting[axis] * float(kinds.factor[at]) / square

    near_oblique = np.zeros(there.shape, dtype=bool)
    if found.cells.rims is not None and not springs.rubber:
        near_oblique[found.cells.rims.rows, found.cells.rims.columns] = True
        at_oblique, notes = at_oblique_rims(found.cells.rims, kinds, found, own)
        rims += at_oblique
    edges: dict[str, list[Any]] = {name: [] for name in constants.EDGES_OWN}
    for axis in (0, 1):
        rows = np.moveaxis(there, 1 - axis, 1)
        at_edges = {name: np.zeros(len(rows)) for name in edges}
        for place, row in enumerate(rows):
            ends = np.flatnonzero(np.diff(np.concatenate([[0], row, [0]]))).reshape(-1, 2)
            for start, stop in ends.tolist():
                whole = start == 0 and stop == len(row)
                for cell, outer, far in ((start, 0, ""), (stop - 1, len(row) - 1, "far_")):
                    at = (place, cell) if axis == 0 else (cell, place)
                    corner = near_oblique[at] and any(_beyond(there, at, 1 - axis))
                    if corner or not _aligned(share, at, axis, near_oblique):
                        continue
                    stretch = of_kind[int(kinds.which[at])][3][axis]
                    if cell != outer:
                        strain = (0.0, stretch, 1.0) if axis == 0 else (stretch, 0.0, 1.0)
                        rims[at] += constants.rank_one(taken(at, axis, stop - start, True), *strain)
                        continue
                    at_edges[f"{far}edge_coupling"][place] = stretch
                    for name, both in (("edge", not whole), ("strip", True)):
                        at_edges[f"{far}{name}_shear"][place] = taken(at, axis, stop - start, both)
        for name, values in at_edges.items():
            edges[name].append(tuple(values.tolist()))
    update: dict[str, Any] = {name: either(*both) for name, both in edges.items()}
    for name, values in zip(constants.RIMS_OWN, np.moveaxis(rims, -1, 0), strict=True):
        if values.any():
            update[name] = tuple(map(tuple, values.tolist()))
    return springs.model_copy(update=update), list(dict.fromkeys(notes))


def _beyond(there: np.ndarray, at: tuple[int, int], axis: int) -> tuple[bool, bool]:
    """Whether the cell has none beside it before and after along an axis of the plan."""
    along = there[:, at[1]] if axis else there[at[0]]
    place = at[1 - axis]
    return place == 0 or not along[place - 1], place == len(along) - 1 or not along[place + 1]


def _aligned(share: np.ndarray, at: tuple[int, int], axis: int, near_oblique: np.ndarray) -> bool:
    """Whether the cell is whole, or cut along the rim that crosses an axis as a neighbour along it is, and
    not near an oblique one."""
    if share[at] > 1.0 - ALIKE:
        return True
    if near_oblique[at]:
        return False
    line, place = (share[:, at[1]], at[0]) if axis == 0 else (share[at[0]], at[1])
    beside = line[max(place - 1, 0) : place + 2]
    return int(np.sum(np.abs(beside - share[at]) < ALIKE)) > 1
