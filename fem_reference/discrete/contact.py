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
        self.name, self.obstacle, self.on = name, obstacle, plan.elements
        constants, shape = constants_of(scene, plan.corners), areas(plan.corners)
        self.area = shape @ AT_GAUSS[0]
        self.thickness = (shape * constants.thickness) @ AT_GAUSS[0] / self.area
        self.full = (shape * constants.stretching / constants.thickness**2) @ AT_GAUSS[0] / self.area
        self.levers = np.multiply.outer((-0.5, 0.5) if solid else (0.0,), self.thickness)
        self.offset = (TOUCH + (0.0 if solid else 0.5)) * self.thickness
        self.share, self.rounded = (SOFTER, ROUNDED) if moving else (1.0, 1e-100)

    def _points(self, vectors: np.ndarray) -> np.ndarray:
        """Return x (faces, m, 9, 3) [m] of vectors (m, 18, 3)."""
        return np.asarray(vectors[:, :9] + self.levers[..., None] * vectors[:, 9:])

    def near(self, shape: SheetShape) -> Near:
        """Return where points (faces, m, 9) are."""
        return near(self.obstacle, self._points(shape.vectors), self.offset, shape.sheet.instant(shape.at))

    def _pressed(self, shape: SheetShape) -> tuple[Near, Pressed]:
        """Return where points are, and how they are pressed."""
        found, over = self.near(shape), self.rounded * self.thickness
        deep, scale = np.maximum(found.depth, 0.0), self.share * self.full * self.area
        curved, sure = np.minimum(deep, over), np.maximum(deep - over, 0.0)
        energy, load = curved**3 / (6.0 * over) + 0.5 * sure * (sure + over), curved**2 / (2.0 * over) + sure
        return found, (scale * energy, scale * load, scale * curved / over)

    def _pulled(self, shape: SheetShape) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return forces at points (faces, m, 9, 3) [N], those of dashpot and friction among them, and the
        derivatives of these by the points' velocities (faces, m, 9, 3, 3)."""
        found, (_, load, _) = self._pressed(shape)
        velocity = self.obstacle.velocity(shape.sheet.instant(shape.at)[1])
        rubbed, by_rate = found.resistance(load, self._points(shape.rates) - velocity)
        return load[..., None] * found.normal + rubbed, rubbed, by_rate

    def force(self, shape: SheetShape) -> np.ndarray:
        return self._onto(shape, self._pulled(shape)[0])

    def _onto(self, shape: SheetShape, pull: np.ndarray) -> np.ndarray:
        """Return forces on the coordinates (N,) of those at points (faces, m, 9, 3)."""
        both = pull.sum(axis=0), (self.levers[..., None] * pull).sum(axis=0)
        return shape.sheet.of_surface(np.arange(len(self.on)), np.concatenate(both, axis=1))

    def tangent(self, shape: SheetShape) -> Tangent | None:
        found, (_, load, slope) = self._pressed(shape)
        geometric = load[..., None, None] * found.curvature
        return self._between(geometric - slope[..., None, None] * dyad(found.normal))

    def _between(self, blocks: np.ndarray) -> Tangent | None:
        """Return derivatives (faces, m, 9, 3, 3) of points' forces by their places as elements have them."""
        on, at = np.flatnonzero(blocks.any(axis=(0, 2, 3, 4))), np.arange(9)
        by = np.stack([np.ones_like(self.levers), self.levers])[:, :, on]  # of φ, and of d
        out = np.zeros((len(on), 2, 9, 3, 2, 9, 3))
        out[:, :, at, :, :, at] = np.einsum("rfen,cfen,fenij->nericj", by, by, blocks[:, on])
        return (on, out.reshape(-1, 18, 3, 18, 3)) if len(on) else None

    def damping(self, shape: SheetShape) -> Tangent | None:
        return self._between(self._pulled(shape)[2])

    def potential(self, shape: SheetShape) -> float:
        return float(self._pressed(shape)[1][0].sum())

    stored = potential

    def exchanged(self, shape: SheetShape) -> tuple[float, float]:
        velocity, (pull, rubbed, _) = self.obstacle.velocity(shape.at), self._pulled(shape)
        taken = rubbed.sum(axis=(0, 1, 2)) @ velocity - self._onto(shape, rubbed) @ shape.v
        return float(taken), float(pull.sum(axis=(0, 1, 2)) @ velocity)

    def holds(self, shape: SheetShape) -> dict[str, tuple[np.ndarray, np.ndarray]]:
        return {self.name: (self._points(shape.vectors), self._pulled(shape)[0])}

    def report(self, shape: SheetShape) -> tuple[ContactState, np.ndarray]:
        """Return what there is to say of it, and the pressure (n,) [Pa] at the nodes of the plan."""
        found, (_, load, _) = self._pressed(shape)
        area = np.bincount(self.on.ravel(), self.area.ravel())
        deepest = np.full(len(area), -np.inf)
        np.maximum.at(deepest, self.on, (found.depth / self.thickness).max(axis=0))
        pressure = np.bincount(self.on.ravel(), load.sum(axis=0).ravel()) / area
        return ContactState.of(deepest, area), pressure
