"""Nine-node plate element: the shell's (`shell.element`) with its strains linear in the vectors' change.

With the displacement u and the director's tilt β, the director of the flat sheet being e_z,

    ε = sym ∇u      κ = sym ∇β      γ = ∇w + β

are sampled and interpolated as the shell's strains are (MITC9): e = B q with B = H Q₀ of the flat sheet.
Constant strains are represented exactly in any straight-sided quadrilateral, and there are no spurious zero
modes.
"""

from __future__ import annotations

from functools import cached_property

import numpy as np

from fem_reference.shell.element import Element
from fem_reference.surface.biquadratic import AT_GAUSS, jacobians


class PlateElements(Element):
    """m elements; vectors are their changes (m, 18, 3) of positions and directors."""

    @cached_property
    def gradient(self) -> np.ndarray:
        """∇N at the Gauss points (m, 9, 2, 9) [1/m]."""
        inverse = np.linalg.inv(jacobians(self.reference[:, :9, :2], AT_GAUSS[1]))  # ∂ξ_a/∂x_b, by a and b
        return np.einsum("agi,egab->egbi", AT_GAUSS[1], inverse)

    def strain(self, change: np.ndarray) -> np.ndarray:
        return self.step(self.reference, change)

    def operator(self, change: np.ndarray) -> np.ndarray:
        return self.reference

    def geometric(self, step: np.ndarray, stress: np.ndarray) -> np.ndarray:
        return np.zeros_like(step)
