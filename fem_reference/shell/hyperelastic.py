"""Shell elements of a law that is not quadratic in Green's strain (`laws`), integrated through the thickness.

At the height ζ of the flat sheet the in-plane strain is e = E + ζ t κ, of the assumed membrane and bending
strains at the element's 3 × 3 Gauss points and the stretch t(E) of the thickness; three more points through
the thickness give

    s = ∫∫ ∇eᵀ S(e) dζ dA,   D = ∫∫ ∇eᵀ ∂S/∂e ∇e + S·∇∇e dζ dA,   ∇e = ((1 + ζ κ ∇tᵀ) T_m, ζ t T_b)

with the matrix T from sampled to Cartesian strains (`element.to_cartesian`). Transverse shear γ, of a
director inclined by φ, stores ½ κ G h t² tan² φ (`shear_energy`). St Venant–Kirchhoff's law has t = C = 1
and the stresses of `Element`.
"""

from dataclasses import dataclass, replace
from typing import Any, Self

import numpy as np

from fem_reference.shell.element import BENDING, MEMBRANE, SHEAR, Element, arrays, to_cartesian, weighed
from fem_reference.shell.laws import Law
from fem_reference.shell.transverse_shear import linear_shear_energy, shear_energy
from fem_reference.surface.biquadratic import integrated
from fem_reference.surface.constants import Values, material_with
from fem_reference.surface.materials import section_of
from fem_reference.surface.triad import Triad, outer
from sheetbench.scenes import Material

_LEVELS, _SHARES = np.polynomial.legendre.leggauss(3)


@dataclass(frozen=True)
class HyperelasticElement(Element):
    """Elements of a material and its law. stiffness: D at zero strain; membrane, bending: T (m, 9, 3, 21);
    slanted: T of shear (m, 9, 2, 12); heights, weights: ζ [m] and ∫ dζ [m] of points through the thickness,
    (3,)."""

    law: Law
    material: Material
    membrane: np.ndarray
    bending: np.ndarray
    slanted: np.ndarray
    heights: np.ndarray
    weights: np.ndarray
    coupled = True

    @classmethod
    def of(cls, nodes: np.ndarray, material: Material, thickness: float, law: Law) -> Self:
        """Return elements with nodes at (m, 9, 2) [m]. Raises BadInput if one is inverted."""
        linear, half = arrays(nodes, *section_of(material, thickness)), 0.5 * thickness
        return cls(*linear, law, material, *to_cartesian(nodes)[:3], half * _LEVELS, half * _SHARES)

    def stress(self, strain: np.ndarray) -> np.ndarray:
        """Return s (m, 54), conjugate to the sampled strains."""
        forms = self.membrane, self.bending, self.slanted
        pulls = zip(forms, self._resultants(strain), strict=True)
        parts = [np.einsum("egak,ega->ek", form, resultant, optimize=True) for form, resultant in pulls]
        return np.concatenate(parts, axis=1)

    def resultants(self, values: Values, strain: np.ndarray) -> tuple[np.ndarray, ...]:
        material, half = material_with(values), 0.5 * values["thickness"]
        other = replace(self, material=material, heights=half * _LEVELS, weights=half * _SHARES)
        return other._resultants(strain)

    def _resultants(self, strain: np.ndarray) -> tuple[np.ndarray, ...]:
        """Return stress resultants conjugate to E, κ (m, 9, 3) and γ (m, 9, 2), times areas."""
        stretch, curvature = self._strains(strain)
        t, slope, _ = self.law.thickness(self.material, stretch)
        stress = self._response(stretch, t[..., None] * curvature).first * self._volumes[..., None]
        force, moment = stress.sum(axis=2), np.einsum("egza,z->ega", stress, self.heights)
        force = force + np.sum(moment * curvature, axis=-1)[..., None] * slope
        shear, leaning = (self._shear * self.areas)[..., None], self._shear_triad(stretch, strain)
        force = force + shear * leaning.first[..., :3]
        return force, t[..., None] * moment, shear * leaning.first[..., 3:]

    def moduli(self, strain: np.ndarray) -> np.ndarray:
        """Return D (m, 54, 54)."""
        stretch, curvature = self._strains(strain)
        t, slope, bend = self.law.thickness(self.material, stretch)
        _, stress, tangent = self._response(stretch, t[..., None] * curvature)
        by_height = tangent * self.weights[:, None, None]
        force, mixed, turn = (np.einsum("egzab,z->egab", by_height, self.heights**n) for n in range(3))
        moment = np.einsum("egza,z->ega", stress, self.weights * self.heights)
        by_thinning, turned = weighed(mixed, curvature), weighed(turn, curvature)
        force += outer(by_thinning, slope) + outer(slope, by_thinning)
        force += np.sum(turned * curvature, axis=-1)[..., None, None] * outer(slope, slope)
        force += np.sum(moment * curvature, axis=-1)[..., None, None] * bend
        t, areas = t[..., None, None], self.areas
        mixed = t * (mixed + outer(slope, turned)) + outer(slope, moment)
        leaning, out = self._shear * self._shear_triad(stretch, strain).second, np.zeros_like(self.stiffness)
        out[:, MEMBRANE, MEMBRANE] = integrated(self.membrane, force + leaning[..., :3, :3], areas)
        out[:, BENDING, BENDING] = integrated(self.bending, t * t * turn, areas)
        out[:, SHEAR, SHEAR] = integrated(self.slanted, leaning[..., 3:, 3:], areas)
        out[:, MEMBRANE, BENDING] = integrated(self.membrane, mixed, areas, self.bending)
        out[:, MEMBRANE, SHEAR] = integrated(self.membrane, leaning[..., :3, 3:], areas, self.slanted)
        for part in (BENDING, SHEAR):
            out[:, part, MEMBRANE] = out[:, MEMBRANE, part].swapaxes(1, 2)
        return out

    def energies(self, strain: np.ndarray) -> dict[str, float]:
        """Return the energy [J] of strains e (m, 54): of stretch, of bending (the rest), of shear."""
        stretch, curvature = self._strains(strain)
        bent = self.law.thickness(self.material, stretch).value[..., None] * curvature
        values = (self._response(stretch, part).value for part in (bent, 0.0 * bent))
        total, membrane = (float(np.sum(self._volumes * value)) for value in values)
        shear = self._shear * np.sum(self.areas * self._shear_triad(stretch, strain).value)
        return {"membrane": membrane, "bending": total - membrane, "shear": float(shear)}

    def _strains(self, strain: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return E and κ (m, 9, 3) at every element's points from the sampled strains (m, ≥ 42)."""
        forms = (self.membrane, MEMBRANE), (self.bending, BENDING)
        stretch, curvature = (np.einsum("egak,ek->ega", form, strain[:, part]) for form, part in forms)
        return stretch, curvature

    def _response(self, stretch: np.ndarray, bent: np.ndarray) -> Triad:
        """Return the law's response to E and t κ through the thickness, (m, 9, 3, …)."""
        strain = stretch[:, :, None] + self.heights[:, None] * bent[:, :, None]
        return self.law.response(self.material, strain)

    def _shear_triad(self, stretch: np.ndarray, strain: np.ndarray) -> Triad:
        """Return the shear energy at every element's points, quadratic unless the law is for large
        strains."""
        leaning = np.einsum("egak,ek->ega", self.slanted, strain[:, SHEAR])
        if not self.law.stands_any_strain:
            return linear_shear_energy(leaning)
        return shear_energy(self.material.poisson, stretch, leaning)

    @property
    def _shear(self) -> Any:
        """Shear stiffness κ G h [N/m]."""
        return section_of(self.material, self.weights.sum()).shear[0, 0]

    @property
    def _volumes(self) -> np.ndarray:
        """Volumes (m, 9, 3) [m³] of the integration points."""
        return self.areas[:, :, None] * self.weights
