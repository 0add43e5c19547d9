"""Contact of a reference with a rigid obstacle: penalty pressures at nodes, on the mid-surface of a shell
with an offset of half the thickness, on the faces of a solid.

A point x = φ + ζ d of the sheet, ζ = 0 or ±h/2, at a distance r from the obstacle, whose gradient is n
(`sheetbench.scenes.meaning.distances`), is o + δ₀ − r deep, o = h/2 of a mid-surface, 0 of faces. The work of
the pressure p(depth) in sinking is its energy ψ per area, ½ k depth² at rest, and its force −∂/∂x gives

    f = A p n on φ,  ζ f on d;      −∂f/∂x = A (p' n nᵀ − p ∇n).

A node's area is ∫N dA, all positive on nine nodes, where it is Simpson's rule; those at Gauss points are
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
from sheetbench.scenes import Scene
from sheetbench.scenes.meaning.distances import Near, mean_normal, near, share_of_way
from sheetbench.scenes.objects.obstacles import SLIP_SPEED, TOUCH, AnyObstacle

SOFTER, ROUNDED = 0.01, 0.3  # in motion: of k, and over which part of the thickness the law is rounded


class Touching(SheetItem):
    """Contact with one obstacle. share: of its stiffness; levers: ζ (faces, n) of a node's points [m]."""

    def __init__(self, scene: Scene, plan: Plan, name: str, obstacle: AnyObstacle, moving: bool, solid: bool):
        self.name, self.obstacle, self.moving, self.radius = name, obstacle, moving, obstacle.radius
        self.moved = float(np.linalg.norm(obstacle.displacement(1.0)))
        on, count, corners = plan.elements, len(plan.nodes), plan.corners
        constants, shape = constants_of(scene, corners), areas(corners)

        def at_nodes(part: np.ndarray) -> np.ndarray:
            return np.bincount(on.ravel(), ((shape * part) @ AT_GAUSS[0]).ravel(), count)

        self.area = at_nodes(np.ones_like(shape))
        self.thickness = at_nodes(constants.thickness) / self.area
        self.full = at_nodes(constants.stretching / constants.thickness**2) / self.area
        self.elements, self.place = np.empty((2, count), int)  # of the elements of a node, the last has it
        for i in range(9):
            self.elements[on[:, i]], self.place[on[:, i]] = np.arange(len(on)), i
        self.levers = np.outer((-0.5, 0.5) if solid else (0.0,), self.thickness)
        self.offset = (0.0 if solid else 0.5) * self.thickness
        self.share = SOFTER if moving else 1.0
        self.resists = moving and bool(obstacle.friction or obstacle.contact_damping)

    def _points(self, vectors: np.ndarray) -> np.ndarray:
        """Return x (faces, n, 3) [m] of vectors (m, 18, 3)."""
        middle, director = vectors[self.elements, self.place], vectors[self.elements, 9 + self.place]
        x: np.ndarray = middle + self.levers[..., None] * director
        return x

    def _near(self, vectors: np.ndarray, at: float) -> Near:
        """Where points are beside the obstacle as it is at a load factor or time."""
        drive = (1.0, at) if self.moving else (at, None)
        return near(self.obstacle, self._points(vectors), *drive)

    def _depth(self, found: Near) -> np.ndarray:
        """Return depths (faces, n) [m], < 0 of a point that is clear."""
        depth: np.ndarray = self.offset + TOUCH * self.thickness - found.distance
        return depth

    def _sunk(self, shape: SheetShape) -> tuple[np.ndarray, Near, np.ndarray, np.ndarray, np.ndarray]:
        """Return depths (faces, n) [m], where points are, A ψ [J], A p [N] and A p' [N/m] (faces, n)."""
        found = self._near(shape.vectors, shape.at)
        depth = self._depth(found)
        return depth, found, *self._pressures(depth)

    def _pressures(self, depth: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        deep, scale = np.maximum(depth, 0.0), self.share * self.full * self.area
        over = (ROUNDED if self.moving else 1e-100) * self.thickness
        curved, sure = np.minimum(deep, over), np.maximum(deep - over, 0.0)
        force = curved**2 / (2.0 * over) + sure
        energy = curved**3 / (6.0 * over) + 0.5 * sure * (sure + over)
        return scale * energy, scale * force, scale * curved / over

    def _pulled(self, shape: SheetShape) -> np.ndarray:
        """Return forces at points (faces, n, 3) [N]."""
        _, found, _, load, _ = self._sunk(shape)
        return load[..., None] * found.normal + self._rubbed(shape)

    def force(self, shape: SheetShape) -> np.ndarray:
        return self._onto(shape, self._pulled(shape))

    def mean_force(self, start: SheetShape, end: SheetShape, middle: SheetShape) -> np.ndarray:
        """Return the force whose work in a step is the energy stored: of the mean pressure Δψ/Δdepth along
        the mean normal, whose product with Δx is −Δdepth exactly."""
        (before, near0, had, *_), (after, near1, has, *_) = self._sunk(start), self._sunk(end)
        far = np.abs(after - before) > 1e-7 * self.thickness
        secant = (has - had) / np.where(far, after - before, 1.0)
        load = np.where(far, secant, self._pressures(0.5 * (before + after))[1])
        pulled = load[..., None] * mean_normal(self.obstacle, near0, near1)
        return self._onto(middle, pulled + self._rubbed(middle))

    def _onto(self, shape: SheetShape, pull: np.ndarray) -> np.ndarray:
        """Return forces on the coordinates (N,) of those at points (faces, n, 3)."""
        out = np.zeros_like(shape.vectors)
        out[self.elements, self.place] = pull.sum(axis=0)
        out[self.elements, 9 + self.place] = (self.levers[..., None] * pull).sum(axis=0)
        return shape.sheet.of_surface(np.arange(len(out)), out)

    def tangent(self, shape: SheetShape) -> Tangent | None:
        _, found, _, load, slope = self._sunk(shape)
        blocks = load[..., None, None] * found.curvature - slope[..., None, None] * found.outer
        return self._between(blocks)

    def _between(self, blocks: np.ndarray) -> Tangent | None:
        """Return derivatives (faces, n, 3, 3) of points' forces by their places as the elements have them."""
        touching = np.flatnonzero(blocks.any(axis=(0, 2, 3)))
        if not len(touching):
            return None
        on, rows = np.unique(self.elements[touching], return_inverse=True)
        out, at = np.zeros((len(on), 18, 3, 18, 3)), self.place[touching]
        by = np.stack([np.ones_like(self.levers), self.levers])[..., touching]  # of φ, and of d
        of_nodes = np.einsum("rfn,cfn,fnij->rcnij", by, by, blocks[:, touching])
        for row in (0, 1):
            for column in (0, 1):  # no two of a place are the same
                out[rows, 9 * row + at, :, 9 * column + at, :] += of_nodes[row, column]
        return on, out

    def _speeds(self, shape: SheetShape) -> tuple[Near, np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """Return where points are, A p [N], how fast they sink (faces, n) and slide (faces, n, 3) [m/s], and
        the root (faces, n) of the law of friction."""
        _, found, _, load, _ = self._sunk(shape)
        speed = self._points(shape.rates) - self.obstacle.velocity(shape.at)
        sinking = -(speed * found.normal).sum(axis=2)
        sliding = speed + sinking[..., None] * found.normal
        return found, load, sinking, sliding, np.sqrt((sliding**2).sum(axis=2) + SLIP_SPEED**2)

    def _rubbed(self, shape: SheetShape) -> np.ndarray:
        """Return the forces (faces, n, 3) of the dashpot and of friction, in motion."""
        if not self.resists:
            return np.zeros((*self.levers.shape, 3))
        found, load, sinking, sliding, slip = self._speeds(shape)
        pressed = load * np.maximum(self.obstacle.contact_damping * sinking, -1.0)
        rubbed = self.obstacle.friction * load / slip
        return np.asarray(pressed[..., None] * found.normal - rubbed[..., None] * sliding)

    def damping(self, shape: SheetShape) -> Tangent | None:
        if not self.resists:
            return None
        found, load, sinking, sliding, slip = self._speeds(shape)
        unit, tau = sliding / slip[..., None], self.obstacle.contact_damping
        pressed = tau * load * (tau * sinking > -1.0)
        along = np.eye(3) - found.outer - unit[..., :, None] * unit[..., None, :]
        rubbed = (self.obstacle.friction * load / slip)[..., None, None] * along
        return self._between(-pressed[..., None, None] * found.outer - rubbed)

    def potential(self, shape: SheetShape) -> float:
        return float(self._sunk(shape)[2].sum())

    stored = potential

    def exchanged(self, shape: SheetShape, step: np.ndarray) -> tuple[float, float]:
        rubbed = self._rubbed(shape)
        taken, work = -self._onto(shape, rubbed) @ step, 0.0
        if self.obstacle.motion is not None and shape.v is not None and step.any():
            moved = float(np.linalg.norm(step) / np.linalg.norm(shape.v)) * self.obstacle.velocity(shape.at)
            work = float(self.exerted(shape) @ moved)
            taken += float(rubbed.sum(axis=(0, 1)) @ moved)
        return float(taken), work

    def holds(self, shape: SheetShape) -> dict[str, tuple[np.ndarray, np.ndarray]]:
        return {self.name: (self._points(shape.vectors), self._pulled(shape))}

    def exerted(self, shape: SheetShape) -> np.ndarray:
        """Return its force (3,) [N] on the sheet."""
        total: np.ndarray = self._pulled(shape).sum(axis=(0, 1))
        return total

    def leads_through(self, *ends: tuple[np.ndarray, float]) -> bool:
        """Whether a straight way between vectors (m, 18, 3) at two load factors leads through."""
        start, end = (self._near(*each) for each in ends)
        return share_of_way(self.obstacle, start, end, self.offset) < 1.0

    def report(self, shape: SheetShape) -> ContactState:
        """Return what there is to say of it."""
        return ContactState.of(self._sunk(shape)[0].max(axis=0) / self.thickness, self.area)

    def pressure(self, shape: SheetShape) -> np.ndarray:
        """Return the pressure (n,) [Pa] at the nodes of the plan."""
        pressures: np.ndarray = self._sunk(shape)[3].sum(axis=0) / self.area
        return pressures
