"""What an oblique rim lets go of the twisting moment, as strain springs in the axes of the grid.

With n across the rim and t along it, D in their axes and the factor f of `lumped.calibration.edge_twist` of a
wide strip of cells as wide as the grid's, what of a cell lies within its own length of the rim takes
−(1 − f) D̃66/Σ z_k² on

    γ_nt + r ε_tt = (2 n₁ t₁ + r t₁²) ε₁ + (2 n₂ t₂ + r t₂²) ε₂ + (n₁ t₂ + n₂ t₁ + r t₁ t₂) γ,

S along the rim being 1/(t₁²/Sx + t₂²/Sy).
"""

from __future__ import annotations

import numpy as np

from lumped import sections
from lumped.calibration.cell_by_cell import EachCell
from lumped.calibration.edge_twist import AT_CORNERS, Twist, edge_factors
from lumped.coverage import ObliqueRims
from lumped.moduli import Moduli
from lumped.spring_constants import RIMS_OWN, rank_one

STRIP = 12  # cells across a strip whose far edge is not felt


def at_oblique_rims(
    rims: ObliqueRims, each: EachCell, twist: Twist, whole: Moduli
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
