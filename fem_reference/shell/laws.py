"""Stress–strain laws of a thin sheet, σ_zz = 0: energy W per volume of the in-plane Green strain E.

    St Venant–Kirchhoff   W = ½ E : C : E, quadratic in Green's strain
    Biot                  W = ½ (U − 1) : C : (U − 1),   U² = 1 + 2E: linear in the elongation, as springs are
    rubbers               W = f(I₁ − 3) + c₀₁ (I₂ − 3) − m ln J + ½ Λ ln² J,   m = 2 f′(0) + 4 c₀₁

C of the first two is the plane-stress stiffness of `surface.materials`, which all have at small strain;
`sheetbench.scenes.objects.material` defines f, c₀₁ and Λ. Let s = tr U, j = det U, P = ∂j/∂E = j C⁻¹,
g = ∂s/∂E = (1 + P)/s, and K = E/(1 − ν²); then Biot's law is

    W = ½ K ((s − 2)² − 2 (1 − ν) det(U − 1)),     S = K ((s − 2) g + (1 − ν) (g − P)).

A rubber has I₁ = tr C + c, I₂ = det C + c tr C and J² = c det C, with C = 1 + 2E in the plane. The stretch
through the thickness, √c, follows from zero stress there, ∂W/∂c = 0: c k + ½ (Λ ln J − m) = 0 with
k = f′ + c₀₁ tr C. Then

    S = 2 f′ (1 − c C⁻¹) + 2 c₀₁ (c 1 + (det C − c tr C) C⁻¹),
    ∂S/∂E = W_EE − W_Ec ⊗ W_Ec/W_cc.

Differences that cancel at small strain are formed from E, to keep their digits.
Voigt order (xx, yy, 2xy), stresses without the 2. [Pa]
"""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from fem_reference.surface.materials import plane_stress, shear_modulus
from fem_reference.surface.rubber import slopes
from fem_reference.surface.triad import Triad, outer
from sheetbench.scenes import Material
from sheetbench.scenes.objects.material import WORDS, Energy

_ONE = np.array([1.0, 1.0, 0.0])
_COFACTOR = np.array([[0.0, 2.0, 0.0], [2.0, 0.0, 0.0], [0.0, 0.0, -1.0]])  # ∂(cof C)/∂E
NEWTON_STEPS = 30
SETTLED, NEARLY = 1e-15, 1e-12  # steps of ln c: at which iterations end, and up to which c is accepted


def st_venant_kirchhoff(material: Material, strain: np.ndarray) -> Triad:
    """Return the response of St Venant–Kirchhoff's law at strains (…, 3)."""
    stiffness = plane_stress(material)
    stress = strain @ stiffness
    energy = 0.5 * np.sum(strain * stress, axis=-1)
    return Triad(energy, stress, np.broadcast_to(stiffness, (*strain.shape, 3)))


def biot(material: Material, strain: np.ndarray) -> Triad:
    """Return the response of Biot's law at strains (…, 3)."""
    area, by_area, second = determinant(strain).power(0.5)  # inside out: not a number, which ends the step
    area_change = _change_of_determinant(strain) / (area + 1.0)  # j − 1
    square_change = 2.0 * (strain[..., 0] + strain[..., 1]) + 2.0 * area_change  # s² − 4
    with np.errstate(invalid="ignore"):
        trace = np.sqrt(4.0 + square_change)
    excess = square_change / (trace + 2.0)  # s − 2
    slope = (_ONE + by_area) / trace[..., None]
    rest = (area_change[..., None] * _ONE - strain @ _COFACTOR) / area[..., None]  # 1 − P
    bare = (rest - excess[..., None] * by_area) / trace[..., None]  # g − P
    nu, stiffness = material.poisson, material.young / (1.0 - material.poisson**2)
    dyad = outer(slope, slope)
    curving = (second - dyad) / trace[..., None, None]
    energy = 0.5 * excess**2 - (1.0 - nu) * (area_change - excess)
    stress = excess[..., None] * slope + (1.0 - nu) * bare
    tangent = dyad + (excess + 1.0 - nu)[..., None, None] * curving - (1.0 - nu) * second
    return Triad(stiffness * energy, stiffness * stress, stiffness * tangent)


def rubber(energy: Energy, poisson: float, strain: np.ndarray) -> Triad:
    """Return the response of a rubber at strains (…, 3)."""
    bulk, c01 = energy.volume(poisson), energy.c01
    at_rest = energy.c10 + 2.0 * c01  # ½ m
    change, trace = _change_of_determinant(strain), 2.0 * (strain[..., 0] + strain[..., 1])  # of C
    # inside out: not a number, which ends the step
    with np.errstate(invalid="ignore", divide="ignore", over="ignore"):
        logarithm = np.log1p(change)
        thinning = _thinning(energy, bulk, trace, logarithm)  # c − 1
        of_volume = 0.5 * (logarithm + np.log1p(thinning))  # ln J
        excess, rise, second = slopes(energy, trace + thinning)
    c, inverse = 1.0 + thinning, (_ONE + strain @ _COFACTOR) / (1.0 + change)[..., None]
    value = energy.c10 * (trace + thinning - 2.0 * of_volume) + excess + 0.5 * bulk * of_volume**2
    value = value + c01 * (change + trace + 2.0 * thinning + thinning * trace - 4.0 * of_volume)
    one_less_inverse = (change[..., None] * _ONE - strain @ _COFACTOR) / (1.0 + change)[..., None]  # 1 − C⁻¹
    by_first = one_less_inverse - thinning[..., None] * inverse
    by_second = c[..., None] * one_less_inverse + (change - thinning - c * trace)[..., None] * inverse
    stress = 2.0 * (energy.c10 + rise)[..., None] * by_first + 2.0 * c01 * by_second
    dyad = outer(inverse, inverse)
    pull = bulk * of_volume - 2.0 * at_rest  # Λ ln J − m
    of_inverse = _COFACTOR / (1.0 + change)[..., None, None] - 2.0 * dyad
    tangent = 4.0 * second[..., None, None] * outer(_ONE, _ONE) + 2.0 * c01 * _COFACTOR + bulk * dyad
    tangent = tangent + pull[..., None, None] * of_inverse
    mixed = 2.0 * (second + c01)[..., None] * _ONE + (0.5 * bulk / c)[..., None] * inverse
    across = second + (0.25 * bulk - 0.5 * pull) / c**2
    return Triad(value, stress, tangent - outer(mixed, mixed) / across[..., None, None])


def _thinning(energy: Energy, bulk: float, trace: np.ndarray, logarithm: np.ndarray) -> np.ndarray:
    """Return c − 1 with ∂W/∂c = 0 at tr C − 2 and ln det C, by Newton's method on ln c from J = 1, or nan."""
    upper = np.log(np.maximum(1.0 + energy.limit - trace, 0.0)) if energy.limit else np.inf  # of ln c
    x = np.minimum(-logarithm, upper - 0.5)
    for _ in range(NEWTON_STEPS):
        c = np.exp(x)
        _, rise, second = slopes(energy, trace + np.expm1(x))
        of_law = energy.c10 + rise + energy.c01 * (2.0 + trace)
        of_volume = 0.5 * bulk * 0.5 * (logarithm + x)  # ½ Λ ln J
        gap = np.expm1(x) * of_law + rise + energy.c01 * trace + of_volume
        next_x = x - gap / (c * of_law + c * c * second + 0.25 * bulk)
        next_x = np.where(next_x < upper, next_x, 0.5 * (x + upper))
        moved, x = np.abs(next_x - x), next_x
        if not np.any(moved > SETTLED):
            break
    return np.asarray(np.where(moved <= NEARLY, np.expm1(x), np.nan))


def determinant(strain: np.ndarray) -> Triad:
    """Return j² = det C and its derivatives by the strain (…, 3)."""
    first = 2.0 * (_ONE + strain @ _COFACTOR)
    twice = np.broadcast_to(2.0 * _COFACTOR, (*strain.shape, 3))
    return Triad(1.0 + _change_of_determinant(strain), first, twice)


def _change_of_determinant(strain: np.ndarray) -> np.ndarray:
    """Return det C − 1."""
    xx, yy, twice_xy = (strain[..., i] for i in range(3))
    return np.asarray(2.0 * (xx + yy) + 4.0 * xx * yy - twice_xy**2)


class Law(NamedTuple):
    """Law of a sheet's material. response: of a material at strains (…, 3); stands_any_strain: whether it is
    meant for large strains, at which its sheets get thinner."""

    response: Callable[[Material, np.ndarray], Triad]
    stands_any_strain: bool = True

    def thickness(self, material: Material, strain: np.ndarray) -> Triad:
        """Return the stretch of the thickness j^(−ν/(1 − ν)) (…) and its derivatives by the strain (…, 3). It
        holds at small strains, and at any strain for ν = ½; it is 1 for a law that is not for large strains.
        """
        if not self.stands_any_strain:
            zeros = np.zeros_like(strain)
            return Triad(1.0 + zeros[..., 0], zeros, outer(zeros, zeros))
        return determinant(strain).power(-0.5 * material.poisson / (1.0 - material.poisson))


LAWS = {
    "st-venant-kirchhoff": Law(st_venant_kirchhoff, False),
    "biot": Law(biot, False),
    "neo-hookean": Law(lambda of, strain: rubber(Energy(0.5 * shear_modulus(of)), of.poisson, strain)),
} | dict.fromkeys(WORDS, Law(lambda of, strain: rubber(of.energy, of.poisson, strain)))
