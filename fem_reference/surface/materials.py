"""Linear isotropic elasticity of a thin sheet: plane-stress St Venant–Kirchhoff, σ_zz = 0.

Voigt order [xx, yy, 2xy]; per unit of mid-surface area, with thickness h:

    membrane  N = h C E,           C = E/(1 − ν²) [[1, ν, 0], [ν, 1, 0], [0, 0, (1 − ν)/2]]   [Pa]
    bending   M = h³/12 C κ
    shear     Q = k h G γ,         G = E/2(1 + ν),   k = 5/6 (Reissner)

A `Section` given in their place makes the sheet any other plate, a lattice's homogenised one for instance.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from sheetbench.scenes import Material

SHEAR_CORRECTION = 5.0 / 6.0


class Section(NamedTuple):
    """Stiffness of the sheet per unit of its width: membrane (3, 3) [N/m] and bending (3, 3) [N·m] in Voigt
    order, shear (2, 2) [N/m]."""

    membrane: np.ndarray
    bending: np.ndarray
    shear: np.ndarray


def section_of(material: Material, thickness: float) -> Section:
    """The section of a homogeneous sheet of this material."""
    laws = (membrane_stiffness, bending_stiffness, transverse_shear_stiffness)
    return Section(*(law(material, thickness) for law in laws))


def plane_stress(material: Material) -> np.ndarray:
    """C (3, 3) [Pa]: stress [xx, yy, xy] of strain [xx, yy, 2xy]."""
    nu = material.poisson
    return (
        material.young
        / (1.0 - nu**2)
        * np.array([[1.0, nu, 0.0], [nu, 1.0, 0.0], [0.0, 0.0, (1.0 - nu) / 2.0]])
    )


def shear_modulus(material: Material) -> float:
    """G = E/2(1 + ν) [Pa]."""
    return material.young / (2.0 * (1.0 + material.poisson))


def membrane_stiffness(material: Material, thickness: float) -> np.ndarray:
    """h C (3, 3) [N/m]."""
    return thickness * plane_stress(material)


def bending_stiffness(material: Material, thickness: float) -> np.ndarray:
    """h³/12 C (3, 3) [N·m]."""
    return thickness**3 / 12.0 * plane_stress(material)


def transverse_shear_stiffness(material: Material, thickness: float) -> np.ndarray:
    """k h G I (2, 2) [N/m]."""
    return SHEAR_CORRECTION * thickness * shear_modulus(material) * np.eye(2)
