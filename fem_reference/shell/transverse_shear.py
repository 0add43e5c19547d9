"""Energy of transverse shear in a stretched, thinning sheet, over κ G h, with its derivatives.

A sheet of the thickness t whose director is inclined by the angle φ is sheared by t tan φ: the thickness is
measured along the normal, as the change of area requires, so that an inclined director is longer. It stores
½ t² tan² φ, the energy of neo-Hooke's law in that shear, and is steeper at a larger inclination.
½ t² sin² φ, of a director that keeps its length, is flat at 90° and beyond 45° lets all of an edge's shear
gather in one row of elements. Let γ = φ,α·d of the unit director and C = 1 + 2E in the sheet's plane: then
sin² φ = γᵀ C⁻¹ γ and

    W = ½ t² T,   T = Q/(j² − Q),   Q = γᵀ (j² C⁻¹) γ,   j² = det C.

j² C⁻¹ is linear in E. W is nan where φ reaches 90°, which ends a step. Voigt order (xx, yy, 2xy).
"""

import numpy as np

from fem_reference.shell.laws import determinant
from fem_reference.surface.triad import Triad

_ADJUGATE = np.array([[[0.0, 0.0], [0.0, 2.0]], [[2.0, 0.0], [0.0, 0.0]], [[0.0, -1.0], [-1.0, 0.0]]])  # by E


def shear_energy(poisson: float, strain: np.ndarray, leaning: np.ndarray) -> Triad:
    """Return W and derivatives by E and γ (…, 5), at E (…, 3) and γ (…, 2), in `Law.thickness`."""
    area, by_area, areas = determinant(strain)
    form = np.eye(2) + np.einsum("...k,kij->...ij", strain, _ADJUGATE)  # j² C⁻¹
    mixed = 2.0 * np.einsum("kij,...j->...ki", _ADJUGATE, leaning)
    turned = np.einsum("...ij,...j->...i", form, leaning)
    by_strain = 0.5 * np.einsum("...ki,...i->...k", mixed, leaning)
    square = Triad(area, np.append(by_area, 0.0 * turned, -1), _symmetric(areas, 0.0 * mixed, 0.0 * form))
    by_both, second = np.append(by_strain, 2.0 * turned, -1), _symmetric(0.0 * areas, mixed, 2.0 * form)
    of_leaning = Triad(np.sum(leaning * turned, axis=-1), by_both, second)  # Q
    cosine = Triad(*(2.0 * (a - q) for a, q in zip(square, of_leaning, strict=True)))  # 2 j² cos² φ
    cosine = cosine._replace(value=np.where(cosine.value > 0.0, cosine.value, np.nan))
    return square.power(-poisson / (1.0 - poisson)).times(of_leaning).times(cosine.power(-1.0))


def linear_shear_energy(leaning: np.ndarray) -> Triad:
    """Return ½ γ² and its derivatives by E and γ (…, 5)."""
    first, twice = np.zeros((*leaning.shape[:-1], 5)), np.zeros((*leaning.shape[:-1], 5, 5))
    first[..., 3:], twice[..., 3:, 3:] = leaning, np.eye(2)
    return Triad(0.5 * np.sum(leaning**2, axis=-1), first, twice)


def _symmetric(strains: np.ndarray, mixed: np.ndarray, slants: np.ndarray) -> np.ndarray:
    return np.block([[strains, mixed], [mixed.swapaxes(-1, -2), slants]])
