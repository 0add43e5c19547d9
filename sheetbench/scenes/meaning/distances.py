"""Distances of the flat sheet from the obstacles of its scene, for refusals and reports before a solve.

Each solver has its own.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from sheetbench.errors import SceneError
from sheetbench.scenes.objects.fields import SceneFields
from sheetbench.scenes.objects.obstacles import AnyObstacle, Plane
from sheetbench.scenes.objects.supports import Clamped, Hinged

INSIDE = 1e-6  # of the thickness: the depth from which on a sheet begins inside an obstacle
GRID = 65  # points a side of a drawn sheet that its distance is looked for at


def obstacles_by_name(scene: SceneFields) -> dict[str, AnyObstacle]:
    """Return the obstacles by the names that answers give them: "obstacle 1" by their number."""
    return {f"obstacle {n}": obstacle for n, obstacle in enumerate(scene.obstacles, start=1)}


def farther(scene: SceneFields, obstacle: AnyObstacle, factor: float) -> AnyObstacle:
    """Return an obstacle at so many times its distance from the flat sheet; one that it touches stays."""
    gap, away = nearest(scene, obstacle)
    x, y, z = (np.array(obstacle.position) + (factor - 1.0) * gap * away).tolist()
    return obstacle.replace(position=(x, y, z))


def nearest(scene: SceneFields, obstacle: AnyObstacle) -> tuple[float, np.ndarray]:
    """Return the smallest gap [m] between the flat sheet's face and an obstacle where a motion begins, < 0
    where the sheet begins inside it, and the way from the sheet to it (3,): exact of a rectangle, of a drawn
    sheet at the points of a grid."""
    from scipy.optimize import lsq_linear

    at = np.array(obstacle.position) + obstacle.displacement(0.0, 0.0)
    half, (lx, ly) = 0.5 * scene.sheet.thickness, scene.sheet.lengths
    if scene.pierced:
        import shapely

        x, y = np.meshgrid(np.linspace(0.0, lx, GRID), np.linspace(0.0, ly, GRID))
        inside = shapely.intersects_xy(scene.region, x.ravel(), y.ravel())
        plan = np.column_stack([x.ravel(), y.ravel(), np.zeros(x.size)])[inside]
    else:
        plan = np.array([[0.0, 0.0, 0.0], [lx, 0.0, 0.0], [0.0, ly, 0.0], [lx, ly, 0.0]])
    if isinstance(obstacle, Plane):
        return float(((plan - at) @ obstacle.direction).min()) - half, -obstacle.direction
    across = np.eye(3) - np.outer(obstacle.direction, obstacle.direction)
    if scene.pierced:
        ways = (at - plan) @ across
        way = ways[np.argmin(np.linalg.norm(ways, axis=1))]
    else:  # a square of distances is convex in the plan
        touched = lsq_linear(across[:, :2], across @ at, ([0.0, 0.0], [lx, ly])).x
        way = across @ (at - np.append(touched, 0.0))
    distance = float(np.linalg.norm(way))
    return distance - obstacle.radius - half, way / (distance or 1.0)


def conflicts(scene: SceneFields) -> Iterator[tuple[str, str | None]]:
    """Yield what does not go together, key and reason, no reason where it does."""
    for name, obstacle in obstacles_by_name(scene).items():
        gap, _ = nearest(scene, obstacle)
        inside = f"the flat sheet begins {-1e3 * gap:.4g} mm inside it, with half its thickness; move it away"
        yield f"{name}.position: ", inside if gap < -INSIDE * scene.sheet.thickness else None
        if obstacle.motion is not None:
            yield f"{name}.motion: ", _onto_held_edges(scene, obstacle)


def _onto_held_edges(scene: SceneFields, obstacle: AnyObstacle) -> str | None:
    """Return why an obstacle cannot come to its last place: an edge is held there."""
    at, half = np.array(obstacle.position) + obstacle.displacement(1.0), 0.5 * scene.sheet.thickness
    across = np.eye(3) - np.outer(obstacle.direction, obstacle.direction)
    for support in scene.supports:
        if isinstance(support, Clamped | Hinged) and support.where is None and support.motion is None:
            start, end = (np.append(corner, 0.0) for corner in scene.sheet.edge_ends(support.edge))
            places = start + np.linspace(0.0, 1.0, GRID)[:, None] * (end - start) - at
            if isinstance(obstacle, Plane):
                gap = float((places @ obstacle.direction).min()) - half
            else:
                gap = float(np.linalg.norm(places @ across, axis=1).min()) - obstacle.radius - half
            if gap < -INSIDE * scene.sheet.thickness:
                deep = f"{-1e3 * gap:.4g} mm inside it"
                return f"in its last place edge {support.edge}, which is held, is {deep}; move it less far"
    return None


def require_no_obstacles(scene: SceneFields, who: str) -> None:
    """Raise SceneError where there are obstacles."""
    if scene.obstacles:
        raise SceneError(f"scene '{scene.name}': obstacle: {who} has no contact; leave [[obstacle]] out")


def require_frictionless(scene: SceneFields) -> None:
    """Raise SceneError where an obstacle has friction, for a sheet at rest."""
    for name, obstacle in obstacles_by_name(scene).items():
        if obstacle.friction > 0.0:
            raise SceneError(
                f"scene '{scene.name}': {name}.friction = {obstacle.friction:g}: at rest the answer would "
                "depend on the path that the sheet came by; let it settle in motion (--duration), or take "
                "friction = 0"
            )
