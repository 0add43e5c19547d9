"""Biquadratic Mindlin plate element with assumed transverse shear: its strain operators at the Gauss points.

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

from fem_reference.surface.biquadratic import (
    GAUSS,
    NODES,
    TYING,
    areas,
    interpolation,
    jacobians,
    product_grid,
    shape,
)

UX, UY, W, TILT_X, TILT_Y = range(5)


@dataclass(frozen=True)
class PlateElements:
    """The elements of a mesh: m elements, q = 9 Gauss points, columns 5·node + field of the element.

    nodes: (m, 9); membrane, curvature: (m, q, 3, 45); shear: (m, q, 2, 45); areas: (m, q) [m²], quadrature
    weights times the Jacobian.
    """

    nodes: np.ndarray
    membrane: np.ndarray
    curvature: np.ndarray
    shear: np.ndarray
    areas: np.ndarray

    @classmethod
    def build(cls, nodes: np.ndarray, plan: np.ndarray) -> PlateElements:
        """Of elements with nodes (m, 9) at plan positions (n, 2) [m]."""
        corners = plan[nodes]
        _, slope = shape(*GAUSS)
        inverse = np.linalg.inv(jacobians(corners, slope))  # ∂ξ_a/∂x_b, by a and b
        gradient = np.einsum("agi,egab->egib", slope, inverse)  # (m, q, 9, x)
        m, q = gradient.shape[:2]
        membrane, curvature = (np.zeros((m, q, 3, NODES, 5)) for _ in range(2))
        for operator, x, y in ((membrane, UX, UY), (curvature, TILT_X, TILT_Y)):
            operator[:, :, 0, :, x] = operator[:, :, 2, :, y] = gradient[..., 0]
            operator[:, :, 1, :, y] = operator[:, :, 2, :, x] = gradient[..., 1]
        return cls(
            nodes=nodes,
            membrane=membrane.reshape(m, q, 3, -1),
            curvature=curvature.reshape(m, q, 3, -1),
            shear=np.einsum("egab,egac->egbc", inverse, _assumed_shear(corners)),
            areas=areas(corners),
        )

    @property
    def unknowns(self) -> np.ndarray:
        """Global numbers of the element's unknowns, (m, 45): 5·node + field."""
        return (5 * self.nodes[:, :, None] + np.arange(5)).reshape(len(self.nodes), -1)


def _assumed_shear(corners: np.ndarray) -> np.ndarray:
    """Covariant shear (γ_ξ, γ_η) at the Gauss points, (m, q, 2, 45), interpolated from the tying points."""
    assumed = []
    for direction, name in enumerate(("rr", "ss")):
        value, slope = shape(*product_grid(*TYING[name]))
        tangent = jacobians(corners, slope)[..., direction]  # (m, 6, x) = ∂x/∂ξ or ∂x/∂η
        sampled = np.zeros((len(corners), len(value), NODES, 5))
        sampled[..., W] = slope[direction]
        for axis, tilt in enumerate((TILT_X, TILT_Y)):
            sampled[..., tilt] = tangent[..., axis, None] * value
        onto = interpolation(*TYING[name], GAUSS)
        assumed.append(np.einsum("qt,mtc->mqc", onto, sampled.reshape(len(corners), len(value), -1)))
    return np.stack(assumed, axis=2)
