"""The linear plate that is not flat at rest: strains e0 of its middle and −k0 in bending, taken off its own,

f = ∫ (Bᵀ A e0 − Bᵀ D k0) dA,    W = ½ ∫ (e − e0)·A (e − e0) + (κ + k0)·D (κ + k0) dA = ½ u·K u − f·u + W₀."""

from __future__ import annotations

import numpy as np

from fem_reference.plate.element import PlateElements
from fem_reference.surface.materials import Section
from fem_reference.surface.natural import at_gauss, in_voigt
from sheetbench.scenes import Scene


class NaturalPlate:
    """The natural state of elements at their Gauss points, of nodes (m, 9, 2) [m] and a section."""

    def __init__(self, scene: Scene, elements: PlateElements, corners: np.ndarray, section: Section):
        self.state, self._elements = at_gauss(scene, corners), elements
        self._parts = (section.membrane, section.bending)

    @property
    def moves(self) -> bool:
        """Whether it changes over time."""
        return self.state is not None and self.state.moves

    def strains(self, factors: np.ndarray | None = None) -> tuple[np.ndarray, np.ndarray]:
        """Membrane and bending strains (m, 9, 3) at factors of its sources, the last ones unless given."""
        if self.state is None:
            none = np.zeros((*self._elements.areas.shape, 3))
            return none, none
        strain, curvature = self.state.at(self.state.factors() if factors is None else factors)
        return in_voigt(strain), -in_voigt(curvature)

    def force(self, size: int, factors: np.ndarray | None = None) -> np.ndarray:
        """f (size,) [N, N·m] on all unknowns."""
        out = np.zeros(size)
        if self.state is None:
            return out
        elements = self._elements
        operators = elements.membrane, elements.curvature
        for operator, own, strain in zip(operators, self._parts, self.strains(factors), strict=True):
            stress = elements.areas[..., None] * (own @ strain[..., None])[..., 0]
            np.add.at(out, elements.unknowns, np.einsum("mqic,mqi->mc", operator, stress))
        return out

    def stored(self, factors: np.ndarray | None = None) -> float:
        """W₀ [J], of the flat plate."""
        parts = zip(self._parts, self.strains(factors), strict=True)
        density = sum(np.einsum("mqi,mqi->mq", e, (own @ e[..., None])[..., 0]) for own, e in parts)
        return 0.5 * float(np.sum(self._elements.areas * density))
