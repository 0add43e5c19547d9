"""Energy of transverse shear in a sheet that is stretched and thins, over κ G h, with its derivatives.

A director of the length t that leans by the angle φ has t sin φ in the stretched sheet's plane, and stores
½ t² sin² φ; with γ = φ,α·d of the unit director and the sheet's C = 1 + 2E in its plane sin² φ = γᵀ C⁻¹ γ:

    W = ½ p Q,   Q = γᵀ (j² C⁻¹) γ,   p = t²/j²,   j² = det C.

j² C⁻¹ is linear in E. Voigt order (xx, yy, 2xy).
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from fem_reference.shell.laws import Response


class Slant(NamedTuple):
    """W (…), its derivatives by E (…, 3) and γ (…, 2), and by E E, E γ and γ γ."""

    energy: np.ndarray
    by_strain: np.ndarray
    by_slant: np.ndarray
    strains: np.ndarray
    mixed: np.ndarray
    slants: np.ndarray


def slant(share: Response, strain: np.ndarray, leaning: np.ndarray) -> Slant:
    """Return W of p and its derivatives, E (…, 3) and γ (…, 2)."""
    (p, first, second), (xx, yy, xy), (g1, g2) = (
        share,
        np.moveaxis(strain, -1, 0),
        np.moveaxis(leaning, -1, 0),
    )
    adjugate = np.array([[1.0 + 2.0 * yy, -xy], [-xy, 1.0 + 2.0 * xx]])
    matrix, none = np.moveaxis(adjugate, (0, 1), (-2, -1)), np.zeros_like(g1)
    pulled = (matrix @ leaning[..., None])[..., 0]
    of_strain = np.stack([np.stack(row, axis=-1) for row in ((none, 2 * g2), (2 * g1, none), (-g2, -g1))], -2)
    square, slope = np.sum(leaning * pulled, axis=-1), (of_strain @ leaning[..., None])[..., 0]
    both = first[..., :, None] * slope[..., None, :]
    p = p[..., None]
    return Slant(
        0.5 * share.energy * square,
        0.5 * (square[..., None] * first + p * slope),
        p * pulled,
        0.5 * (square[..., None, None] * second + both + both.swapaxes(-1, -2)),
        first[..., :, None] * pulled[..., None, :] + p[..., None] * of_strain,
        p[..., None] * matrix,
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
