"""Nine-node shell element of a flat sheet: strains quadratic in the nodal vectors, MITC9 assumed strains.

The position is φ + ζ d, both biquadratic. Covariant components along the element's own coordinates r, s are

    membrane  e_αβ = ½ (φ,α · φ,β − X,α · X,β)
    bending   k_αβ = ½ (φ,α · d,β + φ,β · d,α)
    shear     g_α  = φ,α · d

A biquadratic element locks if the components are integrated unchanged. They are sampled where the locked
parts vanish and interpolated (MITC9, Bucalem & Bathe 1993): rr and r-shear at r = ±1/√3, s = 0, ±√(3/5); ss
and s-shear at the transposed points; the membrane's rs at the 2 × 2 Gauss points, taken from the 3 × 3 ones
by biquadratic interpolation, which makes it the mean-square projection on bilinear functions. On a distorted
element that projection does not keep the mean of the Cartesian strain, which the patch test requires: the
difference is added back as a constant. The twist k_rs has no locking part and is not projected: with the
projection of Bucalem & Bathe, bent elements of unequal sides become unstable (see `validity`). An unprojected
membrane shear locks: the error of a thin sheet's large deflections on 8 × 8 elements goes from 1.5 to 14 %.
An element has 54 sampled strains

    e_k = ½ Qᵀ H_k Q − ½ Q₀ᵀ H_k Q₀,     Q = (φ_1 … φ_9, d_1 … d_9),

with equal H_k in every element, and the energy ½ eᵀ D e, with D (54, 54) the integral over the
element at 3 × 3 Gauss points. So δe = B δQ with B = H Q, the force is Bᵀ s with s = D e, and its tangent
Bᵀ D B + Σ s_k H_k. Strains are formed from the displacement, e = (Q₀ + ½ q)ᵀ H q, which keeps their
digits in a sheet of any thinness. No penalty, no stabilisation, no spurious mode.
"""

from dataclasses import dataclass
from functools import cached_property
from typing import ClassVar, Self

import numpy as np

from fem_reference.shell import sampling
from fem_reference.surface.biquadratic import (
    AT_GAUSS,
    GAUSS,
    GAUSS_WEIGHTS,
    IN_PLANE,
    THREE,
    TYING,
    integrated,
    interpolation,
    jacobians,
    product_grid,
    pulled_back,
    require_upright,
    shape,
)
from fem_reference.surface.constants import Values, section_with
from fem_reference.surface.materials import Section
from sheetbench.numerics.cache import cached

# Sampling grids of the covariant components and their interpolation to the Gauss points.
GRIDS = {**TYING, "rs": (THREE, THREE)}
_TO_GAUSS = {name: interpolation(*TYING[name], GAUSS) for name in TYING}
_TO_GAUSS["rs"] = _TO_GAUSS["rs"] @ interpolation(THREE, THREE, product_grid(*TYING["rs"]))

MEMBRANE = slice(0, 21)
BENDING = slice(21, 42)
SHEAR = slice(42, 54)
STRAINS = 54
ROUNDED = 1e-14  # slant of a side over the element's size below which it is rounding


def _tables() -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return a and b (21, 9) of `sampling`, and the shape functions' values at the points (21, 9)."""
    first, second, values = [], [], []
    for grid, (a, b) in zip(GRIDS.values(), IN_PLANE, strict=True):
        value, slope = shape(*product_grid(*grid))
        first.append(slope[a])
        second.append(slope[b])
        values.append(value)
    return np.concatenate(first), np.concatenate(second), np.concatenate(values)


_A, _B, AT_SITES = _tables()
_V = AT_SITES[: SHEAR.stop - SHEAR.start]  # where shear is sampled
TABLES = np.ascontiguousarray(np.concatenate([_A, _B, _V]).T)


def _strain_forms() -> np.ndarray:
    """Return H (54, 18, 18) with e = ½ Qᵀ H Q; Q holds nine positions, then nine directors."""
    forms = np.zeros((STRAINS, 18, 18))
    phi, director = slice(0, 9), slice(9, 18)
    product, slant = _A[:, :, None] * _B[:, None, :], _A[: len(_V), :, None] * _V[:, None, :]
    symmetric = 0.5 * (product + product.transpose(0, 2, 1))
    forms[MEMBRANE, phi, phi] = forms[BENDING, phi, director] = forms[BENDING, director, phi] = symmetric
    forms[SHEAR, phi, director] = slant
    forms[SHEAR, director, phi] = slant.transpose(0, 2, 1)
    return forms


FORMS = _strain_forms()
OF_POSITIONS = FORMS[:, :9].reshape(STRAINS, -1)  # rows of directors are their transposes


@dataclass(frozen=True)
class Element:
    """Shell elements: reference Q₀ (m, 18, 3), stiffness D (m, 54, 54), areas w |det J| (m, 9) [m²]. parts:
    slices of the strains by kind."""

    reference: np.ndarray
    stiffness: np.ndarray
    areas: np.ndarray
    parts: ClassVar[dict[str, slice]] = {"membrane": MEMBRANE, "bending": BENDING, "shear": SHEAR}

    @classmethod
    def build(cls, nodes: np.ndarray, section: Section) -> Self:
        """Return elements with nodes at (m, 9, 2) [m]. Raises BadInput if one is inverted."""
        return cls(*arrays(nodes, *section))

    @cached_property
    def coupled(self) -> bool:
        """Return whether D couples strains of different parts."""
        return bool(self.stiffness[:, MEMBRANE, BENDING].any())

    @cached_property
    def flat_jacobian(self) -> np.ndarray:
        """Return det J at the Gauss points (m, 9) [m²], below zero where r, s turn clockwise."""
        (xr, xs), (yr, ys) = jacobians(self.reference[:, :9, :2], AT_GAUSS[1]).transpose(2, 3, 0, 1)
        return np.asarray(xr * ys - xs * yr)

    @cached_property
    def sides(self) -> np.ndarray:
        """Lengths along r and s, (m, 2) [m]."""
        across = self.reference[:, [5, 6], :2] - self.reference[:, [7, 4], :2]
        return np.asarray(np.linalg.norm(across, axis=2))

    def strain(self, change: np.ndarray) -> np.ndarray:
        """Return sampled strains e (m, 54) of the change q (m, 18, 3) of positions and directors. They are
        the product of q with their derivatives half way, which keeps the digits of a small q."""
        return self.step(self.reference + 0.5 * change, change)

    def operator(self, change: np.ndarray) -> np.ndarray:
        """Return nodal vectors Q (m, 18, 3), the argument of B = H Q, at a change q (m, 18, 3)."""
        return self.reference + change

    def step(self, operator: np.ndarray, step: np.ndarray) -> np.ndarray:
        """Return B δq (m, 54) of a step (m, 18, 3)."""
        return np.asarray(sampling.strain_of(operator, np.ascontiguousarray(step), TABLES))

    def forces(self, operator: np.ndarray, stress: np.ndarray) -> np.ndarray:
        """Return Bᵀ s (m, 18, 3) of stresses (m, 54)."""
        return np.asarray(sampling.forces_of(np.ascontiguousarray(operator), stress, TABLES))

    def geometric(self, step: np.ndarray, stress: np.ndarray) -> np.ndarray:
        """Return Σ s_k H_k δq (m, 18, 3) of a step under stresses (m, 54): B is linear in the vectors."""
        return self.forces(step, stress)

    def magnitudes(self, operator: np.ndarray, stress: np.ndarray) -> np.ndarray:
        """Return Σ |B| |s| (18,) by nodal vector, of stresses (m, 54)."""
        return np.asarray(sampling.magnitudes(operator, stress, TABLES))

    def stress(self, strain: np.ndarray) -> np.ndarray:
        """Return s = D e (m, 54), conjugate to the sampled strains."""
        return weighed(self.stiffness, strain)

    def moduli(self, strain: np.ndarray) -> np.ndarray:
        """Return D = ∂s/∂e (m, 54, 54) at strains (m, 54)."""
        return self.stiffness

    def at_points(self, strain: np.ndarray) -> tuple[np.ndarray, ...]:
        """Return E, κ (m, 9, 3) and γ (m, 9, 2) at the Gauss points, from sampled strains (m, 54)."""
        forms = to_cartesian(self.reference[:, :9, :2])
        parts = zip(forms, self.parts.values(), strict=False)
        return tuple(np.einsum("egak,ek->ega", form, strain[:, part]) for form, part in parts)

    def resultants(self, values: Values, strain: np.ndarray) -> tuple[np.ndarray, ...]:
        """Return N, M (m, 9, 3) and Q (m, 9, 2), times areas, at the Gauss points under strains (m, 54).
        values: the constants of the sheet."""
        (stretch, curvature, slant), section = self.at_points(strain), section_with(values)
        area = self.areas[..., None]
        return (
            area * (weighed(section.membrane, stretch) + weighed(section.mixed, curvature)),
            area * (weighed(section.mixed, stretch) + weighed(section.bending, curvature)),
            area * weighed(section.shear, slant),
        )

    def energies(self, strain: np.ndarray) -> dict[str, float]:
        """Return the energy [J] of strains e (m, 54), by part."""
        density = strain * self.stress(strain)
        return {name: 0.5 * float(density[:, part].sum()) for name, part in self.parts.items()}


def weighed(moduli: np.ndarray, strain: np.ndarray) -> np.ndarray:
    """Return D e (…, k) of moduli (…, k, l) and strains (…, l)."""
    return np.asarray((moduli @ strain[..., None])[..., 0])


@cached(last=4, most=1 << 16)
def arrays(
    nodes: np.ndarray, membrane: np.ndarray, bending: np.ndarray, shear: np.ndarray, mixed: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return reference, stiffness and areas of elements with nodes (m, 9, 2) and a section."""
    stretching, bent, slanted, areas = to_cartesian(nodes)
    stiffness = np.zeros((len(nodes), STRAINS, STRAINS))
    stiffness[:, MEMBRANE, MEMBRANE] = integrated(stretching, membrane, areas)
    stiffness[:, BENDING, BENDING] = integrated(bent, bending, areas)
    stiffness[:, SHEAR, SHEAR] = integrated(slanted, shear, areas)
    if mixed.any():
        stiffness[:, MEMBRANE, BENDING] = integrated(stretching, mixed, areas, bent)
        stiffness[:, BENDING, MEMBRANE] = stiffness[:, MEMBRANE, BENDING].swapaxes(1, 2)
    return vectors_at_rest(nodes), stiffness, areas


def vectors_at_rest(nodes: np.ndarray) -> np.ndarray:
    """Return Q₀ (m, 18, 3) of elements with nodes at plan positions (m, 9, 2) [m]."""
    reference = np.zeros((len(nodes), 18, 3))
    reference[:, :9, :2], reference[:, 9:, 2] = nodes, 1.0
    return reference


@cached(last=4, most=1 << 16)
def to_cartesian(nodes: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Return matrices that make Cartesian strains at the Gauss points of sampled ones, and areas. Matrices of
    membrane and bending strains [xx, yy, 2xy], (m, 9, 3, 21) each, and of shear strains [xz, yz], (m, 9, 2,
    12); areas w |det J| (m, 9) [m²]. nodes: (m, 9, 2) [m]. Raises BadInput if an element is inverted."""
    jacobian = jacobians(nodes, AT_GAUSS[1])
    # A side along an axis gets a slant of exactly zero, so that D couples neither rr nor ss with rs.
    jacobian[np.abs(jacobian) < ROUNDED * np.abs(jacobian).max(axis=(1, 2, 3), keepdims=True)] = 0.0
    area = np.linalg.det(jacobian)
    require_upright(area)
    inverse = np.linalg.inv(jacobian)  # ∂ξ_a/∂x_b
    areas = GAUSS_WEIGHTS * np.abs(area)
    pull = pulled_back(inverse, IN_PLANE) * [1.0, 1.0, 2.0]  # of rr, ss, rs
    rr, ss, rs = _TO_GAUSS.values()
    membrane, bending = _spread(pull, rr, ss, rs), _spread(pull, rr, ss, np.eye(9))
    share = areas / areas.sum(axis=1, keepdims=True)
    mean_lost = np.einsum("eg,ega,gk->eak", share, pull[..., 2], np.eye(9) - rs)
    membrane[..., 2 * len(rr.T) :] += mean_lost[:, None]
    return membrane, bending, _spread(inverse.swapaxes(2, 3), rr, ss), areas


def _spread(pull: np.ndarray, *onto: np.ndarray) -> np.ndarray:
    """Return the matrix (m, 9, a, Σ k) from samples to strains at the Gauss points. pull: of covariant
    strains there (m, 9, a, c); onto: for each covariant strain, its interpolation (9, k)."""
    parts = [np.einsum("ega,gk->egak", pull[..., c], weights) for c, weights in enumerate(onto)]
    return np.concatenate(parts, axis=-1)
