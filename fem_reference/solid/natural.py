"""Bricks of a sheet that is not flat at rest: sampled strains less those of the natural stretch
U(z) = 1 + e0 − z k0, which leaves the thickness alone; z is measured from the plane that e0 is of."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from fem_reference.solid.element import SAMPLED, Bricks, reference, shape
from fem_reference.solid.materials import PAIRS
from fem_reference.surface.materials import pulled_back
from fem_reference.surface.natural import green
from sheetbench.scenes import Scene
from sheetbench.scenes.meaning.composition import of_sheet
from sheetbench.scenes.meaning.natural_state import NaturalState, natural_at


def at_rest(plain: Bricks, scene: Scene) -> tuple[Bricks, NaturalState | None]:
    """Return the bricks of a scene from those of the sheet as drawn, and their natural strains (m, k)."""
    sampled = np.concatenate([np.array(sites) for sites in SAMPLED]).T
    sites = shape((sampled + 1.0) / 2.0)[0].T @ plain.positions  # (m, k, 3)
    points = shape(reference().points)[0].T @ plain.positions[..., :2]
    state, mid_surface = natural_at(scene, sites[..., :2]), natural_at(scene, points)
    if state is None or mid_surface is None:
        return plain, None
    plies = of_sheet(scene).plies
    middle = -(plies[0].low + 0.5) * scene.sheet.thickness if plies else 0.0
    height = (sites[..., 2] - middle)[..., None, None]
    centre = plain.positions.mean(axis=1, keepdims=True)  # about which no digits are lost
    sides, plan = plain.gradient(-centre)[..., :2], (plain.positions - centre)[..., :2]

    def sample(strain: np.ndarray, curvature: np.ndarray) -> np.ndarray:
        return np.einsum("ekic,ekcd,eid->ek", sides, green(strain - height * curvature), plan, optimize=True)

    stretch = np.tile(np.eye(3), (*points.shape[:2], 1, 1))
    stretch[..., :2, :2] += mid_surface.at()[0]
    on = pulled_back(np.linalg.inv(stretch), PAIRS) @ plain.to_strain
    volumes = np.linalg.det(stretch) * plain.volumes
    return replace(plain, to_strain=on, volumes=volumes), state.made(sample)
