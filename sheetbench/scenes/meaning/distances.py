"""Distances from the obstacles of a scene, their gradients, ways through them, and gaps of the flat sheet.

The distance φ is, with y the position of a point less the obstacle's, across its axis if it has one, and P
the projector across it,

    plane               φ = y·n,      n = ∇φ,     ∇n = 0
    sphere, cylinder    φ = |y| − R,  n = y/|y|

A ball's |y| is ρ = R + o at a point that touches, φ = o. A penalty takes for the depth o − φ

    δ = (ρ² − |y|²)/2ρ,   ∂δ/∂x = −y/ρ,   ∂²δ/∂x² = −P/ρ;     on a plane  δ = o − φ,   ∂δ/∂x = −n

which is o − φ but for (o − φ)²/2ρ, and quadratic over a sheet that is flat between the points that it is
known at.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np

from sheetbench.errors import SceneError
from sheetbench.scenes.objects.fields import SceneFields
from sheetbench.scenes.objects.obstacles import SLIP_SPEED, AnyObstacle, Plane
from sheetbench.scenes.objects.supports import Clamped, Hinged

INSIDE = 1e-6  # of the thickness: the depth from which on a sheet begins inside an obstacle
GRID = 65  # points a side of the outline, or along an edge, that a distance is looked for at


class Near(NamedTuple):
    """Points beside an obstacle: y (…, 3) [m], the distance ρ (…) [m] of one that touches it from its place,
    infinite of a plane, the depth (…) [m], how much less φ is than where they touch it, < 0 of one that is
    clear, and what of it a penalty takes: δ (…) [m], with −∂δ/∂x = n (…, 3)."""

    obstacle: AnyObstacle
    across: np.ndarray
    touch: np.ndarray
    depth: np.ndarray
    sunk: np.ndarray
    slope: np.ndarray

    @property
    def normal(self) -> np.ndarray:
        """∇φ (…, 3)."""
        return np.asarray(self.slope / np.linalg.norm(self.slope, axis=-1, keepdims=True))

    def mean(self, start: Near) -> Near:
        """Return points whose n̄ = (y₀ + y₁)/2ρ has n̄·Δy = −Δδ exactly since a start, and ∂n̄/∂y₁ = P/2ρ."""
        return self._replace(slope=0.5 * (start.slope + self.slope), touch=2.0 * self.touch)

    def resistance(self, load: np.ndarray, speed: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return forces (…, 3) [N] of dashpot and friction on points that a load p (…) [N] presses and that
        move at a speed v (…, 3) [m/s] past the obstacle, and their derivatives (…, 3, 3) by it: −p τ v_n, but
        nothing pulls, and −μ p v_t/√(v_t² + v₀²)."""
        tau, n = self.obstacle.contact_damping, self.normal
        load, leaving = load[..., None], (speed * n).sum(axis=-1, keepdims=True)
        sliding = speed - leaving * n
        slip = np.sqrt((sliding**2).sum(axis=-1, keepdims=True) + SLIP_SPEED**2)
        pull, rubbed = load * np.minimum(tau * leaving, 1.0) * n, self.obstacle.friction * load / slip
        normal = (tau * load * (tau * leaving < 1.0))[..., None] * dyad(n)
        tangential = rubbed[..., None] * (np.eye(3) - dyad(n) - dyad(sliding / slip))
        return -pull - rubbed * sliding, -normal - tangential

    def share_of_way(self, start: Near) -> float:
        """Return up to which share straight ways of points from a start lead none of them deeper than half
        the radius, nor through: 1 for all of them."""
        if isinstance(self.obstacle, Plane):
            return 1.0
        x, v = start.across, self.across - start.across
        core = self.touch - 0.5 * self.obstacle.radius
        a, b, c = (v * v).sum(axis=-1), (x * v).sum(axis=-1), (x * x).sum(axis=-1) - core**2
        hit = (b * b > a * c) & (b < 0.0) & (c > 0.0)
        first = (-b[hit] - np.sqrt((b * b - a * c)[hit])) / a[hit]
        return float(0.99 * first.min(initial=1.0 / 0.99))


def dyad(n: np.ndarray) -> np.ndarray:
    """Return n nᵀ (…, 3, 3) of vectors (…, 3)."""
    return np.asarray(n[..., :, None] * n[..., None, :])


def projector(obstacle: AnyObstacle) -> np.ndarray:
    """Return P (3, 3) across a cylinder's axis or on a plane, the identity of a sphere."""
    return np.eye(3) - dyad(obstacle.direction)


def near(obstacle: AnyObstacle, x: np.ndarray, offset: np.ndarray, at: tuple[float, float | None]) -> Near:
    """Return the position relative to an obstacle, in its `place`, of points x (…, 3) [m] that touch at a
    distance, the offset (…) [m]."""
    y = x - obstacle.place(*at)
    if isinstance(obstacle, Plane):
        normal, depth = np.broadcast_to(obstacle.direction, y.shape), offset - y @ obstacle.direction
        return Near(obstacle, y, depth + np.inf, depth, depth, normal)
    y = y @ projector(obstacle)
    touch, squared = offset + obstacle.radius, (y * y).sum(axis=-1)
    sunk = 0.5 * (touch - squared / touch)
    return Near(obstacle, y, touch + 0.0 * squared, touch - np.sqrt(squared), sunk, y / touch[..., None])


def farther(scene: SceneFields, obstacle: AnyObstacle, factor: float) -> AnyObstacle:
    """Return an obstacle at so many times its distance from the flat sheet; one that it touches stays."""
    gap, away = nearest(scene, obstacle)
    return obstacle.replace(position=tuple((obstacle.position + (factor - 1.0) * gap * away).tolist()))


def nearest(scene: SceneFields, obstacle: AnyObstacle) -> tuple[float, np.ndarray]:
    """Return the smallest gap [m] between the flat sheet's face and an obstacle where a motion begins, < 0
    where the sheet begins inside it, and the way from the sheet to it (3,): exact of a plane and where the
    obstacle is over the sheet or the sheet a rectangle, else at points of the outline."""
    import shapely
    from scipy.optimize import lsq_linear

    sides, across = scene.sheet.lengths, projector(obstacle)
    at = across @ obstacle.place(time=0.0)
    foot = lsq_linear(across[:, :2], at, ([0.0, 0.0], sides)).x  # |y|² is convex in the plan
    plan = shapely.get_coordinates(shapely.segmentize(scene.region, max(sides) / GRID))
    return _gap(scene, obstacle, [*plan, foot] if shapely.intersects_xy(scene.region, *foot) else plan, 0.0)


def _gap(scene: SceneFields, one: AnyObstacle, plan: Any, time: float | None) -> tuple[float, np.ndarray]:
    found = near(one, np.pad(plan, ((0, 0), (0, 1))), np.array(0.5 * scene.sheet.thickness), (1.0, time))
    deepest = found.depth.argmax()
    return -float(found.depth[deepest]), -found.normal[deepest]


def conflicts(scene: SceneFields) -> Iterator[object]:
    """Yield why an obstacle cannot be where it is, "" or False where it can."""
    held = (one for one in scene.supports if isinstance(one, Clamped | Hinged))
    edges = [one.edge for one in held if one.where is one.motion is None]
    for name, obstacle in scene.named_obstacles().items():
        gaps = {"position: the flat sheet begins": nearest(scene, obstacle)[0]}
        for edge in edges:
            where = f"motion: in its last place edge {edge}, which is held, is"
            gaps[where] = _gap(scene, obstacle, np.linspace(*scene.sheet.edge_ends(edge), GRID), None)[0]
        for where, gap in gaps.items():
            inside = f"{name}.{where} {-1e3 * gap:.4g} mm inside it, with half its thickness; move it away"
            yield gap < -INSIDE * scene.sheet.thickness and inside


def require_no_obstacles(scene: SceneFields, who: str) -> None:
    """Raise SceneError where there are obstacles."""
    if scene.obstacles:
        raise SceneError(f"scene '{scene.name}': obstacle: {who} has no contact; leave [[obstacle]] out")


def require_frictionless(scene: SceneFields) -> None:
    """Raise SceneError where an obstacle has friction, for a sheet at rest."""
    why = "at rest the answer depends on the path; let it settle in motion (--duration), or take friction = 0"
    for name, one in scene.named_obstacles().items():
        if one.friction > 0.0:
            raise SceneError(f"scene '{scene.name}': {name}.friction = {one.friction:g}: {why}")
