"""Hyperelastic laws of the solid, split so that the stiff volumetric part can be projected.

    W(E) = W₀(E) + ½ Λ ϑ(E)²

λ, μ are Lamé's constants; ϑ measures the change of volume and alone grows stiff as ν → ½:

    St Venant–Kirchhoff   W₀ = μ E : E                        ϑ = tr E,         Λ = λ
    fibres                W₀ = ½ E : (C − Λ 1 ⊗ 1) : E        ϑ = tr E          (`_green_bulk`)
    rubbers               W₀ = f(x) + c₀₁ (I₂ − 3) − m ln J   ϑ = ln J,   C = 2E + 1,   J² = det C

with x = I₁ − 3 = 2 tr E, I₂ − 3 = 2 x + ½ x² − 2 E : E and m = 2 f′(0) + 4 c₀₁;
`sheetbench.scenes.objects.material` defines f, c₀₁ and Λ.

Green–Lagrange strain E and second Piola–Kirchhoff stress in Voigt order (xx, yy, zz, 2xy, 2yz, 2xz), stresses
without the 2. Every law is a triad: density → stress → tangent, of W₀ and of ϑ. All have one
small-strain limit.
Source: Bonet & Wood, Nonlinear Continuum Mechanics (2008), ch. 6. [Pa]
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from fem_reference.surface.biquadratic import IN_SPACE, pulled_back
from fem_reference.surface.plies import in_space
from fem_reference.surface.rubber import slopes
from fem_reference.surface.triad import Triad
from sheetbench.scenes import Constants, Material
from sheetbench.scenes.objects.material import WORDS, Energy

_TRACE = np.array([1.0, 1.0, 1.0, 0.0, 0.0, 0.0])
_DOUBLE = np.diag([2.0, 2.0, 2.0, 1.0, 1.0, 1.0])


@dataclass(frozen=True)
class SolidLaw:
    """Law of a solid's material, in two triads. distortion: material and E → triad of W₀ [Pa]; volume: E →
    triad of ϑ; bulk: Λ [Pa] of a material; quadratic: whether W is quadratic in E, as in laws for small
    strains only."""

    distortion: Callable[[Any, np.ndarray], Triad]
    volume: Callable[[np.ndarray], Triad]
    bulk: Callable[[Any], float]
    quadratic: bool = False


def lame(material: Material | Constants) -> tuple[float, float]:
    """Return λ, μ [Pa] of a material, or of each element's own constants."""
    shear = material.young / (2.0 * (1.0 + material.poisson))
    return 2.0 * shear * material.poisson / (1.0 - 2.0 * material.poisson), shear


def _green_bulk(material: Material | Constants) -> float:
    """Return λ; for fibres the bulk modulus K less two thirds of the mean shear modulus, at least 0. 1/K is
    the sum of all compliances of stretch; the remaining distortional energy is positive."""
    if isinstance(material, Material) or not material.plies:
        return lame(material)[0]
    (ply,) = material.plies
    bulk = 1.0 / np.linalg.inv(in_space(ply))[..., :3, :3].sum(axis=(-2, -1))
    shear = (ply.shear_12 + ply.shear_13 + ply.shear_23) / 3.0
    return np.maximum(bulk - 2.0 / 3.0 * shear, 0.0)


def _green_distortion(material: Material | Constants, strain: np.ndarray) -> Triad:
    if isinstance(material, Constants) and material.plies:
        volumetric = np.multiply.outer(_green_bulk(material), np.outer(_TRACE, _TRACE))
        stiffness = in_space(material.plies[0]) - volumetric
    else:
        stiffness = np.multiply.outer(lame(material)[1], _DOUBLE)
    stress, tangent = (stiffness @ strain[..., None])[..., 0], np.broadcast_to(stiffness, (*strain.shape, 6))
    return Triad(0.5 * np.sum(strain * stress, axis=-1), stress, tangent)


def _green_volume(strain: np.ndarray) -> Triad:
    zeros = np.broadcast_to(0.0, (*strain.shape, 6))
    return Triad(strain @ _TRACE, np.broadcast_to(_TRACE, strain.shape), zeros)


def _logarithmic_volume(strain: np.ndarray) -> Triad:
    i, j = np.transpose(IN_SPACE)
    c = np.zeros((*strain.shape[:-1], 3, 3))  # 2E + 1
    c[..., i, j] = c[..., j, i] = _TRACE + strain @ _DOUBLE
    inverse, determinant = np.linalg.inv(c), np.linalg.det(c)
    with np.errstate(invalid="ignore", divide="ignore"):  # inside out: nan, which ends the step
        value = 0.5 * np.log(determinant)
    return Triad(value, inverse[..., i, j], -_DOUBLE @ pulled_back(inverse, IN_SPACE))


def _rubber_distortion(energy: Energy, strain: np.ndarray) -> Triad:
    x, double, log = 2.0 * strain @ _TRACE, strain @ _DOUBLE, _logarithmic_volume(strain)
    excess, rise, second = slopes(energy, x)
    c01, at_rest = energy.c01, 2.0 * energy.c10 + 4.0 * energy.c01
    by_second = 2.0 * x + 0.5 * x**2 - np.sum(strain * double, axis=-1)
    value = energy.c10 * x + excess + c01 * by_second - at_rest * log.value
    of_trace = 2.0 * (energy.c10 + rise + c01 * (2.0 + x))[..., None] * _TRACE
    stress = of_trace - 2.0 * c01 * double - at_rest * log.first
    tangent = 4.0 * (second + c01)[..., None, None] * np.outer(_TRACE, _TRACE)
    return Triad(value, stress, tangent - 2.0 * c01 * _DOUBLE - at_rest * log.second)


def _rubber(energy: Callable[[Material], Energy]) -> SolidLaw:
    def distortion(material: Material, strain: np.ndarray) -> Triad:
        return _rubber_distortion(energy(material), strain)

    return SolidLaw(distortion, _logarithmic_volume, lambda of: energy(of).volume(of.poisson))


LAWS = {
    "st-venant-kirchhoff": SolidLaw(_green_distortion, _green_volume, _green_bulk, quadratic=True),
    "neo-hookean": _rubber(lambda of: Energy(0.5 * lame(of)[1])),
} | dict.fromkeys(WORDS, _rubber(lambda of: of.energy))
