"""What an oblique rim lets go of the twisting moment, as strain springs in the axes of the grid.

With n across the rim and t along it, D in their axes and the factor f of `lumped.calibration.edge_twist` of a
wide strip of cells as wide as the grid's, what of a cell lies within its own length of the rim takes
−(1 − f) D̃66/Σ z_k² on

    γ_nt + r ε_tt = (2 n₁ t₁ + r t₁²) ε₁ + (2 n₂ t₂ + r t₂²) ε₂ + (n₁ t₂ + n₂ t₁ + r t₁ t₂) γ,

S along the rim being 1/(t₁²/Sx + t₂²/Sy).
"""

from __future__ import annotations

import math

import numpy as np

from lumped import moduli, sections
from lumped import spring_constants as constants
from lumped.calibration.calibration import Calibration
from lumped.calibration.cell_by_cell import Kinds, Sides
from lumped.calibration.edge_twist import AT_CORNERS, edge_factor, of_cell
from lumped.sections import Section
from sheetbench.scenes import SpringSet

STRIP = 12  # cells across a strip whose far edge is not felt
DIGITS = 9  # to which normals are distinguished


def at_oblique_rims(rims: np.ndarray, kinds: Kinds, found: Calibration, own: list[SpringSet]) -> np.ndarray:
    """Return what the layers' cells take, (rows, columns, 6) [N/m], as `constants.of_strains` has it. rims:
    as `lumped.coverage.oblique_rims`; own: the springs of each kind of cells."""
    assert found.cells is not None
    layers = found.grid[2]
    square = moduli.second_moment(layers) * found.springs.layer_distance**2
    taken = np.zeros((*rims.shape[:2], len(constants.RIMS_OWN)))
    known: dict[tuple[int, bytes], np.ndarray] = {}
    for row, column in np.argwhere(rims.any(axis=(2, 3))).tolist():
        part = float(np.trace(rims[row, column]))
        across = np.round(rims[row, column] / part, DIGITS)
        kind = int(kinds.which[row, column])
        key = kind, across.tobytes()
        if key not in known:
            sides = kinds.of[kind][0]
            known[key] = _of_cell(own[kind], sides, layers, kinds.of[kind][1], across)
        taken[row, column] = part * kinds.factor[row, column] / square * known[key]
    return taken


def _of_cell(springs: SpringSet, sides: Sides, layers: int, section: Section, across: np.ndarray) -> np.ndarray:
    """Return −(1 − f) D̃66 times the products of what each strain counts, (6,) [N·m], of a cell all of which
    is near a rim; across: n nᵀ."""
    whole = moduli.of_springs(springs, (*sides, springs.layer_distance), layers)
    n = np.array([math.sqrt(across[0, 0]), math.copysign(math.sqrt(across[1, 1]), across[0, 1])])
    t = np.array([-n[1], n[0]])
    turned = np.stack([[a[0] * b[0], a[1] * b[1], a[0] * b[1] + a[1] * b[0]] for a, b in ((n, n), (t, t), (n, t))])
    turned[:2, 2] = 2.0 * n[0] * n[1], 2.0 * t[0] * t[1]
    bending = turned @ whole.bending @ turned.T
    twisting, stretch = (form(bending)[0] for form in (sections.twisting, sections.stretch_by_twist))
    shear, free = (1.0 / (t**2 @ (1.0 / part)) for part in (whole.shear, section.free_shear))
    by_diagonals = t**2 @ of_cell(springs, (*sides, springs.layer_distance), layers)[2]
    lost = math.sqrt(twisting / free)
    factor = edge_factor(STRIP, math.sqrt(sides[0] * sides[1]), twisting, shear, by_diagonals, lost, False)
    strain = [2.0 * n * t + stretch * t * t, n[0] * t[1] + n[1] * t[0] + stretch * t[0] * t[1]]
    return constants.rank_one((max(factor, AT_CORNERS) - 1.0) * twisting, *strain[0], strain[1])
