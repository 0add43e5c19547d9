"""Biquadratic Mindlin plate element with assumed transverse shear: its strains at the Gauss points.

Kinematics, u = u₀ + ζ β with the director's tilt β (the director is e_z + β), linear:

    ε = sym ∇u₀      κ = sym ∇β      γ = ∇w + β

All fields are biquadratic. Unprojected, γ = 0 cannot hold pointwise and the thin plate locks, so
the covariant components γ_ξ = ∂w/∂ξ + β·∂x/∂ξ and γ_η are the shell's (`shell.element`) about the flat
sheet, sampled at 2 × 3 and 3 × 2 Gauss points and interpolated from there: MITC9 (Bucalem & Bathe, Int. J.
Numer. Meth. Engng 36, 1993). Constant strains are represented exactly in any straight-sided quadrilateral,
and there are no spurious zero modes.
Voigt order (xx, yy, 2xy); plan coordinates in metres.
"""

from dataclasses import dataclass
from typing import ClassVar, Self

import numpy as np

from fem_reference.shell.element import FORMS, Element, to_cartesian, vectors_at_rest, weighed
from fem_reference.shell.element import SHEAR as SAMPLED_SHEAR
from fem_reference.surface.biquadratic import AT_GAUSS, areas, jacobians
from fem_reference.surface.materials import Section

MEMBRANE, BENDING, SHEAR = slice(0, 3), slice(3, 6), slice(6, 8)


@dataclass(frozen=True)
class PlateElements(Element):
    """Elements whose strains (ε, κ, γ) at 9 Gauss points each are linear in the change of their vectors: e =
    B q, (9 m, 8). stiffness: per strain, times a point's area (9 m, 8, 8); gradient: ∇N at the Gauss points
    (m, 9, 2, 9); forms: B (m, 72, 54)."""

    gradient: np.ndarray
    forms: np.ndarray
    parts: ClassVar[dict[str, slice]] = {"membrane": MEMBRANE, "bending": BENDING, "shear": SHEAR}

    @classmethod
    def build(cls, nodes: np.ndarray, section: Section) -> Self:
        """Return elements with nodes at plan positions (m, 9, 2) [m]."""
        slope, reference = AT_GAUSS[1], vectors_at_rest(nodes)
        inverse = np.linalg.inv(jacobians(nodes, slope))  # ∂ξ_a/∂x_b, by a and b
        gradient = np.einsum("agi,egab->egbi", slope, inverse)
        m, q = gradient.shape[:2]
        forms = np.zeros((m, q, 8, 18, 3))
        for part, of in ((MEMBRANE, slice(0, 9)), (BENDING, slice(9, 18))):
            xx, yy, xy = np.moveaxis(forms[:, :, part, of], 2, 0)
            xx[..., 0] = xy[..., 1] = gradient[:, :, 0]
            yy[..., 1] = xy[..., 0] = gradient[:, :, 1]
        sampled = np.einsum("kij,ejc->ekic", FORMS[SAMPLED_SHEAR], reference)
        forms[:, :, SHEAR] = np.einsum("egak,ekic->egaic", to_cartesian(nodes)[2], sampled)
        stiffness, weights = np.zeros((m, q, 8, 8)), areas(nodes)
        blocks = (MEMBRANE, MEMBRANE), (BENDING, BENDING), (SHEAR, SHEAR), (MEMBRANE, BENDING)
        for (row, column), moduli in zip(blocks, section, strict=True):
            stiffness[:, :, row, column] = weights[..., None, None] * moduli
        stiffness[:, :, BENDING, MEMBRANE] = stiffness[:, :, MEMBRANE, BENDING]
        arrays = stiffness.reshape(-1, 8, 8), weights, gradient, forms.reshape(m, 8 * q, 54)
        return cls(reference, *arrays)

    def strain(self, change: np.ndarray) -> np.ndarray:
        """Return e (9 m, 8) of a change (m, 18, 3) of positions and directors."""
        return weighed(self.forms, change.reshape(-1, 54)).reshape(-1, 8)

    def at_points(self, strain: np.ndarray) -> tuple[np.ndarray, ...]:
        """Return E, κ (m, 9, 3) and γ (m, 9, 2) at the Gauss points, from strains (9 m, 8)."""
        return tuple(strain.reshape(*self.areas.shape, 8)[..., part] for part in self.parts.values())

    def operator(self, change: np.ndarray) -> np.ndarray:
        """Return B, which does not depend on the change."""
        return self.forms

    def step(self, operator: np.ndarray, step: np.ndarray) -> np.ndarray:
        """Return B δq (9 m, 8) of a step (m, 18, 3)."""
        return self.strain(step)

    def forces(self, operator: np.ndarray, stress: np.ndarray) -> np.ndarray:
        """Return Bᵀ s (m, 18, 3) of stresses (9 m, 8), which are forces times lengths."""
        return weighed(operator.swapaxes(1, 2), stress.reshape(len(operator), -1)).reshape(-1, 18, 3)

    def geometric(self, step: np.ndarray, stress: np.ndarray) -> np.ndarray:
        """Return zeros: B does not change with a step."""
        return np.zeros_like(step)

    def magnitudes(self, operator: np.ndarray, stress: np.ndarray) -> np.ndarray:
        """Return Σ |B| |s| (18,) by vector, of stresses (9 m, 8)."""
        return self.forces(np.abs(operator), np.abs(stress)).sum(axis=(0, 2))

    def tangent(self, moduli: np.ndarray) -> np.ndarray:
        """Return Bᵀ D B (m, 54, 54) of moduli (9 m, 8, 8)."""
        m, points = len(self.forms), self.forms.reshape(-1, 8, 54)
        return self.forms.swapaxes(1, 2) @ (moduli @ points).reshape(m, -1, 54)
