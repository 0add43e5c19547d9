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
from lumped.coverage import ObliqueRims
from lumped.moduli import Moduli
from lumped.sections import Section
from sheetbench.scenes import SpringSet

STRIP = 12  # cells across a strip whose far edge is not felt
DIGITS = 12  # to which strips are distinguished


def at_oblique_rims(
    rims: ObliqueRims, kinds: Kinds, found: Calibration, own: list[SpringSet]
) -> tuple[np.ndarray, list[str]]:
    """Return what the layers' cells take, (rows, columns, 6) [N/m], as `constants.of_strains` has it, and
    notes. own: the springs of each kind of cells."""
    layers, lz = found.grid[2], found.springs.layer_distance
    square = moduli.second_moment(layers) * lz**2
    taken = np.zeros((*kinds.which.shape, len(constants.RIMS_OWN)))
    notes: list[str] = []
    of_kind = [
        (moduli.of_springs(springs, (*sides, lz), layers), of_cell(springs, (*sides, lz), layers)[2])
        for springs, (sides, _) in zip(own, kinds.of, strict=True)
    ]
    known: dict[tuple[int, float, float], np.ndarray] = {}
    for row, column, part, (nx, ny) in zip(*(each.tolist() for each in rims), strict=True):
        kind = int(kinds.which[row, column])
        if (key := (kind, nx, ny)) not in known:
            known[key] = _of_cell(np.array([nx, ny]), *of_kind[kind], *kinds.of[kind], notes)
        taken[row, column] += part * kinds.factor[row, column] / square * known[key]
    return taken, notes


def _of_cell(
    n: np.ndarray, whole: Moduli, by_diagonals: list[float], sides: Sides, section: Section, notes: list[str]
) -> np.ndarray:
    """Return −(1 − f) D̃66 times the products of what each strain counts, (6,) [N·m], of a cell all of which
    is near a rim of normal n; whole: of its springs; by_diagonals: the furthest diagonals' share of S."""
    t = np.array([-n[1], n[0]])
    states = np.array([[*(a * b), a[0] * b[1] + a[1] * b[0]] for a, b in ((n, n), (t, t), (n, t))])
    bending = states @ whole.bending @ states.T
    twisting, stretch = (float(form(bending)[0]) for form in (sections.twisting, sections.stretch_by_twist))
    shear, free = (float(1.0 / (t**2 @ (1.0 / part))) for part in (whole.shear, section.free_shear))
    strip = (
        math.sqrt(sides[0] * sides[1]),
        twisting,
        shear,
        float(t**2 @ by_diagonals),
        math.sqrt(twisting / free),
    )
    width, rigidity, sheared, share, lost = (float(f"{each:.{DIGITS}g}") for each in strip)
    factor = edge_factor(STRIP, width, rigidity, sheared, share, lost, False)
    if factor is None:
        notes.append("no twisting stiffness of the cells along an oblique rim makes it right")
        factor = 1.0
    strain = 2.0 * n * t + stretch * t * t
    skew = n[0] * t[1] + n[1] * t[0] + stretch * t[0] * t[1]
    return constants.rank_one((max(factor, AT_CORNERS) - 1.0) * twisting, *strain, skew)
