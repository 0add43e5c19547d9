"""Distances from the obstacles of a scene: their gradients, whether a way leads through, and what of the flat
sheet's refuses or describes a scene.

With y the position of a point less the obstacle's, across its axis if it has one, and P the projector there,

    plane               φ = y·n,      n = ∇φ,     ∇n = 0
    sphere, cylinder    φ = |y| − R,  n = y/|y|,  ∇n = (P − n nᵀ)/|y|
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from sheetbench.errors import SceneError
from sheetbench.scenes.objects.fields import SceneFields
from sheetbench.scenes.objects.obstacles import AnyObstacle, Plane
from sheetbench.scenes.objects.supports import Clamped, Hinged

INSIDE = 1e-6  # of the thickness: the depth from which on a sheet begins inside an obstacle
GRID = 65  # points a side of a drawn sheet or along an edge that a distance is looked for at


class Near(NamedTuple):
    """Points beside an obstacle: y (…, 3) [m], φ (…) [m], n (…, 3), 1/|y| (…) [1/m], 0 of a plane, and P."""

    across: np.ndarray
    distance: np.ndarray
    normal: np.ndarray
    bend: np.ndarray
    projector: np.ndarray

    @property
    def outer(self) -> np.ndarray:
        """n nᵀ (…, 3, 3)."""
        product: np.ndarray = self.normal[..., :, None] * self.normal[..., None, :]
        return product

    @property
    def curvature(self) -> np.ndarray:
        """∇n (…, 3, 3) [1/m]."""
        bent: np.ndarray = self.bend[..., None, None] * (self.projector - self.outer)
        return bent


def projector(obstacle: AnyObstacle) -> np.ndarray:
    """Return P (3, 3) across a cylinder's axis or on a plane, the identity of a sphere."""
    return np.eye(3) - np.outer(obstacle.direction, obstacle.direction)


def near(obstacle: AnyObstacle, x: np.ndarray, load_factor: float = 1.0, time: float | None = None) -> Near:
    """Return where places (…, 3) [m] are beside an obstacle that has moved (`displacement`)."""
    y, across = x - obstacle.position - obstacle.displacement(load_factor, time), projector(obstacle)
    if isinstance(obstacle, Plane):
        normal = np.broadcast_to(obstacle.direction, y.shape)
        return Near(y, y @ obstacle.direction, normal, np.zeros(y.shape[:-1]), across)
    y = y @ across
    length = np.maximum(np.sqrt((y * y).sum(axis=-1)), 1e-300)
    return Near(y, length - obstacle.radius, y / length[..., None], 1.0 / length, across)


def mean_normal(obstacle: AnyObstacle, start: Near, end: Near) -> np.ndarray:
    """Return n̄ (…, 3) with n̄·Δy = Δφ exactly: n, or (y₀ + y₁)/(|y₀| + |y₁|) as Δ|y|² = (y₀ + y₁)·Δy."""
    if isinstance(obstacle, Plane):
        return end.normal
    lengths = start.distance + end.distance + 2.0 * obstacle.radius
    mean: np.ndarray = (start.across + end.across) / lengths[..., None]
    return mean


def share_of_way(obstacle: AnyObstacle, start: Near, end: Near, offset: np.ndarray) -> float:
    """Return up to which share straight ways between points, which touch at a distance `offset` (…) [m], lead
    none of them deeper than half the radius, nor through: 1 for all of them, and of a plane."""
    if isinstance(obstacle, Plane):
        return 1.0
    x, v = start.across, end.across - start.across
    core = 0.5 * obstacle.radius + offset
    a, b, c = (v * v).sum(axis=-1), (x * v).sum(axis=-1), (x * x).sum(axis=-1) - core**2
    hit = (b * b > a * c) & (b < 0.0) & (c > 0.0)
    first = (-b[hit] - np.sqrt((b * b - a * c)[hit])) / a[hit]
    return float(0.99 * first.min(initial=1.0 / 0.99))


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
    sides = scene.sheet.lengths
    if scene.pierced or isinstance(obstacle, Plane):
        import shapely

        x, y = (each.ravel() for each in np.meshgrid(*(np.linspace(0.0, side, GRID) for side in sides)))
        plan = np.column_stack([x, y])[shapely.intersects_xy(scene.region, x, y)]
    else:  # a square of distances is convex in the plan
        from scipy.optimize import lsq_linear

        at, across = obstacle.position + obstacle.displacement(0.0, 0.0), projector(obstacle)
        plan = lsq_linear(across[:, :2], across @ at, ([0.0, 0.0], sides)).x[None]
    found = near(obstacle, np.pad(plan, ((0, 0), (0, 1))), time=0.0)
    least = found.distance.argmin()
    return float(found.distance[least]) - 0.5 * scene.sheet.thickness, -found.normal[least]


def conflicts(scene: SceneFields) -> Iterator[tuple[str, str | None]]:
    """Yield what does not go together, key and reason, no reason where it does."""
    deepest = INSIDE * scene.sheet.thickness
    for name, obstacle in obstacles_by_name(scene).items():
        gap, _ = nearest(scene, obstacle)
        inside = f"the flat sheet begins {-1e3 * gap:.4g} mm inside it, with half its thickness; move it away"
        yield f"{name}.position: ", inside if gap < -deepest else None
        for support in scene.supports if obstacle.motion is not None else ():
            if isinstance(support, Clamped | Hinged) and support.where is None and support.motion is None:
                edge = np.linspace(*scene.sheet.edge_ends(support.edge), GRID)
                distance = near(obstacle, np.pad(edge, ((0, 0), (0, 1)))).distance.min()
                gap = float(distance) - 0.5 * scene.sheet.thickness
                inside = (
                    f"in its last place edge {support.edge}, which is held, is {-1e3 * gap:.4g} mm inside it"
                )
                yield f"{name}.motion: ", f"{inside}; move it less far" if gap < -deepest else None


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
