"""The kinds of obstacle, rigid bodies that the sheet touches: a plane, a sphere, a cylinder.

Positions are of the obstacle's own surface: with φ(x) the distance of a point of the mid-surface from it, the
sheet touches where φ = h/2. A plane that the flat sheet lies on is at z = −h/2. Distances of the flat sheet,
for what is refused or reported before anything is solved, are computed here; each solver has its own.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Annotated, Literal

import numpy as np
from pydantic import Field, field_validator

from sheetbench.errors import SceneError
from sheetbench.scenes.quantities import Frozen, Length, NonNegative, Unit, Vector3
from sheetbench.scenes.supports import Clamped, Hinged, Motion

if TYPE_CHECKING:
    from sheetbench.scenes.scene import Scene

INSIDE = 1e-6  # of the thickness: the depth from which on a sheet begins inside an obstacle
SLIP_SPEED = 1e-3  # m/s, v₀ of the friction −μ p v/√(v² + v₀²)
GRID = 65  # points a side of a drawn sheet that its distance is looked for at


class _Obstacle(Frozen):
    position: Annotated[Vector3, Unit("m")]
    """A point of the plane, the sphere's centre, a point of the cylinder's axis."""
    motion: Motion | None = Field(default=None, kw_only=True)
    """How the obstacle moves over time; statics bring it to its last place as the load grows."""
    friction: NonNegative = Field(default=0.0, kw_only=True)
    """Coefficient of friction, in motion only."""
    contact_damping: Annotated[NonNegative, Unit("s/m")] = Field(default=0.0, kw_only=True)
    """τ, in motion only: the pressure is k d (1 + τ ḋ) at a depth d; a part of the sheet that meets the
    obstacle at a speed v ≪ 1/τ leaves it at about (1 − 2 τ v/3) v."""

    @property
    def direction(self) -> np.ndarray:
        """A plane's normal or a cylinder's axis as a unit vector (3,), 0 of a sphere."""
        along = np.array(getattr(self, "normal", getattr(self, "axis", (0.0, 0.0, 0.0))))
        unit: np.ndarray = along / (np.linalg.norm(along) or 1.0)
        return unit

    def displacement(self, load_factor: float, time: float | None = None) -> np.ndarray:
        """Return how far the obstacle has moved, (3,) [m]: at a time [s] or, without one, a share of its last
        displacement."""
        if self.motion is None:
            return np.zeros(3)
        last = self.motion.time[-1]
        moved: np.ndarray = self.motion.course.at(last if time is None else time)
        return load_factor * moved if time is None else moved


def _turned_somewhere(vector: Vector3) -> Vector3:
    if not any(vector):
        raise ValueError("needs a direction, not [0, 0, 0]")
    return vector


class Plane(_Obstacle):
    """A half space below a plane."""

    kind: Literal["plane"] = Field(default="plane", kw_only=True)
    normal: Vector3 = (0.0, 0.0, 1.0)
    """Out of the obstacle, towards the sheet, of any length."""

    _direction = field_validator("normal")(_turned_somewhere)


class Sphere(_Obstacle):
    """A ball."""

    kind: Literal["sphere"] = Field(default="sphere", kw_only=True)
    radius: Length
    """Of the ball."""


class Cylinder(_Obstacle):
    """A round bar without ends."""

    kind: Literal["cylinder"] = Field(default="cylinder", kw_only=True)
    axis: Vector3
    """Along the bar, of any length."""
    radius: Length
    """Of the bar."""

    _direction = field_validator("axis")(_turned_somewhere)


AnyObstacle = Plane | Sphere | Cylinder
Obstacle = Annotated[AnyObstacle, Field(discriminator="kind")]


def obstacles_by_name(scene: Scene) -> dict[str, AnyObstacle]:
    """Return the obstacles by the names that answers give them: "obstacle 1" by their number."""
    return {f"obstacle {n}": obstacle for n, obstacle in enumerate(scene.obstacles, start=1)}


def farther(scene: Scene, obstacle: AnyObstacle, factor: float) -> AnyObstacle:
    """Return an obstacle at so many times its distance from the flat sheet; one that it touches stays."""
    gap, away = nearest(scene, obstacle)
    x, y, z = (np.array(obstacle.position) + (factor - 1.0) * gap * away).tolist()
    return obstacle.replace(position=(x, y, z))


def nearest(scene: Scene, obstacle: AnyObstacle) -> tuple[float, np.ndarray]:
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


def conflicts(scene: Scene) -> Iterator[tuple[str, str | None]]:
    """Yield what does not go together, key and reason, no reason where it does."""
    for name, obstacle in obstacles_by_name(scene).items():
        gap, _ = nearest(scene, obstacle)
        inside = f"the flat sheet begins {-1e3 * gap:.4g} mm inside it, with half its thickness; move it away"
        yield f"{name}.position: ", inside if gap < -INSIDE * scene.sheet.thickness else None
        if obstacle.motion is not None:
            yield f"{name}.motion: ", _onto_held_edges(scene, obstacle)


def _onto_held_edges(scene: Scene, obstacle: AnyObstacle) -> str | None:
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


def require_no_obstacles(scene: Scene, who: str) -> None:
    """Raise SceneError where there are obstacles."""
    if scene.obstacles:
        raise SceneError(f"scene '{scene.name}': obstacle: {who} knows no contact; leave [[obstacle]] out")


def require_frictionless(scene: Scene) -> None:
    """Raise SceneError where an obstacle has friction, for a sheet at rest."""
    for name, obstacle in obstacles_by_name(scene).items():
        if obstacle.friction > 0.0:
            raise SceneError(
                f"scene '{scene.name}': {name}.friction = {obstacle.friction:g}: at rest the answer would "
                "depend on the path that the sheet came by; let it settle in motion (--duration), or take "
                "friction = 0"
            )
