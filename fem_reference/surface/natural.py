"""Sheets that are not flat at rest: their strains are those from the natural state.

With the natural stretch U(z) = 1 + e0 − z k0 at the height z (`scenes.objects.natural`) a law of strain
takes E − E0(z), 2 E0 = U² − 1, of a shell to first order in z

    E0 = e0 + ½ e0²,    κ0 = −k0 − ½ (e0 k0 + k0 e0),

and its energy is that per natural area: strains of the natural sides are U⁻¹ (E − E0) U⁻¹, areas det U times
as large, U = 1 + e0 that of the mid-surface at the full share. Elements sample E0 where they sample E.
"""

from __future__ import annotations

import numpy as np

from fem_reference.surface.biquadratic import AT_GAUSS
from fem_reference.surface.materials import Section, pulled_back
from sheetbench.scenes import Scene
from sheetbench.scenes.meaning.natural_state import natural_at

IN_PLANE = ((0, 0), (1, 1), (0, 1))


def green(stretch: np.ndarray) -> np.ndarray:
    """½ (U² − 1) of U − 1 (…, 2, 2)."""
    return np.asarray(stretch + 0.5 * stretch @ stretch)


def covariant(form: np.ndarray, first: np.ndarray, second: np.ndarray) -> np.ndarray:
    """X,α · E0 X,β (m, k) of E0 (m, k, 2, 2) and the sites' sides (m, k, 2)."""
    return np.asarray(np.einsum("eki,ekij,ekj->ek", first, form, second))


def grown(section: Section, scene: Scene, corners: np.ndarray) -> Section:
    """Return the section per area and strain of the sheet as drawn, of one per natural area and strain;
    corners: the elements' nodes (m, 9, 2) [m]."""
    state = natural_at(scene, AT_GAUSS[0] @ corners)
    if state is None or not (strain := state.at()[0]).any():
        return section
    stretch = np.eye(2) + strain
    inverse, area = np.linalg.inv(stretch), np.linalg.det(stretch)[..., None, None]
    turn = pulled_back(inverse, IN_PLANE)
    back = area * turn.swapaxes(-1, -2)
    shear = area * inverse @ section.shear @ inverse
    return Section(back @ section.membrane @ turn, back @ section.bending @ turn, shear)
