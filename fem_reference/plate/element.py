"""Biquadratic Mindlin plate element with assumed transverse shear: its strain operators at the Gauss points.

Kinematics, u = u₀ + ζ β with the director's tilt β (the director is e_z + β), linear:

    ε = sym ∇u₀      κ = sym ∇β      γ = ∇w + β

All fields are biquadratic. Taken as it stands, γ = 0 cannot be met pointwise and the thin plate locks, so
the covariant components γ_ξ = ∂w/∂ξ + β·∂x/∂ξ and γ_η are sampled at 2 × 3 and 3 × 2 Gauss points and
interpolated from there: MITC9 (Bucalem & Bathe, Int. J. Numer. Meth. Engng 36, 1993). Constant strains
are represented exactly in any straight-sided quadrilateral, and there are no spurious zero modes.
Quadrature is 3 × 3 points. Voigt order (xx, yy, 2xy); plan coordinates in metres.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from skfem import Basis, ElementQuad2, MeshQuad

FIELDS = ("ux", "uy", "w", "tilt_x", "tilt_y")
UX, UY, W, TILT_X, TILT_Y = range(5)
NODES = 9

_TWO = 0.5 + np.array([-0.5, 0.5]) / np.sqrt(3.0)
_THREE = 0.5 + np.array([-0.5, 0.0, 0.5]) * np.sqrt(0.6)


@dataclass(frozen=True)
class PlateElements:
    """The elements of a mesh: m elements, q Gauss points, columns 5·node + field of the element.

    nodes: (m, 9); membrane, curvature: (m, q, 3, 45); shear: (m, q, 2, 45); values: (q, 9) shape functions;
    areas: (m, q) [m²], quadrature weights times the Jacobian.
    """

    nodes: np.ndarray
    membrane: np.ndarray
    curvature: np.ndarray
    shear: np.ndarray
    values: np.ndarray
    areas: np.ndarray

    @property
    def unknowns(self) -> np.ndarray:
        """Global numbers of the element's unknowns, (m, 45): 5·node + field."""
        return (5 * self.nodes[:, :, None] + np.arange(5)).reshape(len(self.nodes), -1)


def plate_elements(basis: Basis) -> PlateElements:
    """Strain operators of the elements of a scalar `ElementQuad2` basis with any quadrature."""
    points, _ = basis.quadrature
    inverse = np.moveaxis(basis.mapping.invDF(points), (2, 3), (0, 1))  # (m, q, ξ, x)
    gradient = _reference_gradients(points)  # (q, 9, ξ)
    gradient = np.einsum("qaj,mqji->mqai", gradient, inverse)  # (m, q, 9, x)
    m, q = gradient.shape[:2]
    membrane, curvature = (np.zeros((m, q, 3, NODES, 5)) for _ in range(2))
    for operator, x, y in ((membrane, UX, UY), (curvature, TILT_X, TILT_Y)):
        operator[:, :, 0, :, x] = operator[:, :, 2, :, y] = gradient[..., 0]
        operator[:, :, 1, :, y] = operator[:, :, 2, :, x] = gradient[..., 1]
    covariant = _assumed_shear(basis.mesh, points)
    shear = np.einsum("mqji,mqjc->mqic", inverse, covariant)
    return PlateElements(
        nodes=basis.element_dofs.T,
        membrane=membrane.reshape(m, q, 3, -1),
        curvature=curvature.reshape(m, q, 3, -1),
        shear=shear,
        values=shape_values(points).T,
        areas=basis.dx,
    )


def shape_values(local: np.ndarray) -> np.ndarray:
    """Biquadratic shape functions (9, n) at local coordinates (2, n), 0 ≤ ξ ≤ 1."""
    element = ElementQuad2()
    return np.array([element.lbasis(local, a)[0] for a in range(NODES)])


def _reference_gradients(local: np.ndarray) -> np.ndarray:
    element = ElementQuad2()
    return np.array([element.lbasis(local, a)[1] for a in range(NODES)]).transpose(2, 0, 1)


def _assumed_shear(mesh: MeshQuad, points: np.ndarray) -> np.ndarray:
    """Covariant shear (γ_ξ, γ_η) at the points, (m, q, 2, 45), interpolated from the tying points."""
    assumed = []
    for direction, (xi, eta) in enumerate(((_TWO, _THREE), (_THREE, _TWO))):
        tying = np.array([[x, y] for x in xi for y in eta]).T  # (2, 6)
        weight = np.einsum("aq,bq->qab", _lagrange(xi, points[0]), _lagrange(eta, points[1]))
        tangent = mesh.mapping().DF(tying)[:, direction]  # (x, m, t) = ∂x/∂ξ or ∂x/∂η
        value = shape_values(tying).T  # (t, 9)
        sampled = np.zeros((mesh.nelements, 6, NODES, 5))
        sampled[..., W] = _reference_gradients(tying)[..., direction]
        for axis, tilt in enumerate((TILT_X, TILT_Y)):
            sampled[..., tilt] = tangent[axis][:, :, None] * value
        assumed.append(np.einsum("qt,mtc->mqc", weight.reshape(-1, 6), sampled.reshape(-1, 6, 5 * NODES)))
    return np.stack(assumed, axis=2)


def _lagrange(nodes: np.ndarray, x: np.ndarray) -> np.ndarray:
    """Lagrange polynomials (k, n) of the nodes (k,) at x (n,)."""
    return np.array([np.prod([(x - b) / (a - b) for b in nodes if b != a], axis=0) for a in nodes])
