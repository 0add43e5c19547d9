"""The rigid motions that a scene's supports and actuators leave free: a static answer needs none."""

from __future__ import annotations

from functools import lru_cache
from typing import TYPE_CHECKING

import numpy as np

from sheetbench.scenes.actuators import Chain
from sheetbench.scenes.errors import SceneError
from sheetbench.scenes.sheet import Sheet
from sheetbench.scenes.supports import Support, held_axes, holds_tilt

if TYPE_CHECKING:
    from sheetbench.scenes.scene import Scene


def free_rigid_motions(scene: Scene) -> list[str]:
    """Names of the rigid motions that supports and actuators leave free (empty: a static answer can exist).

    An actuator whose base is held, or that prescribes the edge's motion, leaves none.
    A support fixes rows of the rigid velocity t + θ × X at both ends of its edge and, if it holds
    the tilt, those of θ × e_z; what the stacked rows leave in their null space is free.
    """
    if any(not isinstance(actuator, Chain) or actuator.base != "free" for actuator in scene.actuators):
        return []
    return list(_left_free(scene.sheet, scene.supports))


@lru_cache(maxsize=64)
def _left_free(sheet: Sheet, supports: tuple[Support, ...]) -> tuple[str, ...]:
    """Names of the rigid motions that supports leave free: asked again at every solve of a scene."""
    centre = np.array([sheet.length_x / 2, sheet.length_y / 2, 0.0])
    scale = max(sheet.lengths)
    rows = [np.zeros(6)]
    for support in supports:
        for end in sheet.edge_ends(support.edge):
            arm = (np.array([*end, 0.0]) - centre) / scale
            velocity = np.hstack([np.eye(3), -_cross_matrix(arm)])
            rows.extend(velocity[axis] for axis in held_axes(support))
        if holds_tilt(support):
            turned = np.hstack([np.zeros((3, 3)), -_cross_matrix(np.array([0.0, 0.0, 1.0]))])
            rows.extend(turned[axis] for axis in held_axes(support))
    _, singular, motions = np.linalg.svd(np.array(rows))
    rank = int(np.sum(singular > 1e-9))
    names = [f"{kind} {axis}" for kind in ("translation along", "rotation about") for axis in "xyz"]
    free = motions[rank:]
    moved = np.linalg.norm(free, axis=0)
    return tuple(name for name, share in zip(names, moved, strict=True) if share > 1e-6)


def require_static(scene: Scene) -> None:
    """Raise SceneError unless the supports stop every rigid motion."""
    free = free_rigid_motions(scene)
    if free:
        raise SceneError(
            f"scene '{scene.name}': support: nothing stops {', '.join(free)}; a static answer needs supports "
            'that stop every rigid motion (for instance kind = "clamped" on one edge)'
        )


def _cross_matrix(v: np.ndarray) -> np.ndarray:
    return np.array([[0.0, -v[2], v[1]], [v[2], 0.0, -v[0]], [-v[1], v[0], 0.0]])
