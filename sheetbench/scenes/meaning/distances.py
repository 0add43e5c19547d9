"""Distances of points from a scene's obstacles, with gradients, and the gaps between them and the flat sheet.

The distance φ is, with y the position of a point less the obstacle's, across its axis if it has one, and of a
box less the nearest point of its core, and P = ∂y/∂x,

    plane                    φ = y·n,      n = ∇φ,     ∇n = 0
    sphere, cylinder, box    φ = |y| − R,  n = y/|y|

|y| is ρ = R + o at a point that touches, φ = o. A penalty takes for the depth o − φ

    δ = (ρ² − |y|²)/2ρ,   ∂δ/∂x = −y/ρ,   ∂²δ/∂x² = −P/ρ;     on a plane  δ = o − φ,   ∂δ/∂x = −n

which differs from o − φ by (o − φ)²/2ρ, and is quadratic over a sheet that is flat between the sampled
points.
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
STEPS, ROUNDING = 60, 1e-14  # of Newton's method along a way; of |y|²
GRID = 65  # points a side of the outline, or along an edge, that a distance is looked for at


class ContactPoints(NamedTuple):
    """Positions and depths of points relative to an obstacle. across: position (…, 3) [m] from the obstacle's
    middle, across its axis if it has one; touch: ρ (…) [m], infinite for a plane; depth: o − φ (…) [m],
    negative without contact; penetration: δ (…) [m], as in the penalty; slope: n = −∂δ/∂x (…, 3), with ∂n/∂x
    = `projector` · diag(curvature (…, 1 or 3))."""

    obstacle: AnyObstacle
    across: np.ndarray
    touch: np.ndarray
    depth: np.ndarray
    penetration: np.ndarray
    slope: np.ndarray
    curvature: np.ndarray

    @property
    def normal(self) -> np.ndarray:
        """∇φ (…, 3)."""
        return np.asarray(self.slope / (np.linalg.norm(self.slope, axis=-1, keepdims=True) + 1e-300))

    def mean(self, start: ContactPoints) -> ContactPoints:
        """Return the points with the mean slope n̄ = (y₀ + y₁)/2ρ of the step from `start`, for which n̄·Δx =
        −Δδ exactly and ∂n̄/∂x₁ = P/2ρ; components of n̄ are reduced where the nearest point of a core moves
        with x."""
        core = self.obstacle.core
        moved = np.clip(self.across, -core, core) - np.clip(start.across, -core, core)
        share = np.divide(moved, self.across - start.across, out=np.zeros_like(moved), where=moved != 0.0)
        slope = 0.5 * (start.slope + self.slope) * (1.0 - share)
        return self._replace(slope=slope, curvature=0.5 * self.curvature)

    def resistance(self, load: np.ndarray, speed: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return the dashpot and friction forces (…, 3) [N] on points, and their derivatives (…, 3, 3) by v.
        The forces are −p τ v_n, limited so that the normal force is never tensile, and −μ p v_t/√(v_t² +
        v₀²), for normal loads p (…) [N] and velocities v (…, 3) [m/s] relative to the obstacle."""
        tau, n = self.obstacle.contact_damping, self.normal
        load, leaving = load[..., None], (speed * n).sum(axis=-1, keepdims=True)
        sliding = speed - leaving * n
        slip = np.sqrt((sliding**2).sum(axis=-1, keepdims=True) + SLIP_SPEED**2)
        pull, rubbed = load * np.minimum(tau * leaving, 1.0) * n, self.obstacle.friction * load / slip
        normal = (tau * load * (tau * leaving < 1.0))[..., None] * dyad(n)
        tangential = rubbed[..., None] * (np.eye(3) - dyad(n) - dyad(sliding / slip))
        return -pull - rubbed * sliding, -normal - tangential

    def free_share(self, start: ContactPoints) -> float:
        """Return the largest share of the points' straight paths from `start` on which no point is deeper
        than half the radius; 1 if none is anywhere."""
        if isinstance(self.obstacle, Plane):
            return 1.0
        way, core = self.across - start.across, self.obstacle.core
        deep, end = 0.5 * self.obstacle.radius, 1.0 / 0.99
        share = np.where(start.depth < deep, 0.0, end)
        # Newton's method from outside ends before the first root of the convex |y|² − c²
        for _ in range(STEPS):
            y = start.across + share[..., None] * way
            y = y - np.clip(y, -core, core)
            over, fall = (y * y).sum(axis=-1) - (self.touch - deep) ** 2, -2.0 * (y * way).sum(axis=-1)
            going = (over > ROUNDING * self.touch**2) & (share < end)
            if not going.any():
                break
            further = np.divide(over, fall, out=np.full_like(over, end), where=fall > 0.0)
            share += np.where(going, further, 0.0)
        return float(0.99 * share.min(initial=end))


def dyad(n: np.ndarray) -> np.ndarray:
    """Return n nᵀ (…, 3, 3) of vectors (…, 3)."""
    return np.asarray(n[..., :, None] * n[..., None, :])


def projector(obstacle: AnyObstacle) -> np.ndarray:
    """Return the projector (3, 3) across a cylinder's axis or on a plane, the identity of others."""
    return np.eye(3) - dyad(obstacle.direction)


def near(
    obstacle: AnyObstacle, x: np.ndarray, offset: np.ndarray, at: tuple[float, float | None]
) -> ContactPoints:
    """Return the positions and depths of points x (…, 3) [m] relative to an obstacle. offset: distance (…)
    [m] from the obstacle at which a point touches it; at: load factor and time of the obstacle's `place`."""
    y = x - obstacle.place(*at)
    if isinstance(obstacle, Plane):
        normal, depth = np.broadcast_to(obstacle.direction, y.shape), offset - y @ obstacle.direction
        return ContactPoints(obstacle, y, depth + np.inf, depth, depth, normal, 0.0 * y[..., :1])
    across, core = y @ projector(obstacle), obstacle.core
    y = across - np.clip(across, -core, core)
    squared = (y * y).sum(axis=-1)
    touch = offset + obstacle.radius + 0.0 * squared
    depth, sunk, curvature = touch - np.sqrt(squared), 0.5 * (touch - squared / touch), 1.0 / touch[..., None]
    slope = y * curvature
    if core.any():
        depth, curvature = depth + (core - abs(across)).min(axis=-1).clip(0.0), curvature * (y != 0.0)
    return ContactPoints(obstacle, across, touch, depth, sunk, slope, curvature)


def scale_distance(scene: SceneFields, obstacle: AnyObstacle, factor: float) -> AnyObstacle:
    """Return the obstacle with its distance from the flat sheet times a factor; an obstacle that touches the
    sheet stays."""
    gap, away = nearest(scene, obstacle)
    return obstacle.replace(position=tuple((obstacle.position + (factor - 1.0) * gap * away).tolist()))


def nearest(scene: SceneFields, obstacle: AnyObstacle) -> tuple[float, np.ndarray]:
    """Return the smallest gap [m] between the flat sheet's face and an obstacle at the start of a motion,
    negative if they overlap, and the unit vector (3,) from the sheet to the obstacle. Both are exact for a
    plane, for an obstacle above the sheet and for a rectangular sheet, and otherwise found at points of the
    outline."""
    import shapely
    from scipy.optimize import lsq_linear

    sides, across, wide = scene.sheet.lengths, projector(obstacle), obstacle.core > 0.0
    core, at = obstacle.core[wide], across @ obstacle.place(time=0.0)
    ways, bounds = np.hstack([across[:, :2], -np.eye(3)[:, wide]]), ([0.0, 0.0, *-core], [*sides, *core])
    foot = lsq_linear(ways, at, bounds).x[:2]  # |y|² is convex in the plan and in the core
    plan = shapely.get_coordinates(shapely.segmentize(scene.region, max(sides) / GRID))
    return _gap(scene, obstacle, [*plan, foot] if shapely.intersects_xy(scene.region, *foot) else plan, 0.0)


def _gap(scene: SceneFields, one: AnyObstacle, plan: Any, time: float | None) -> tuple[float, np.ndarray]:
    found = near(one, np.pad(plan, ((0, 0), (0, 1))), np.array(0.5 * scene.sheet.thickness), (1.0, time))
    deepest = found.depth.argmax()
    return -float(found.depth[deepest]), -found.normal[deepest]


def conflicts(scene: SceneFields) -> Iterator[object]:
    """Yield a sentence on each obstacle that overlaps the flat sheet or a held edge, or a false value."""
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


def require_no_obstacles(scene: SceneFields, who: str, kinds: Any = object) -> None:
    """Raise SceneError if a scene has obstacles of the given kinds."""
    for name, one in scene.named_obstacles().items():
        if isinstance(one, kinds):
            why = f"{name}: {who} has no contact with a {one.kind}; leave [[obstacle]] out"
            raise SceneError(f"scene '{scene.name}': {why}")


def require_frictionless(scene: SceneFields) -> None:
    """Raise SceneError if an obstacle has friction, since the answer at rest then depends on the path."""
    why = "at rest the answer depends on the path; let it settle in motion (--duration), or take friction = 0"
    for name, one in scene.named_obstacles().items():
        if one.friction > 0.0:
            raise SceneError(f"scene '{scene.name}': {name}.friction = {one.friction:g}: {why}")
