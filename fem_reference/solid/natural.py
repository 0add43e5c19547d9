"""Bricks of a sheet that is not flat at rest: sampled strains less those of the natural stretch
U(z) = 1 + e0 − z k0, which leaves the thickness alone; z is measured from the plane that e0 is of."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from fem_reference.solid.element import SAMPLED, Bricks, reference, shape
from fem_reference.solid.materials import PAIRS
from fem_reference.surface.materials import pulled_back
from fem_reference.surface.natural import covariant, green
from sheetbench.scenes import Scene
from sheetbench.scenes.meaning.composition import of_sheet
from sheetbench.scenes.meaning.natural_state import natural_at


def at_rest(plain: Bricks, scene: Scene) -> Bricks:
    """Return the bricks of a scene from those of the sheet as drawn."""
    tables = [shape((np.array(sites).T + 1.0) / 2.0) for sites in SAMPLED]
    sites = np.concatenate([value.T for value, _ in tables]) @ plain.positions  # (m, k, 3)
    state = natural_at(scene, sites[..., :2])
    if state is None:
        return plain
    sides = [
        np.concatenate([slope[:, a].T for (_, slope), a in zip(tables, axes, strict=True)])
        @ plain.positions[..., :2]
        for axes in zip(*PAIRS, strict=True)
    ]
    twice = np.repeat([1.0 if a == b else 2.0 for a, b in PAIRS], [value.shape[1] for value, _ in tables])
    plies = of_sheet(scene).plies
    middle = -(plies[0].low + 0.5) * scene.sheet.thickness if plies else 0.0
    height = (sites[..., 2] - middle)[..., None, None]

    def sample(strain: np.ndarray, curvature: np.ndarray) -> np.ndarray:
        return twice * covariant(green(strain - height * curvature), *sides)

    points = shape(reference().points)[0].T @ plain.positions[..., :2]
    grown = natural_at(scene, points)
    assert grown is not None
    stretch = np.tile(np.eye(3), (*points.shape[:2], 1, 1))
    stretch[..., :2, :2] += grown.at()[0]
    on = pulled_back(np.linalg.inv(stretch), PAIRS) @ plain.to_strain
    volumes = np.linalg.det(stretch) * plain.volumes
    return replace(plain, to_strain=on, volumes=volumes, natural=state.made(sample))
