"""Contact of a reference with a rigid obstacle: penalty pressures on the mid-surface of a shell with an
offset of half the thickness, on the faces of a solid.

A place x = φ + ζ d of the sheet, ζ = 0 or ±h/2, is δ deep in an obstacle
(`sheetbench.scenes.meaning.distances`), o = h/2 + δ₀ of a mid-surface, δ₀ of faces. The work of the pressure
p(δ) in sinking is its energy ψ per area, ½ k δ² at rest, and its force gives

    f = ∫ p n N dA on φ,  ζ f on d;      −∂f/∂x = ∫ (p' n nᵀ − p ∂n/∂x) N N dA.

On a plane under a sheet that is flat when nothing acts on it nodes have areas ∫N dA, all positive on nine
nodes, where they are Simpson's rule, and k = E/h. Else the place that touches may be anywhere in an element,
and small: δ is biquadratic between 3 × 3 points of each of its parts, no longer than R/2, and integrals are
those over {δ > 0} (`patch`), with k STIFFER times as much. In motion k is SOFTER, and ψ = k (⟨δ⟩³ − ⟨δ −
δ₁⟩³)/6δ₁, δ₁ = 0.3 h.
"""

from __future__ import annotations

from copy import copy

import numpy as np
from skfem import ElementQuad2

from fem_reference.discrete import patch
from fem_reference.discrete.items import SheetItem, Tangent
from fem_reference.discrete.shape import SheetShape
from fem_reference.surface.biquadratic import AT_GAUSS, areas, jacobians
from fem_reference.surface.biquadratic import shape as biquadratic
from fem_reference.surface.materials import constants_of
from fem_reference.surface.mesh import Plan
from sheetbench.answers.contact import ContactState
from sheetbench.scenes import Scene
from sheetbench.scenes.meaning.distances import Near, near, projector
from sheetbench.scenes.objects.obstacles import TOUCH, AnyObstacle, Plane

SOFTER, ROUNDED, STIFFER = 0.01, 0.3, 100.0  # in motion: of E/h, over which part of h rounded; of patches
SPREAD = np.kron(*2 * [np.array([[1.0, 0.0, 0.0], [0.5, 0.0, 0.5], [0.0, 0.0, 1.0]])])  # to a part's corners
Pressed = tuple[np.ndarray, np.ndarray, np.ndarray]  # energy, loads and slopes of groups (faces, m, t, …)


def hats(r: np.ndarray, s: np.ndarray, nodes: np.ndarray) -> np.ndarray:
    """Return shares (p, 9), none negative, of an element's nodes (9, 2) in places at r, s (p,) of [−1, 1]."""
    along, across = (
        np.maximum(1.0 - np.abs(x[:, None] - y), 0.0) for x, y in zip((r, s), nodes.T, strict=True)
    )
    return np.asarray(along * across)


class Touching(SheetItem):
    """Contact with one obstacle. share: of its stiffness; basis (p, 9): of nodes in an element's points;
    groups (t, n) of points: nodes one by one, or nine of each part; levers: ζ (faces, m, 9) [m] of elements'
    nodes."""

    def __init__(self, scene: Scene, plan: Plan, moving: bool, solid: bool, name: str, obstacle: AnyObstacle):
        self.name, self.obstacle, self.on = name, obstacle, plan.elements
        constants, weight = constants_of(scene, plan.corners), areas(plan.corners)
        of_nodes = weight @ AT_GAUSS[0]
        thickness = (weight * constants.thickness) @ AT_GAUSS[0] / of_nodes
        full = (weight * constants.stretching / constants.thickness**2) @ AT_GAUSS[0] / of_nodes
        self.levers = np.multiply.outer((-0.5, 0.5) if solid else (0.0,), thickness)
        curled = not moving and bool(scene.natural_by or scene.actuators)
        self.at_nodes, nodes = isinstance(obstacle, Plane) and not curled, 2.0 * ElementQuad2().doflocs - 1.0
        if self.at_nodes:
            self.basis = self.hats = np.eye(9)
            self.groups, self.area = np.arange(9)[:, None], of_nodes
        else:
            longest = np.ptp(plan.corners, axis=1).max()
            parts = max(2, int(np.ceil(2.0 * longest / obstacle.radius)))
            line = np.linspace(-1.0, 1.0, 2 * parts + 1)
            r, s = (each.ravel() for each in np.meshgrid(line, line, indexing="ij"))
            number = np.arange(len(r)).reshape(len(line), -1)
            self.groups = np.lib.stride_tricks.sliding_window_view(number, (3, 3))[::2, ::2].reshape(-1, 9)
            (self.basis, slope), self.hats = biquadratic(r, s), hats(r, s, nodes)
            self.area = (
                np.abs(np.linalg.det(jacobians(plan.corners, slope))) / parts**2
            )  # dA per part's dr ds
            full = STIFFER * full
        self.thickness, self.full = thickness @ self.basis.T, full @ self.basis.T
        self.offset = (TOUCH + (0.0 if solid else 0.5)) * self.thickness
        softer = SOFTER if self.at_nodes else SOFTER / STIFFER
        self.share, self.rounded = (softer, ROUNDED) if moving else (1.0, 0.0)

    def _points(self, vectors: np.ndarray) -> np.ndarray:
        """Return x (faces, m, p, 3) [m] of vectors (m, 18, 3)."""
        return np.asarray(self.basis @ (vectors[:, :9] + self.levers[..., None] * vectors[:, 9:]))

    def near(self, shape: SheetShape) -> Near:
        """Return where points (faces, m, p) are."""
        return near(self.obstacle, self._points(shape.vectors), self.offset, shape.sheet.instant(shape.at))

    def _pressed(self, shape: SheetShape) -> tuple[Near, Pressed]:
        """Return where points are, and how their groups are pressed."""
        found = self.near(shape)
        depth, stiffness = found.sunk[..., self.groups], (self.share * self.full * self.area)[:, self.groups]
        over = self.rounded * self.thickness[:, self.groups[:, :1]] + 0.0 * depth[..., :1]
        steps = [(1.0, 0.0, 3), (-1.0, 1.0, 3)] if self.rounded else [(1.0, 0.0, 2)]
        out = np.zeros(depth.shape[:-1]), np.zeros(depth.shape), np.zeros((*depth.shape, depth.shape[-1]))
        for sign, less, power in steps:
            q, k = depth - less * over, np.broadcast_to(sign * stiffness, depth.shape)
            k = k / over if self.rounded else k
            for sum_, part in zip(out, self._integrals(q, k, power), strict=True):
                sum_ += part
        return found, out

    def _integrals(self, q: np.ndarray, k: np.ndarray, power: int) -> tuple[np.ndarray, ...]:
        if not self.at_nodes:
            found = patch.integrals(q.reshape(-1, 9), k.reshape(-1, 9), power)
            return tuple(each.reshape(*q.shape[:-1], *each.shape[1:]) for each in found)
        d = np.maximum(q, 0.0)
        first, second = (d, d > 0.0) if power == 2 else (0.5 * d * d, d)
        return (k * first * d)[..., 0] / power, k * first, (k * second)[..., None]

    def _at_points(self, load: np.ndarray, positive: bool = False) -> np.ndarray:
        """Return sums at points (faces, m, p) of loads of groups; positive: shared among corners of parts,
        where none pulls."""
        out = np.zeros((*load.shape[:2], len(self.basis)))
        face, element = (np.arange(n) for n in load.shape[:2])
        np.add.at(
            out,
            (face[:, None, None, None], element[:, None, None], self.groups),
            load @ SPREAD if positive and not self.at_nodes else load,
        )
        return out

    def _pulled(self, shape: SheetShape) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return forces at points (faces, m, p, 3) [N], those of dashpot and friction among them, and the
        derivatives of these by the points' velocities (faces, m, p, 3, 3)."""
        found, (_, load, _) = self._pressed(shape)
        velocity = self.obstacle.velocity(shape.sheet.instant(shape.at)[1])
        speed = self._points(shape.rates) - velocity
        rubbed, by_rate = found.resistance(self._at_points(load, positive=True), speed)
        return self._at_points(load)[..., None] * found.slope + rubbed, rubbed, by_rate

    def force(self, shape: SheetShape) -> np.ndarray:
        return self._onto(shape, self._pulled(shape)[0])

    def _onto(self, shape: SheetShape, pull: np.ndarray) -> np.ndarray:
        """Return forces on the coordinates (N,) of those at points (faces, m, p, 3)."""
        pull = self.basis.T @ pull
        both = pull.sum(axis=0), (self.levers[..., None] * pull).sum(axis=0)
        return shape.sheet.of_surface(np.arange(len(self.on)), np.concatenate(both, axis=1))

    def tangent(self, shape: SheetShape) -> Tangent | None:
        found, (_, load, slope) = self._pressed(shape)
        face, element, group = np.nonzero(load.any(axis=3))
        points, out = self.groups[group], np.zeros((*load.shape[:2], 27, 27))
        change = (
            self.basis[points][..., None] * found.slope[face[:, None], element[:, None], points][:, :, None]
        )
        change = change.reshape(len(face), points.shape[1], 27)
        np.add.at(out, (face, element), change.swapaxes(1, 2) @ slope[face, element, group] @ change)
        geometric = self._at_points(load) / found.touch
        both = np.einsum("fmp,pa,pb->fmab", geometric, self.basis, self.basis, optimize=True)
        return self._between(
            np.einsum("fmab,ij->fmaibj", both, projector(self.obstacle))
            - out.reshape(*both.shape[:3], 3, 9, 3)
        )

    def rate(self, shape: SheetShape, low: Touching, high: Touching, over: float) -> np.ndarray:
        """Return the derivative of the force (N,) by what differs between two, `over` which they differ:
        their obstacle's place and size, the offset, the stiffness. Where the sheet touches stays."""
        found, (_, load, slope) = self._pressed(shape)
        stiffer = copy(self)
        stiffer.full = (high.full - low.full) / over
        before, after = low.near(shape), high.near(shape)
        deeper, turned = (after.sunk - before.sunk) / over, (after.slope - before.slope) / over
        more = stiffer._pressed(shape)[1][1] + (slope @ deeper[..., self.groups, None])[..., 0]
        pull = self._at_points(more)[..., None] * found.slope + self._at_points(load)[..., None] * turned
        return self._onto(shape, pull)

    def _between(self, blocks: np.ndarray) -> Tangent | None:
        """Return derivatives (faces, m, 9, 3, 9, 3) of nodes' forces by their places as elements have
        them."""
        on = np.flatnonzero(blocks.any(axis=(0, 2, 3, 4, 5)))
        by = np.stack([np.ones_like(self.levers), self.levers])[:, :, on]  # of φ, and of d
        out = np.einsum("rfea,cfeb,feaibj->eraicbj", by, by, blocks[:, on], optimize=True)
        return (on, out.reshape(-1, 18, 3, 18, 3)) if len(on) else None

    def damping(self, shape: SheetShape) -> Tangent | None:
        by_rate = self._pulled(shape)[2]
        return self._between(np.einsum("pa,pb,fmpij->fmaibj", self.basis, self.basis, by_rate, optimize=True))

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
        found, (energy, load, slope) = self._pressed(shape)
        first, on = self.groups[:, 0], self.on.ravel()
        even = (
            patch.integrals(np.ones((1, 9)), np.ones((1, 9)), 2)[1] if not self.at_nodes else np.ones((1, 1))
        )
        area = self._at_points(even * self.area[None][..., self.groups], positive=True)[0] @ self.hats
        pressed = self._at_points(load, positive=True).sum(axis=0) @ self.hats
        pressure = np.bincount(on, pressed.ravel()) / np.bincount(on, area.ravel())
        touched = slope.sum(axis=(0, 3, 4)) / (self.share * self.full[:, first])
        mean = np.divide(
            2.0 * energy, load.sum(axis=3), out=np.full(energy.shape, -np.inf), where=energy > 0.0
        )
        deepest = (
            np.maximum(found.sunk[..., self.groups].max(axis=3), mean).max(axis=0) / self.thickness[:, first]
        )
        return ContactState.of(deepest, touched), pressure
