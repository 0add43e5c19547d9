"""The arrows of a scene's loads, in pictures and in views.

Of all point loads the largest has the longest arrow. Arrows of an edge load stand along its edge, of a
pressure all over the sheet, along its normal.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from comparisons.pictures.plan import edge_ends
from sheetbench.scenes import AreaLoad, EdgeLoad, PointLoad, Pressure, Scene
from sheetbench.scenes.objects.shapes import Shape

POINT, EDGE, PRESSURE = 0.16, 0.1, 0.08  # lengths, of the sheet's longer side; of points the largest
SHORTEST = 0.4  # of any other point's, of the largest
ALONG = 5  # arrows along an edge
ACROSS = np.linspace(0.2, 0.8, 4)  # shares of both sides where a pressure's arrows stand


def load_arrows(scene: Scene, normals: Callable[[np.ndarray], np.ndarray]) -> tuple[np.ndarray, np.ndarray]:
    """Return plan points (n, 2) [m] where arrows start, and the arrows (n, 3) in units of the sheet's longer
    side; normals: unit normals (n, 3) of the deformed sheet at plan points."""
    points = [load for load in scene.loads if isinstance(load, PointLoad)]
    plan = [np.array([load.at for load in points]).reshape(-1, 2)]
    arrows = [point_arrows(np.array([load.force for load in points]).reshape(-1, 3))]
    for load in scene.loads:
        if isinstance(load, EdgeLoad) and any(load.force_per_length):
            plan.append(edge_plan(scene, load.edge, np.linspace(0.0, 1.0, ALONG), load.where))
            arrows.append(np.tile(EDGE * _direction(load.force_per_length), (len(plan[-1]), 1)))
        elif isinstance(load, AreaLoad) and any(load.force_per_area):
            plan.append(_all_over(scene, load.where))
            arrows.append(np.tile(PRESSURE * _direction(load.force_per_area), (len(plan[-1]), 1)))
        elif isinstance(load, Pressure) and load.value:
            plan.append(_all_over(scene, load.where))
            arrows.append(PRESSURE * np.sign(load.value) * normals(plan[-1]))
    return np.vstack(plan), np.vstack(arrows)


def edge_plan(scene: Scene, edge: str, shares: np.ndarray, where: Shape | None = None) -> np.ndarray:
    """Plan points (n, 2) [m] at shares of every part of an edge that the sheet reaches; where: in a shape."""
    ends = np.array(edge_ends(scene, edge, where))
    return np.vstack([start + shares[:, None] * (end - start) for start, end in ends])


def _all_over(scene: Scene, where: Shape | None) -> np.ndarray:
    """Plan points (n, 2) [m] evenly over the sheet, or over its part in a shape."""
    box = np.array([(x, y) for x in ACROSS for y in ACROSS])
    if where is None and not scene.pierced:
        return box * scene.sheet.lengths
    part = scene.region if where is None else scene.region.intersection(where.area)
    from shapely import Point

    low, high = np.array(part.bounds).reshape(2, 2)
    points = low + box * (high - low)
    inside = points[[part.contains(Point(*point)) for point in points]]
    return inside if len(inside) else np.array(part.representative_point().coords)


def _direction(force: tuple[float, float, float]) -> np.ndarray:
    return np.array(force) / np.linalg.norm(force)


def point_arrows(forces: np.ndarray) -> np.ndarray:
    """Arrows (n, 3) of forces (n, 3), in units of the sheet's longer side: in proportion to the forces, but
    long enough to be seen."""
    sizes = np.linalg.norm(forces, axis=1, keepdims=True)
    largest = float(sizes.max(initial=0.0))
    if not largest:
        return np.zeros_like(forces)
    lengths = POINT * np.maximum(sizes / largest, SHORTEST)
    arrows: np.ndarray = lengths * forces / np.where(sizes > 0.0, sizes, 1.0)
    return arrows
