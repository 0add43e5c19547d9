"""Mass and weight of a scene's payloads."""

from __future__ import annotations

import numpy as np

from sheetbench.scenes.meaning.region import area_in
from sheetbench.scenes.objects.fields import SceneFields
from sheetbench.scenes.objects.loads import AreaLoad, PointLoad


def carried(scene: SceneFields) -> float:
    """Return the mass [kg] of all payloads."""
    return sum(payload.mass for payload in scene.masses)


def weights(scene: SceneFields) -> tuple[PointLoad | AreaLoad, ...]:
    """Return the payloads' weight as loads, with gravity's history; none without gravity."""
    if scene.gravity is None:
        return ()
    found: list[PointLoad | AreaLoad] = []
    for payload in scene.masses:
        x, y, z = (payload.mass * np.array(scene.gravity.acceleration)).tolist()
        if payload.at is not None:
            found.append(PointLoad(at=payload.at, force=(x, y, z), history=scene.gravity.history))
            continue
        area = area_in(scene, payload.where)
        spread = AreaLoad(force_per_area=(x / area, y / area, z / area), where=payload.where)
        found.append(spread.replace(history=scene.gravity.history))
    return tuple(found)
