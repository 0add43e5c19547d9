"""Shell elements of a law that is not quadratic in Green's strain (`laws`), integrated through the thickness.

At height ζ the in-plane strain is E + ζ κ, of the assumed membrane and bending strains at the element's 3 × 3
Gauss points; three more through the thickness give

    s = ∫∫ (T_m, ζ T_b)ᵀ S(E + ζ κ) dζ dA,     D = ∫∫ (T_m, ζ T_b)ᵀ ∂S/∂E (T_m, ζ T_b) dζ dA

with T what makes Cartesian strains of the sampled ones (`element.cartesian`). Transverse shear stays linear.
With St Venant–Kirchhoff's law these are the stresses of `Element`.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Self

import numpy as np

from fem_reference.shell.element import BENDING, MEMBRANE, SHEAR, STRAINS, Element, cartesian
from fem_reference.shell.laws import Law, Response
from fem_reference.surface.biquadratic import integrated
from fem_reference.surface.materials import section_of
from sheetbench.scenes import Material

_LEVELS, _SHARES = np.polynomial.legendre.leggauss(3)


@dataclass(frozen=True)
class HyperelasticElement(Element):
    """Elements of a material and its law; stiffness: D at no strain; membrane, bending: T (m, 9, 3, 21);
    heights, weights: ζ [m] and ∫ dζ [m] of the points through the thickness, (3,). drag: σ of a step of creep
    from strains `past` (m, 54), at stresses s + σ D₀ (e − e_n)."""

    law: Law
    material: Material
    membrane: np.ndarray
    bending: np.ndarray
    heights: np.ndarray
    weights: np.ndarray
    past: np.ndarray
    drag: float = 0.0

    @classmethod
    def of(cls, nodes: np.ndarray, material: Material, thickness: float, law: Law) -> Self:
        """From the nodes' plan positions (m, 9, 2) [m]. Raises BadInput if an element is inverted."""
        linear = Element.build(nodes, section_of(material, thickness))
        half, rest = 0.5 * thickness, np.zeros((len(nodes), STRAINS))
        return cls(
            linear.reference,
            linear.stiffness,
            linear.areas,
            law,
            material,
            *cartesian(nodes),
            half * _LEVELS,
            half * _SHARES,
            rest,
        )

    def stress(self, strain: np.ndarray) -> np.ndarray:
        """s (m, 54), conjugate to the sampled strains."""
        found = self._response(strain).stress * self._volumes[..., None]
        out = self.drag * (self.stiffness @ (strain - self.past)[:, :, None])[:, :, 0]
        out[:, MEMBRANE] += np.einsum("egak,egza->ek", self.membrane, found, optimize=True)
        out[:, BENDING] += np.einsum("egak,egza,z->ek", self.bending, found, self.heights, optimize=True)
        out[:, SHEAR] += (self.stiffness[:, SHEAR, SHEAR] @ strain[:, SHEAR, None])[:, :, 0]
        return out

    @property
    def stands_any_strain(self) -> bool:
        """Whether the law is meant for large strains."""
        return self.law.stands_any_strain

    @property
    def coupled(self) -> bool:
        """Whether D mixes membrane and bending."""
        return True

    def moduli(self, strain: np.ndarray) -> np.ndarray:
        """D (m, 54, 54)."""
        found, areas = self._response(strain).tangent * self.weights[:, None, None], self.areas
        stretch, mixed, turn = (np.einsum("egzab,z->egab", found, self.heights**n) for n in range(3))
        out = self.drag * self.stiffness
        out[:, MEMBRANE, MEMBRANE] += integrated(self.membrane, stretch, areas)
        coupled = integrated(self.membrane, mixed, areas, self.bending)
        out[:, MEMBRANE, BENDING] += coupled
        out[:, BENDING, MEMBRANE] += coupled.swapaxes(1, 2)
        out[:, BENDING, BENDING] += integrated(self.bending, turn, areas)
        out[:, SHEAR, SHEAR] += self.stiffness[:, SHEAR, SHEAR]
        return out

    def energies(self, strain: np.ndarray) -> dict[str, float]:
        """Energy [J] of strains e (m, 54): that of the mid-surface's stretch, what bending adds, of shear."""
        flat = np.concatenate([strain[:, MEMBRANE], np.zeros_like(strain[:, MEMBRANE])], axis=1)
        total, membrane = (float(np.sum(self._volumes * self._response(e).energy)) for e in (strain, flat))
        slant = strain[:, SHEAR, None]
        shear = 0.5 * np.sum(slant * (self.stiffness[:, SHEAR, SHEAR] @ slant))
        return {"membrane": membrane, "bending": total - membrane, "shear": float(shear)}

    def dragged(self, strain: np.ndarray, drag: float) -> Element:
        """Elements of stresses s + σ D₀ (e − e_n), from strains e_n (m, 54) with drag σ."""
        return replace(self, past=strain, drag=drag)

    def _response(self, strain: np.ndarray) -> Response:
        """Of the sampled strains (m, ≥ 42) at the points of every element, (m, 9, 3, …)."""
        stretch = np.einsum("egak,ek->ega", self.membrane, strain[:, MEMBRANE])
        curvature = np.einsum("egak,ek->ega", self.bending, strain[:, BENDING])
        return self.law.response(
            self.material, stretch[:, :, None] + self.heights[:, None] * curvature[:, :, None]
        )

    @property
    def _volumes(self) -> np.ndarray:
        """(m, 9, 3) [m³]."""
        return self.areas[:, :, None] * self.weights
