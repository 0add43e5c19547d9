"""Natural strains of shells that are not flat at rest, where elements sample membrane and bending strains.

Shear has none. Sections refer to the natural sides (`fem_reference.surface.materials.green`).
"""

import numpy as np

from fem_reference.shell.element import BENDING, MEMBRANE, STRAINS, TABLES
from fem_reference.surface import materials
from fem_reference.surface.biquadratic import AT_GAUSS
from fem_reference.surface.materials import Section, green, stretched
from sheetbench.scenes import Scene
from sheetbench.scenes.meaning.natural_state import natural_at


def natural_strains(nodes: np.ndarray, e: np.ndarray, k: np.ndarray) -> np.ndarray:
    """Return natural strains (m, 54) of elements at (m, 9, 2) [m] from e0, k0 (m, 21, 2, 2) at the sites."""
    forms = green(e), 0.5 * (green(e - k) - green(e + k))
    parts = [sampled(nodes, form) for form in forms]
    return np.pad(np.concatenate(parts, axis=1), ((0, 0), (0, STRAINS - BENDING.stop)))


def sampled(nodes: np.ndarray, strain: np.ndarray) -> np.ndarray:
    """Return samples (m, 21) of strains (m, 21, 2, 2) in elements with nodes (m, 9, 2) [m]."""
    first, second = TABLES.T[MEMBRANE] @ nodes, TABLES.T[BENDING] @ nodes  # the sites' sides
    return np.einsum("eki,ekij,ekj->ek", first, strain, second)


def grown(section: Section, scene: Scene, corners: np.ndarray) -> Section:
    """Return the section per area and strain of the drawn sheet, from a section per natural area and strain.
    corners: the elements' nodes (m, 9, 2) [m]."""
    state = natural_at(stretched(scene), AT_GAUSS[0] @ corners)
    if state is None or not (strain := state.at()[0]).any():
        return section
    return materials.grown(section, strain)
