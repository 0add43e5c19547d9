"""Laws of stress and strain of a thin sheet, σ_zz = 0: energy W per volume of the in-plane Green strain E.

    St Venant–Kirchhoff   W = ½ E : C : E, quadratic in Green's strain
    Biot                  W = ½ (U − 1) : C : (U − 1),   U² = 1 + 2E: linear in the elongation, as springs are
    neo-Hooke             W = ½ μ (tr C + c − 3) − μ ln J + ½ λ (ln J)²,   C = 1 + 2E,   J² = c det C,

the last with the stretch through the thickness, √c, such that nothing pulls there: μ (c − 1) + λ ln J = 0.
C of the first two is the plane-stress stiffness of `surface.materials`, which all three have at small strain.
With s = tr U, j = det U, P = ∂j/∂E = j C⁻¹ and g = ∂s/∂E = (1 + P)/s, and K = E/(1 − ν²), Biot's law is

    W = ½ K ((s − 2)² − 2 (1 − ν) det(U − 1)),     S = K ((s − 2) g + (1 − ν) (g − P)),

and neo-Hooke's stress S = μ (1 − c C⁻¹). What cancels at small strain is formed from E, to keep its digits.
Voigt order (xx, yy, 2xy), stresses without the 2. [Pa]
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from fem_reference.surface.materials import plane_stress, shear_modulus
from sheetbench.scenes import Material

_ONE = np.array([1.0, 1.0, 0.0])
_COFACTOR = np.array([[0.0, 2.0, 0.0], [2.0, 0.0, 0.0], [0.0, 0.0, -1.0]])  # ∂(cof C)/∂E
NEWTON_STEPS = 30
SETTLED = 1e-15  # of c


class Response(NamedTuple):
    """W (…) [Pa], S = ∂W/∂E (…, 3) [Pa] and ∂S/∂E (…, 3, 3) [Pa]."""

    energy: np.ndarray
    stress: np.ndarray
    tangent: np.ndarray


Law = Callable[[Material, np.ndarray], Response]


def st_venant_kirchhoff(material: Material, strain: np.ndarray) -> Response:
    """Of strains (…, 3)."""
    stiffness = plane_stress(material)
    stress = strain @ stiffness
    energy = 0.5 * np.sum(strain * stress, axis=-1)
    return Response(energy, stress, np.broadcast_to(stiffness, (*strain.shape, 3)))


def biot(material: Material, strain: np.ndarray) -> Response:
    """Of strains (…, 3)."""
    area, by_area, second = _area(strain)
    area_change = _change_of_determinant(strain) / (area + 1.0)  # j − 1
    square_change = 2.0 * (strain[..., 0] + strain[..., 1]) + 2.0 * area_change  # s² − 4
    with np.errstate(invalid="ignore"):  # see `_area`
        trace = np.sqrt(4.0 + square_change)
    excess = square_change / (trace + 2.0)  # s − 2
    slope = (_ONE + by_area) / trace[..., None]
    rest = (area_change[..., None] * _ONE - strain @ _COFACTOR) / area[..., None]  # 1 − P
    bare = (rest - excess[..., None] * by_area) / trace[..., None]  # g − P
    nu, stiffness = material.poisson, material.young / (1.0 - material.poisson**2)
    both = _outer(slope, slope)
    curving = (second - both) / trace[..., None, None]
    energy = 0.5 * excess**2 - (1.0 - nu) * (area_change - excess)
    stress = excess[..., None] * slope + (1.0 - nu) * bare
    tangent = both + (excess + 1.0 - nu)[..., None, None] * curving - (1.0 - nu) * second
    return Response(stiffness * energy, stiffness * stress, stiffness * tangent)


def neo_hookean(material: Material, strain: np.ndarray) -> Response:
    """Of strains (…, 3)."""
    shear = shear_modulus(material)
    bulk = 2.0 * shear * material.poisson / (1.0 - 2.0 * material.poisson)  # λ
    change = _change_of_determinant(strain)
    with np.errstate(invalid="ignore", divide="ignore"):  # inside out: not a number, which ends the step
        logarithm = np.log1p(change)
        thinning = _thinning(bulk / shear, logarithm)  # c − 1
        of_volume = 0.5 * (logarithm + np.log1p(thinning))  # ln J
    inverse = (_ONE + strain @ _COFACTOR) / (1.0 + change)[..., None]
    c = 1.0 + thinning
    energy = shear * (strain[..., 0] + strain[..., 1] + 0.5 * thinning - of_volume)
    energy = energy + 0.5 * bulk * of_volume**2
    away = (change[..., None] * _ONE - strain @ _COFACTOR) / (1.0 + change)[..., None]  # 1 − C⁻¹
    stress = shear * (away - thinning[..., None] * inverse)
    both = _outer(inverse, inverse)
    falling = bulk / (shear + bulk / (2.0 * c))  # −∂c/∂E = falling C⁻¹
    of_inverse = _COFACTOR / (1.0 + change)[..., None, None] - 2.0 * both
    tangent = shear * (falling[..., None, None] * both - c[..., None, None] * of_inverse)
    return Response(energy, stress, tangent)


def _thinning(ratio: float, logarithm: np.ndarray) -> np.ndarray:
    """c − 1 of (c − 1) + ½ ratio (ln det C + ln c) = 0, by Newton's method on ln c, where that is convex."""
    x = -ratio * logarithm / (2.0 + ratio)
    for _ in range(NEWTON_STEPS):
        step = (np.expm1(x) + 0.5 * ratio * (logarithm + x)) / (np.exp(x) + 0.5 * ratio)
        x = x - step
        if not np.any(np.abs(step) > SETTLED):
            break
    return np.asarray(np.expm1(x))


def _area(strain: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """j = √det C (…), P = ∂j/∂E (…, 3), ∂P/∂E (…, 3, 3)."""
    with np.errstate(invalid="ignore"):  # inside out: not a number, which ends the step
        area = np.sqrt(1.0 + _change_of_determinant(strain))
    first = (_ONE + strain @ _COFACTOR) / area[..., None]
    return area, first, (_COFACTOR - _outer(first, first)) / area[..., None, None]


def _change_of_determinant(strain: np.ndarray) -> np.ndarray:
    """det C − 1."""
    xx, yy, twice_xy = (strain[..., i] for i in range(3))
    return np.asarray(2.0 * (xx + yy) + 4.0 * xx * yy - twice_xy**2)


def _outer(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    return a[..., :, None] * b[..., None, :]


LAWS: dict[str, Law] = {
    "st-venant-kirchhoff": st_venant_kirchhoff,
    "biot": biot,
    "neo-hookean": neo_hookean,
}
