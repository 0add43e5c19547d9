"""Contact of a reference with a rigid obstacle: penalty pressures at nodes, on the mid-surface of a shell
with an offset of half the thickness, on the faces of a solid.

A point x = φ + ζ d of the sheet, ζ = 0 or ±h/2, at a distance r from the obstacle, whose gradient is n
(`sheetbench.scenes.meaning.distances`), is o + δ₀ − r deep, o = h/2 of a mid-surface, 0 of faces. The work of
the pressure p(depth) in sinking is its energy ψ per area, ½ k depth² at rest, k = E/h, and its force gives

    f = A p n on φ,  ζ f on d;      −∂f/∂x = A (p' n nᵀ − p ∇n).

A node's area is ∫N dA of each of its elements, all positive on nine nodes, where it is Simpson's rule; at
Gauss points nine constraints on four nodes an element would scatter the pressure.
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
from sheetbench.scenes.meaning.distances import Near, dyad, near
from sheetbench.scenes.objects.obstacles import TOUCH, AnyObstacle

SOFTER, ROUNDED = 0.01, 0.3  # in motion: of k, and over which part of the thickness the law is rounded
Pressed = tuple[np.ndarray, np.ndarray, np.ndarray]  # A ψ [J], A p [N] and A p' [N/m] (faces, m, 9)


class Touching(SheetItem):
    """Contact with one obstacle. share: of its stiffness; levers: ζ (faces, m, 9) [m] of elements' nodes."""

    def __init__(self, scene: Scene, plan: Plan, moving: bool, solid: bool, name: str, obstacle: AnyObstacle):
        self.name, self.obstacle, self.moving, self.on = name, obstacle, moving, plan.elements
        constants, shape = constants_of(scene, plan.corners), areas(plan.corners)
        self.area = shape @ AT_GAUSS[0]
        self.thickness = (shape * constants.thickness) @ AT_GAUSS[0] / self.area
        self.full = (shape * constants.stretching / constants.thickness**2) @ AT_GAUSS[0] / self.area
        self.levers = np.multiply.outer((-0.5, 0.5) if solid else (0.0,), self.thickness)
        self.offset = (0.0 if solid else 0.5) * self.thickness
        self.share = SOFTER if moving else 1.0
        self.resists = moving and bool(obstacle.friction or obstacle.contact_damping)

    def _points(self, vectors: np.ndarray) -> np.ndarray:
        """Return x (faces, m, 9, 3) [m] of vectors (m, 18, 3)."""
        return np.asarray(vectors[:, :9] + self.levers[..., None] * vectors[:, 9:])

    def _sunk(self, shape: SheetShape) -> tuple[Near, np.ndarray, Pressed]:
        """Return where points are, and how deep (faces, m, 9) [m], < 0 of one that is clear."""
        found = near(self.obstacle, self._points(shape.vectors), *shape.sheet.instant(shape.at))
        depth = self.offset + TOUCH * self.thickness - found.distance
        return found, depth, self._pressed(depth)

    def _pressed(self, depth: np.ndarray) -> Pressed:
        deep, scale = np.maximum(depth, 0.0), self.share * self.full * self.area
        over = (ROUNDED if self.moving else 1e-100) * self.thickness
        curved, sure = np.minimum(deep, over), np.maximum(deep - over, 0.0)
        energy, load = curved**3 / (6.0 * over) + 0.5 * sure * (sure + over), curved**2 / (2.0 * over) + sure
        return scale * energy, scale * load, scale * curved / over

    def _pulled(self, shape: SheetShape) -> np.ndarray:
        """Return forces at points (faces, m, 9, 3) [N]."""
        found, _, (_, load, _) = self._sunk(shape)
        pull = load[..., None] * found.normal
        return pull + self._resisted(shape)[0] if self.resists else pull

    def force(self, shape: SheetShape) -> np.ndarray:
        return self._onto(shape, self._pulled(shape))

    def _onto(self, shape: SheetShape, pull: np.ndarray) -> np.ndarray:
        """Return forces on the coordinates (N,) of those at points (faces, m, 9, 3)."""
        both = pull.sum(axis=0), (self.levers[..., None] * pull).sum(axis=0)
        return shape.sheet.of_surface(np.arange(len(self.on)), np.concatenate(both, axis=1))

    def tangent(self, shape: SheetShape) -> Tangent | None:
        found, _, (_, load, slope) = self._sunk(shape)
        geometric = load[..., None, None] * found.curvature
        return self._between(geometric - slope[..., None, None] * dyad(found.normal))

    def _between(self, blocks: np.ndarray) -> Tangent | None:
        """Return derivatives (faces, m, 9, 3, 3) of points' forces by their places as elements have them."""
        on, at = np.flatnonzero(blocks.any(axis=(0, 2, 3, 4))), np.arange(9)
        by = np.stack([np.ones_like(self.levers), self.levers])[:, :, on]  # of φ, and of d
        out = np.zeros((len(on), 2, 9, 3, 2, 9, 3))
        out[:, :, at, :, :, at] = np.einsum("rfen,cfen,fenij->nericj", by, by, blocks[:, on])
        return (on, out.reshape(-1, 18, 3, 18, 3)) if len(on) else None

    def _resisted(self, shape: SheetShape) -> tuple[np.ndarray, np.ndarray]:
        """Return forces (faces, m, 9, 3) [N] of dashpot and friction, and their derivatives by points'
        velocities (faces, m, 9, 3, 3)."""
        found, _, (_, load, _) = self._sunk(shape)
        return found.resistance(load, self._points(shape.rates) - self.obstacle.velocity(shape.at))

    def damping(self, shape: SheetShape) -> Tangent | None:
        return self._between(self._resisted(shape)[1])

    def potential(self, shape: SheetShape) -> float:
        return float(self._sunk(shape)[2][0].sum())

    stored = potential

    def exchanged(self, shape: SheetShape) -> tuple[float, float]:
        velocity, rubbed = self.obstacle.velocity(shape.at), self._resisted(shape)[0]
        taken = rubbed.sum(axis=(0, 1, 2)) @ velocity - self._onto(shape, rubbed) @ shape.v
        return float(taken), float(self._pulled(shape).sum(axis=(0, 1, 2)) @ velocity)

    def holds(self, shape: SheetShape) -> dict[str, tuple[np.ndarray, np.ndarray]]:
        return {self.name: (self._points(shape.vectors), self._pulled(shape))}

    def step_share(self, start: SheetShape, end: SheetShape) -> float:
        return self._sunk(end)[0].share_of_way(self._sunk(start)[0], self.offset)

    def report(self, shape: SheetShape) -> tuple[ContactState, np.ndarray]:
        """Return what there is to say of it, and the pressure (n,) [Pa] at the nodes of the plan."""
        _, depth, (_, load, _) = self._sunk(shape)
        area = np.bincount(self.on.ravel(), self.area.ravel())
        deepest = np.full(len(area), -np.inf)
        np.maximum.at(deepest, self.on, (depth / self.thickness).max(axis=0))
        pressure = np.bincount(self.on.ravel(), load.sum(axis=0).ravel()) / area
        return ContactState.of(deepest, area), pressure
