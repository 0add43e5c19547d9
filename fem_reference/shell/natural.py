"""Natural strains of shell elements, where `element` samples membrane and bending ones; shear has none."""

from __future__ import annotations

import numpy as np

from fem_reference.shell.element import GRIDS, STRAINS
from fem_reference.surface.biquadratic import product_grid, shape
from fem_reference.surface.natural import covariant, green
from sheetbench.scenes import Scene
from sheetbench.scenes.meaning.natural_state import NaturalState, natural_at

COMPONENTS = {"rr": (0, 0), "ss": (1, 1), "rs": (0, 1)}
_VALUES, _SLOPES = zip(*(shape(*product_grid(*GRIDS[name])) for name in COMPONENTS), strict=True)


def natural_strains(scene: Scene, nodes: np.ndarray) -> NaturalState | None:
    """Return those (m, 54) of elements with nodes (m, 9, 2) [m], None of a sheet that is flat at rest."""
    state = natural_at(scene, np.concatenate(_VALUES) @ nodes)
    if state is None:
        return None
    sides = [
        np.concatenate([slope[a] for slope, a in zip(_SLOPES, axes, strict=True)]) @ nodes
        for axes in zip(*COMPONENTS.values(), strict=True)
    ]

    def sample(strain: np.ndarray, curvature: np.ndarray) -> np.ndarray:
        mixed = strain @ curvature
        forms = green(strain), -curvature - 0.5 * (mixed + mixed.swapaxes(-1, -2))
        parts = [covariant(form, *sides) for form in forms]
        none = np.zeros((len(nodes), STRAINS - 2 * parts[0].shape[1]))
        return np.concatenate([*parts, none], axis=1)

    return state.made(sample)
