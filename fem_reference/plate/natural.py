"""The linear plate that is not flat at rest: strains e0 of its middle and −k0 in bending, taken off its own,

f = ∫ (Bᵀ A e0 − Bᵀ D k0) dA,    W = ½ ∫ (e − e0)·A (e − e0) + (κ + k0)·D (κ + k0) dA = ½ u·K u − f·u + W₀."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from fem_reference.plate.element import PlateElements
from fem_reference.surface.materials import Section


class OwnStrains(NamedTuple):
    """Membrane and bending strains (m, 9, 3) without stress; f (N,) [N, N·m] on all unknowns."""

    strains: tuple[np.ndarray | float, np.ndarray | float] = (0.0, 0.0)
    force: np.ndarray | float = 0.0


def own_strains(
    elements: PlateElements, section: Section, size: int, strain: np.ndarray, curvature: np.ndarray
) -> OwnStrains:
    """Return those of e0 and k0 at the Gauss points (m, 9, 2, 2)."""
    xx_yy_2xy = np.array([1.0, 1.0, 2.0])
    strains = [xx_yy_2xy * form[..., [0, 1, 0], [0, 1, 1]] for form in (strain, -curvature)]
    force = np.zeros(size)
    parts = (elements.membrane, section.membrane), (elements.curvature, section.bending)
    for (operator, stiffness), own in zip(parts, strains, strict=True):
        stress = elements.areas[..., None] * (stiffness @ own[..., None])[..., 0]
        np.add.at(force, elements.unknowns, np.einsum("mqic,mqi->mc", operator, stress))
    return OwnStrains((strains[0], strains[1]), force)
