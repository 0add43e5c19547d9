"""Biquadratic Mindlin plate element with assumed transverse shear: its strains at the Gauss points.

Kinematics, u = u₀ + ζ β with the director's tilt β (the director is e_z + β), linear:

    ε = sym ∇u₀      κ = sym ∇β      γ = ∇w + β

All fields are biquadratic. Taken as it stands, γ = 0 cannot be met pointwise and the thin plate locks, so
the covariant components γ_ξ = ∂w/∂ξ + β·∂x/∂ξ and γ_η are sampled at 2 × 3 and 3 × 2 Gauss points and
interpolated from there: MITC9 (Bucalem & Bathe, Int. J. Numer. Meth. Engng 36, 1993). Constant strains
are represented exactly in any straight-sided quadrilateral, and there are no spurious zero modes.
Voigt order (xx, yy, 2xy); plan coordinates in metres.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fem_reference.shell.element import weighed
from fem_reference.surface.biquadratic import (
    GAUSS,
    TYING,
    areas,
    interpolation,
    jacobians,
    product_grid,
    shape,
)
from fem_reference.surface.materials import Section

MEMBRANE, BENDING, SHEAR = slice(0, 3), slice(3, 6), slice(6, 8)


@dataclass(frozen=True)
class PlateElements:
    """m elements, whose strains (ε, κ, γ) at 9 Gauss points each are linear in the change of their vectors:
    e = B q, (9 m, 8).

    reference: φ and d at rest (m, 18, 3); gradient: ∇N at the Gauss points (m, 9, 2, 9); forms: B
    (m, 72, 54); stiffness: that per strain times a point's area (9 m, 8, 8); areas: (m, 9) [m²].
    """

    reference: np.ndarray
    gradient: np.ndarray
    forms: np.ndarray
    stiffness: np.ndarray
    areas: np.ndarray
    stands_any_strain = False

    @classmethod
    def build(cls, nodes: np.ndarray, section: Section) -> PlateElements:
        """Of elements with nodes at plan positions (m, 9, 2) [m]."""
        _, slope = shape(*GAUSS)
        inverse = np.linalg.inv(jacobians(nodes, slope))  # ∂ξ_a/∂x_b, by a and b
        gradient = np.einsum("agi,egab->egbi", slope, inverse)
        m, q = gradient.shape[:2]
        forms = np.zeros((m, q, 8, 18, 3))
        for part, of in ((MEMBRANE, slice(0, 9)), (BENDING, slice(9, 18))):
            xx, yy, xy = np.moveaxis(forms[:, :, part, of], 2, 0)
            xx[..., 0] = xy[..., 1] = gradient[:, :, 0]
            yy[..., 1] = xy[..., 0] = gradient[:, :, 1]
        forms[:, :, SHEAR] = np.einsum("egab,egaic->egbic", inverse, _assumed_shear(nodes))
        stiffness, weights = np.zeros((m, q, 8, 8)), areas(nodes)
        for part, moduli in zip((MEMBRANE, BENDING, SHEAR), section, strict=True):
            stiffness[:, :, part, part] = weights[..., None, None] * moduli
        reference = np.zeros((m, 18, 3))
        reference[:, :9, :2], reference[:, 9:, 2] = nodes, 1.0
        return cls(reference, gradient, forms.reshape(m, 8 * q, 54), stiffness.reshape(-1, 8, 8), weights)

    def strain(self, change: np.ndarray) -> np.ndarray:
        """e (9 m, 8) of a change (m, 18, 3) of positions and directors."""
        return weighed(self.forms, change.reshape(-1, 54)).reshape(-1, 8)

    def operator(self, change: np.ndarray) -> np.ndarray:
        """B, whatever the change."""
        return self.forms

    def step(self, operator: np.ndarray, step: np.ndarray) -> np.ndarray:
        """B δq (9 m, 8) of a step (m, 18, 3)."""
        return self.strain(step)

    def forces(self, operator: np.ndarray, stress: np.ndarray) -> np.ndarray:
        """Bᵀ s (m, 18, 3) of stresses (9 m, 8), which are forces times lengths."""
        return weighed(operator.swapaxes(1, 2), stress.reshape(len(operator), -1)).reshape(-1, 18, 3)

    def geometric(self, step: np.ndarray, stress: np.ndarray) -> np.ndarray:
        """Zero: B does not change with a step."""
        return np.zeros_like(step)

    def magnitudes(self, operator: np.ndarray, stress: np.ndarray) -> np.ndarray:
        """Σ |B| |s| (18,) by vector, of stresses (9 m, 8)."""
        return self.forces(np.abs(operator), np.abs(stress)).sum(axis=(0, 2))

    def stress(self, strain: np.ndarray) -> np.ndarray:
        """s (9 m, 8), conjugate to the strains."""
        return weighed(self.stiffness, strain)

    def moduli(self, strain: np.ndarray) -> np.ndarray:
        """∂s/∂e (9 m, 8, 8)."""
        return self.stiffness

    def tangent(self, moduli: np.ndarray) -> np.ndarray:
        """Bᵀ D B (m, 54, 54) of moduli (9 m, 8, 8)."""
        m, points = len(self.forms), self.forms.reshape(-1, 8, 54)
        return self.forms.swapaxes(1, 2) @ (moduli @ points).reshape(m, -1, 54)

    def energies(self, strain: np.ndarray) -> dict[str, float]:
        """Energy [J] of strains (9 m, 8), by part."""
        density = strain * self.stress(strain)
        parts = {"membrane": MEMBRANE, "bending": BENDING, "shear": SHEAR}
        return {name: 0.5 * float(density[:, part].sum()) for name, part in parts.items()}


def _assumed_shear(nodes: np.ndarray) -> np.ndarray:
    """Covariant shear (γ_ξ, γ_η) at the Gauss points (m, q, 2, 18, 3), from the tying points."""
    assumed = []
    for direction, name in enumerate(("rr", "ss")):
        value, slope = shape(*product_grid(*TYING[name]))
        tangent = jacobians(nodes, slope)[..., direction]  # (m, 6, x) = ∂x/∂ξ or ∂x/∂η
        sampled = np.zeros((*tangent.shape[:2], 18, 3))
        sampled[:, :, :9, 2] = slope[direction]
        sampled[:, :, 9:, :2] = tangent[:, :, None] * value[..., None]
        assumed.append(np.einsum("qt,mtic->mqic", interpolation(*TYING[name], GAUSS), sampled))
    return np.stack(assumed, axis=2)
