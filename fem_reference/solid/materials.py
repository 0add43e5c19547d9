"""Hyperelastic laws of the solid, split so that the stiff volumetric part can be projected.

    W(E) = W₀(E) + ½ λ ϑ(E)²

λ, μ are Lamé's constants; ϑ measures the change of volume and alone grows stiff as ν → ½:

    St Venant–Kirchhoff   W₀ = μ E : E                        ϑ = tr E
    neo-Hooke             W₀ = ½ μ (tr C − 3) − μ ln J        ϑ = ln J,   C = 2E + 1, J² = det C

Green–Lagrange strain E and second Piola–Kirchhoff stress in Voigt order (xx, yy, zz, 2xy, 2yz, 2xz), stresses
without the 2. Every law is a triad: density → stress → tangent, of W₀ and of ϑ. Both have the
same small-strain limit. Source: Bonet & Wood, Nonlinear Continuum Mechanics (2008), ch. 6. [Pa]
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from sheetbench.scenes import Material

PAIRS = ((0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (0, 2))
_TRACE = np.array([1.0, 1.0, 1.0, 0.0, 0.0, 0.0])
_DOUBLE = np.diag([2.0, 2.0, 2.0, 1.0, 1.0, 1.0])


class Triad(NamedTuple):
    """A function of strain (…, 6) and its first and second derivative: (…), (…, 6), (…, 6, 6)."""

    value: np.ndarray
    first: np.ndarray
    second: np.ndarray


@dataclass(frozen=True)
class Law:
    """distortion: E → triad of W₀/μ; volume: E → triad of ϑ; quadratic: whether W is quadratic in E."""

    distortion: Callable[[np.ndarray], Triad]
    volume: Callable[[np.ndarray], Triad]
    quadratic: bool


def lame(material: Material) -> tuple[float, float]:
    """λ, μ [Pa]."""
    shear = material.young / (2.0 * (1.0 + material.poisson))
    return 2.0 * shear * material.poisson / (1.0 - 2.0 * material.poisson), shear


def _green_distortion(strain: np.ndarray) -> Triad:
    stress = strain @ _DOUBLE
    return Triad(0.5 * np.sum(strain * stress, axis=-1), stress, _everywhere(_DOUBLE, strain))


def _green_volume(strain: np.ndarray) -> Triad:
    return Triad(strain @ _TRACE, _everywhere(_TRACE, strain), _everywhere(np.zeros((6, 6)), strain))


def _logarithmic_volume(strain: np.ndarray) -> Triad:
    inverse, determinant = _inverse(strain)
    first = np.stack([inverse[..., i, j] for i, j in PAIRS], axis=-1)
    with np.errstate(invalid="ignore", divide="ignore"):  # inside out: not a number, which ends the step
        value = 0.5 * np.log(determinant)
    rows = [
        [-inverse[..., i, a] * inverse[..., j, b] - inverse[..., i, b] * inverse[..., j, a] for a, b in PAIRS]
        for i, j in PAIRS
    ]
    return Triad(value, first, np.stack([np.stack(row, axis=-1) for row in rows], axis=-2))


def _neo_hookean_distortion(strain: np.ndarray) -> Triad:
    volume = _logarithmic_volume(strain)
    return Triad(strain @ _TRACE - volume.value, _TRACE - volume.first, -volume.second)


def _inverse(strain: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """C⁻¹ (…, 3, 3) and det C of C = 2E + 1."""
    c = np.zeros((*strain.shape[:-1], 3, 3))
    for place, (i, j) in enumerate(PAIRS):
        c[..., i, j] = c[..., j, i] = strain[..., place] * (2.0 if i == j else 1.0) + (1.0 if i == j else 0.0)
    return np.linalg.inv(c), np.linalg.det(c)


def _everywhere(constant: np.ndarray, strain: np.ndarray) -> np.ndarray:
    return np.broadcast_to(constant, strain.shape[:-1] + constant.shape)


LAWS = {
    "st-venant-kirchhoff": Law(_green_distortion, _green_volume, quadratic=True),
    "neo-hookean": Law(_neo_hookean_distortion, _logarithmic_volume, quadratic=False),
}
