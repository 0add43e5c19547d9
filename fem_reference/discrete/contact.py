"""Contact of a reference with a rigid obstacle: penalty pressures at nodes, on the mid-surface of a shell
with an offset of half the thickness, on the faces of a solid.

A point x = φ + ζ d of the sheet, ζ = 0 or ±h/2, is at the distance r from an obstacle's middle, its normal
line or its axis: with w = P (x − c), P the projector on what the distance is measured in,

    plane   depth = o − n·w                  sphere, cylinder   depth = R + o − |w|,   n = w/|w|

with o = h/2 of a mid-surface, 0 of faces. The work of the pressure p = k ⟨depth⟩ in sinking is its energy,
½ k ⟨depth⟩² per area, and its force −∂/∂x gives

    f = A p n on φ,  ζ f on d;      −∂f/∂x = A (k n nᵀ − (p/|w|) (P − n nᵀ)).

A node's area is ∫ N dA, all positive on nine nodes, where it is Simpson's rule; those at Gauss points are
nine constraints on four nodes an element, whose pressures scatter. k = E/h; see
`sheetbench.scenes.objects.obstacles` for what the words mean.
"""

from __future__ import annotations

import numpy as np

from fem_reference.discrete.items import SheetItem, Tangent
from fem_reference.discrete.shape import SheetShape
from fem_reference.surface.biquadratic import AT_GAUSS, areas
from fem_reference.surface.materials import constants_of
from fem_reference.surface.mesh import Plan
from sheetbench.answers.contact import ContactState
from sheetbench.scenes import Plane, Scene
from sheetbench.scenes.objects.obstacles import SLIP_SPEED, AnyObstacle

TOUCH = 1e-9  # of the thickness, that a sheet which lies on a plane is held by it
UNDECIDED = 1e-6
CORE = 0.5  # of the radius: where no step may lead
SOFTER, ROUNDED = 0.01, 0.3  # in motion: of k, and over which part of the thickness the law is rounded


class Touching(SheetItem):
    """Contact with one obstacle. share: of its stiffness, as `soften` has it; faces: ζ of the points of a
    node [m]."""

    def __init__(self, scene: Scene, plan: Plan, name: str, obstacle: AnyObstacle, moving: bool, solid: bool):
        self.name, self.obstacle, self.moving = name, obstacle, moving
        self.plane = isinstance(obstacle, Plane)
        self.moved = float(np.linalg.norm(obstacle.displacement(1.0)))
        self.radius = np.inf if isinstance(obstacle, Plane) else obstacle.radius
        along = obstacle.direction
        self._normal, self._across = along, np.eye(3) - (0.0 if self.plane else np.outer(along, along))
        on, count, corners = plan.elements, len(plan.nodes), plan.corners
        constants = constants_of(scene, corners)
        shape = areas(corners)
        area = np.bincount(on.ravel(), (shape @ AT_GAUSS[0]).ravel(), count)
        thickness, stiffness = (
            np.bincount(on.ravel(), ((shape * part) @ AT_GAUSS[0]).ravel(), count) / area
            for part in (constants.thickness, constants.stretching / constants.thickness**2)
        )
        self.elements, self.place = np.empty((2, count), int)  # of the elements of a node, the last has it
        for i in range(9):
            self.elements[on[:, i]], self.place[on[:, i]] = np.arange(len(on)), i
        sides = (-0.5, 0.5) if solid else (0.0,)
        self.levers = np.stack([side * thickness for side in sides])  # (faces, n)
        self.offset = np.zeros(count) if solid else 0.5 * thickness
        self.area, self.thickness, self.full = area, thickness, stiffness
        self.share = SOFTER if moving else 1.0
        self._rounded = ROUNDED * thickness if moving else np.zeros(count)
        self.resists = moving and bool(obstacle.friction or obstacle.contact_damping)

    def _way(self, at: float) -> np.ndarray:
        """How far the obstacle is (3,) [m] at a load factor or time."""
        return self.obstacle.displacement(1.0, at) if self.moving else self.obstacle.displacement(at)

    def points(self, vectors: np.ndarray) -> np.ndarray:
        """Return x (faces, n, 3) [m] of vectors (m, 18, 3)."""
        middle, director = vectors[self.elements, self.place], vectors[self.elements, 9 + self.place]
        return np.stack([middle + lever[:, None] * director for lever in self.levers])

    def _relative(self, shape: SheetShape) -> np.ndarray:
        """Return w (faces, n, 3) [m]."""
        return self._across_from(shape.vectors, shape.at)

    def _across_from(self, vectors: np.ndarray, at: float) -> np.ndarray:
        origin = self.obstacle.position + self._way(at)
        w: np.ndarray = (self.points(vectors) - origin) @ self._across
        return w

    def _sunk(self, shape: SheetShape) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return depth (faces, n) [m], < 0 where a point is clear, n (faces, n, 3) and 1/|w|."""
        w = self._relative(shape)
        offset = self.offset + TOUCH * self.thickness
        if self.plane:
            return offset - w @ self._normal, np.broadcast_to(self._normal, w.shape), np.zeros(w.shape[:2])
        reach = np.linalg.norm(w, axis=2)
        return self.radius + offset - reach, w / reach[..., None], 1.0 / reach

    def _pressures(self, depth: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return A ψ [J], A p [N] and A dp/d(depth) [N/m] (faces, n) of a law rounded over `_rounded`."""
        deep, over = np.maximum(depth, 0.0), self._rounded
        scale = self.share * self.full * self.area
        if not self.moving:
            return 0.5 * scale * deep**2, scale * deep, scale * (depth > 0.0)
        curved, sure = np.minimum(deep, over), np.maximum(deep - over, 0.0)
        force = curved**2 / (2.0 * over) + sure
        energy = curved**3 / (6.0 * over) + 0.5 * sure * (sure + over)
        return scale * energy, scale * force, scale * curved / over

    def _pulled(self, shape: SheetShape) -> np.ndarray:
        """Return forces at points (faces, n, 3) [N]."""
        depth, normal, _ = self._sunk(shape)
        return self._pressures(depth)[1][..., None] * normal + self._rubbed(shape, depth, normal)

    def force(self, shape: SheetShape) -> np.ndarray:
        return self._onto(shape, self._pulled(shape))

    def mean_force(self, start: SheetShape, end: SheetShape, middle: SheetShape) -> np.ndarray:
        """Return the force whose work in a step is the energy stored: of the mean pressure Δψ/Δdepth along
        (w₀ + w₁)/(|w₀| + |w₁|), whose product with Δw is −Δdepth exactly."""
        (before, normal, _), (after, *_) = (self._sunk(shape) for shape in (start, end))
        sunk = after - before
        far = np.abs(sunk) > 1e-7 * self.thickness
        stored = self._pressures(after)[0] - self._pressures(before)[0]
        load = np.where(far, stored / np.where(far, sunk, 1.0), self._pressures(0.5 * (before + after))[1])
        if not self.plane:
            w = [self._relative(shape) for shape in (start, end)]
            normal = (w[0] + w[1]) / sum(np.linalg.norm(each, axis=2) for each in w)[..., None]
        depth, across, _ = self._sunk(middle)
        return self._onto(middle, load[..., None] * normal + self._rubbed(middle, depth, across))

    def _onto(self, shape: SheetShape, pull: np.ndarray) -> np.ndarray:
        """Return forces on the coordinates (N,) of those at points (faces, n, 3)."""
        out = np.zeros_like(shape.vectors)
        out[self.elements, self.place] = pull.sum(axis=0)
        out[self.elements, 9 + self.place] = (self.levers[..., None] * pull).sum(axis=0)
        return shape.sheet.of_surface(np.arange(len(out)), out)

    def tangent(self, shape: SheetShape) -> Tangent | None:
        depth, normal, bend = self._sunk(shape)
        _, load, slope = self._pressures(depth)
        outer = normal[..., :, None] * normal[..., None, :]
        blocks = -slope[..., None, None] * outer
        if not self.plane:
            blocks = blocks + (load * bend)[..., None, None] * (self._across - outer)
        return self._between(blocks, depth)

    def _between(self, blocks: np.ndarray, depth: np.ndarray) -> Tangent | None:
        """Return derivatives (faces, n, 3, 3) of points' forces by their places as the elements have them."""
        touching = np.flatnonzero((depth > 0.0).any(axis=0))
        if not len(touching):
            return None
        on, rows = np.unique(self.elements[touching], return_inverse=True)
        out = np.zeros((len(on), 18, 3, 18, 3))
        at = self.place[touching]
        for lever, block in zip(self.levers[:, touching], blocks[:, touching], strict=True):
            for row, by_row in ((0, np.ones_like(lever)), (9, lever)):
                for column, by_column in ((0, np.ones_like(lever)), (9, lever)):
                    both = (by_row * by_column)[:, None, None] * block
                    out[rows, row + at, :, column + at, :] += both  # no two of a place are the same
        return on, out

    def _speeds(self, shape: SheetShape, normal: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return how fast points sink (faces, n) and slide (faces, n, 3) [m/s]."""
        speed = self.points(shape.rates)
        if self.obstacle.motion is not None:
            speed = speed - self.obstacle.motion.course.slope(shape.at)
        sinking = -(speed * normal).sum(axis=2)
        return sinking, speed + sinking[..., None] * normal

    def _rubbed(self, shape: SheetShape, depth: np.ndarray, normal: np.ndarray) -> np.ndarray:
        """Return the forces (faces, n, 3) of the dashpot and of friction, in motion."""
        obstacle = self.obstacle
        if not self.resists:
            return np.zeros_like(normal)
        load = self._pressures(depth)[1]
        sinking, sliding = self._speeds(shape, normal)
        pressed = load * np.maximum(obstacle.contact_damping * sinking, -1.0)
        slip = np.sqrt((sliding**2).sum(axis=2) + SLIP_SPEED**2)
        rubbed = (obstacle.friction * load / slip)[..., None] * sliding
        return np.asarray(pressed[..., None] * normal - rubbed)

    def damping(self, shape: SheetShape) -> Tangent | None:
        obstacle = self.obstacle
        if not self.resists:
            return None
        depth, normal, _ = self._sunk(shape)
        load = self._pressures(depth)[1]
        sinking, sliding = self._speeds(shape, normal)
        outer = normal[..., :, None] * normal[..., None, :]
        slip = np.sqrt((sliding**2).sum(axis=2) + SLIP_SPEED**2)
        unit = sliding / slip[..., None]
        tau = obstacle.contact_damping * (obstacle.contact_damping * sinking > -1.0)
        along = np.eye(3) - outer - unit[..., :, None] * unit[..., None, :]
        rubbed = (obstacle.friction * load / slip)[..., None, None] * along
        return self._between(-(tau * load)[..., None, None] * outer - rubbed, depth)

    def potential(self, shape: SheetShape) -> float:
        return float(self._pressures(self._sunk(shape)[0])[0].sum())

    def stored(self, shape: SheetShape) -> float:
        return self.potential(shape)

    def exchanged(self, shape: SheetShape, step: np.ndarray) -> tuple[float, float]:
        depth, normal, _ = self._sunk(shape)
        taken = -self._onto(shape, self._rubbed(shape, depth, normal)) @ step
        work = 0.0
        if self.obstacle.motion is not None and shape.v is not None and step.any():
            h = float(np.linalg.norm(step) / np.linalg.norm(shape.v))
            velocity = self.obstacle.motion.course.slope(shape.at)
            work = h * float(self.exerted(shape) @ velocity)
            taken += h * float(self._rubbed(shape, depth, normal).sum(axis=(0, 1)) @ velocity)
        return float(taken), work

    def holds(self, shape: SheetShape) -> dict[str, tuple[np.ndarray, np.ndarray]]:
        return {self.name: (self.points(shape.vectors), self._pulled(shape))}

    def exerted(self, shape: SheetShape) -> np.ndarray:
        """Return its force (3,) [N] on the sheet."""
        total: np.ndarray = self._pulled(shape).sum(axis=(0, 1))
        return total

    def leads_through(self, before: np.ndarray, since: float, after: np.ndarray, at: float) -> bool:
        """Whether a straight way between vectors (m, 18, 3) at two load factors leads any point nearer to
        the obstacle's middle than half its radius."""
        if self.plane:
            return False
        x, end = (self._across_from(*each) for each in ((before, since), (after, at)))
        way = end - x
        nearest = np.clip(-(x * way).sum(axis=2) / np.maximum((way * way).sum(axis=2), 1e-300), 0.0, 1.0)
        return bool((np.linalg.norm(x + nearest[..., None] * way, axis=2) < CORE * self.radius).any())

    def report(self, shape: SheetShape) -> ContactState:
        """Return what there is to say of it."""
        depth = self._sunk(shape)[0].max(axis=0)
        over = depth / self.thickness - TOUCH
        near = min(UNDECIDED, 1e-3 * float(over.max(initial=0.0)))
        touching = depth > 0.0
        return ContactState(
            area=float(self.area[touching].sum()),
            penetration=float(over.max(initial=0.0)),
            points=int(touching.sum()),
            undecided=int((np.abs(over) <= near).sum()),
        )

    def pressure(self, shape: SheetShape) -> np.ndarray:
        """Return the pressure (n,) [Pa] at the nodes of the plan."""
        pressures: np.ndarray = self._pressures(self._sunk(shape)[0])[1].sum(axis=0) / self.area
        return pressures
