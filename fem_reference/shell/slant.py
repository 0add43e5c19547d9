"""Energy of transverse shear in a sheet that is stretched and thins, over κ G h, with its derivatives.

A sheet of the thickness t whose director leans by the angle φ is sheared by t tan φ: the thickness is
measured along the normal, as the area's change asks for it, and a director that leans is longer. It stores
½ t² tan² φ, which is what neo-Hooke's law has in that shear, and is steeper the farther it leans.
½ t² sin² φ, of a director that keeps its length, is flat at 90° and beyond 45° lets all of an edge's shear
gather in one row of elements. With γ = φ,α·d of the unit director and the sheet's C = 1 + 2E in its plane
sin² φ = γᵀ C⁻¹ γ:

    W = ½ t² T,   T = Q/(j² − Q),   Q = γᵀ (j² C⁻¹) γ,   j² = det C.

j² C⁻¹ is linear in E. Not a number where φ is 90°, which ends a step. Voigt order (xx, yy, 2xy).
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from fem_reference.shell.laws import Response, outer
from fem_reference.surface.materials import times


class Slant(NamedTuple):
    """W (…), its derivatives by E (…, 3) and γ (…, 2), and by E E, E γ and γ γ."""

    energy: np.ndarray
    by_strain: np.ndarray
    by_slant: np.ndarray
    strains: np.ndarray
    mixed: np.ndarray
    slants: np.ndarray


def slant(square: Response, area: Response, strain: np.ndarray, leaning: np.ndarray) -> Slant:
    """Return W and its derivatives, t² and j² with theirs by E, E (…, 3) and γ (…, 2)."""
    (xx, yy, xy), (g1, g2) = np.moveaxis(strain, -1, 0), np.moveaxis(leaning, -1, 0)
    adjugate = np.array([[1.0 + 2.0 * yy, -xy], [-xy, 1.0 + 2.0 * xx]])
    matrix, none = np.moveaxis(adjugate, (0, 1), (-2, -1)), np.zeros_like(g1)
    turned = (matrix @ leaning[..., None])[..., 0]  # ½ ∂Q/∂γ
    turned_by = np.stack([np.stack(row, axis=-1) for row in ((none, 2 * g2), (2 * g1, none), (-g2, -g1))], -2)
    q, q_by = np.sum(leaning * turned, axis=-1), (turned_by @ leaning[..., None])[..., 0]
    a, a_by, a_twice = area
    left = np.where(a > q, a - q, np.nan)  # j² cos² φ
    a2, q2, a3, q3 = a / left**2, q / left**2, a / left**3, q / left**3
    tan = q / left
    tan_by = a2[..., None] * q_by - q2[..., None] * a_by
    tan_strains = times(2.0 * a3, outer(q_by, q_by)) + times(2.0 * q3, outer(a_by, a_by))
    tan_strains -= times(a3 + q3, outer(q_by, a_by) + outer(a_by, q_by)) + times(q2, a_twice)
    tan_turn = 2.0 * a2[..., None] * turned
    by_left = a_by / left[..., None] ** 2 - 2.0 * a3[..., None] * (a_by - q_by)
    tan_mixed = 2.0 * (outer(by_left, turned) + times(a2, turned_by))
    tan_turns = times(2.0 * a2, matrix) + times(8.0 * a3, outer(turned, turned))
    t2, t2_by, t2_twice = square
    both = outer(t2_by, tan_by)
    return Slant(
        0.5 * t2 * tan,
        0.5 * (tan[..., None] * t2_by + t2[..., None] * tan_by),
        0.5 * t2[..., None] * tan_turn,
        0.5 * (times(tan, t2_twice) + both + both.swapaxes(-1, -2) + times(t2, tan_strains)),
        0.5 * (outer(t2_by, tan_turn) + times(t2, tan_mixed)),
        0.5 * times(t2, tan_turns),
    )


def linear(leaning: np.ndarray) -> Slant:
    """Return ½ γ² and its derivatives."""
    none, one = np.zeros((*leaning.shape[:-1], 3)), np.eye(2)
    energy = 0.5 * np.sum(leaning**2, axis=-1)
    return Slant(
        energy,
        none,
        leaning,
        none[..., None] * np.ones(3),
        none[..., None] * np.ones(2),
        none[..., :1, None] + one,
    )
