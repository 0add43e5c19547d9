"""Contact of a reference with a rigid obstacle: penalty pressures on the mid-surface of a shell with an
offset of half the thickness, on the faces of a solid.

A place x = φ + ζ d of the sheet, ζ = 0 or ±h/2, is δ deep in an obstacle
(`sheetbench.scenes.meaning.distances`), o = h/2 + δ₀ of a mid-surface, δ₀ of faces. The work of the pressure
p(δ) in sinking is its energy ψ per area, ½ k δ² at rest, and its force gives

    f = ∫ p n N dA on φ,  ζ f on d;      −∂f/∂x = ∫ (p' n nᵀ − p ∂n/∂x) N N dA.

On a plane under a sheet that is flat when nothing acts on it nodes have areas ∫N dA, all positive on nine
nodes, where they are Simpson's rule, and k = E/h. Else the place that touches may be anywhere in an element,
and small: δ is biquadratic between 3 × 3 points of each of its parts, no longer than R/3, and integrals run
over {δ > 0} (`patch`), with k STIFFER times as much; at rest elements join without kinks
(`tangent_planes`). Motion has parts up to R/2, k = SOFTER E/h and ψ = k (⟨δ⟩³ − ⟨δ − δ₁⟩³)/6δ₁, δ₁ = 0.3 h.
"""

from __future__ import annotations

from copy import copy

import numpy as np

from fem_reference.discrete import patch, tangent_planes
from fem_reference.discrete.items import SheetItem, Tangent
from fem_reference.discrete.shape import SheetShape
from fem_reference.surface.biquadratic import AT_GAUSS, areas, jacobians
from fem_reference.surface.biquadratic import shape as biquadratic
from fem_reference.surface.materials import constants_of
from fem_reference.surface.mesh import Plan
from sheetbench.answers.contact import ContactState
from sheetbench.scenes import Scene
from sheetbench.scenes.meaning.distances import ContactPoints, near, projector
from sheetbench.scenes.objects.obstacles import TOUCH, AnyObstacle, Plane

SOFTER, ROUNDED, STIFFER = 0.01, 0.3, 100.0  # in motion: of E/h, over which part of h rounded; of patches
SPREAD = np.kron(*2 * [np.array([[1.0, 0.0, 0.0], [0.5, 0.0, 0.5], [0.0, 0.0, 1.0]])])  # none pulls there
NEARLY = 1e-6  # of `least` parts, over which the longest may be: parts of round ratios stay at small changes
SIMPSON = np.outer([1.0, 4.0, 1.0], [1.0, 4.0, 1.0]).ravel() / 9.0  # ∫ N dr ds of a part's points
Pressed = tuple[np.ndarray, np.ndarray, np.ndarray]  # energy, loads and slopes of groups (faces, m, t, …)


class ObstacleContact(SheetItem):
    """Contact of a sheet with one obstacle. share: of the penalty's stiffness in use; basis: (p, 9) shape
    functions at an element's points; shares: (p, n) weights of its nodes and of a (`tangent_planes`) in the
    surface there; hats: (p, 9) nonnegative weights of nodes; groups: (t, 9) points of each part, or one node
    nine times; heights: ζ (faces, m, 9) [m] of elements' nodes."""

    def __init__(self, scene: Scene, plan: Plan, moving: bool, solid: bool, name: str, obstacle: AnyObstacle):
        self.name, self.obstacle, self.on = name, obstacle, plan.elements
        constants, weight = constants_of(scene, plan.corners), areas(plan.corners)
        of_nodes = weight @ AT_GAUSS[0]
        thickness = (weight * constants.thickness) @ AT_GAUSS[0] / of_nodes
        curled = not moving and bool(scene.natural_by or scene.actuators)
        at_nodes = isinstance(obstacle, Plane) and not curled
        self.bent = not (moving or at_nodes)
        stiffness = (STIFFER if self.bent else 1.0) * constants.stretching / constants.thickness**2
        full = (weight * stiffness) @ AT_GAUSS[0] / of_nodes
        self.heights = np.multiply.outer((-0.5, 0.5) if solid else (0.0,), thickness)
        if at_nodes:
            self.basis = self.hats = self.shares = np.eye(9)
            self.groups, self.area = np.repeat(np.arange(9), 9).reshape(9, 9), of_nodes
        else:
            least, finer = (4, 3.0) if self.bent else (2, 2.0)
            longest = finer * np.ptp(plan.corners, axis=1).max() / obstacle.radius
            parts = least * max(1, int(np.ceil(longest / least - NEARLY)))
            line = np.linspace(-1.0, 1.0, 2 * parts + 1)
            r, s = (coordinates.ravel() for coordinates in np.meshgrid(line, line, indexing="ij"))
            number = np.arange(len(r)).reshape(len(line), -1)
            self.groups = np.lib.stride_tricks.sliding_window_view(number, (3, 3))[::2, ::2].reshape(-1, 9)
            self.basis, slope = biquadratic(r, s)
            curves, self.hats = tangent_planes.shares(r, s)
            self.shares = np.hstack([self.basis, curves]) if self.bent else self.basis
            self.area = np.abs(np.linalg.det(jacobians(plan.corners, slope))) / parts**2  # by a part's dr ds
        self.of_groups = (0.25 if at_nodes else 1.0) * self.area[:, self.groups]
        self.thickness, self.full = thickness @ self.basis.T, full @ self.basis.T
        self.offset = (TOUCH + (0.0 if solid else 0.5)) * self.thickness
        self.share, self.rounded = (SOFTER, ROUNDED) if moving else (1.0, 0.0)

    def _faces(self, vectors: np.ndarray) -> np.ndarray:
        """Return φ + ζ d (faces, m, 9, 3) of vectors (m, 18, 3)."""
        return np.asarray(vectors[:, :9] + self.heights[..., None] * vectors[:, 9:])

    def _points(self, vectors: np.ndarray) -> np.ndarray:
        """Return x (faces, m, p, 3) [m] of vectors (m, 18, 3)."""
        faces = self._faces(vectors)
        if self.bent:
            curves = np.broadcast_to(tangent_planes.corrections(vectors), (len(faces), *vectors.shape))
            faces = np.concatenate([faces, curves], axis=2)
        return np.asarray(self.shares @ faces)

    def _slopes(self, vectors: np.ndarray, on: np.ndarray) -> np.ndarray:
        """Return the derivatives (faces, k, n, 3, 18, 3) of the faces' nodal positions and of a
        (`tangent_planes`) by the vectors (k, 18, 3) of elements `on`."""
        nodes, size = np.arange(9), self.shares.shape[1]
        out = np.zeros((len(self.heights), len(on), size, 3, 18, 3))
        out[:, :, nodes, :, nodes] = np.eye(3)
        out[:, :, nodes, :, nodes + 9] = np.moveaxis(self.heights[:, on], 2, 0)[..., None, None] * np.eye(3)
        if self.bent:
            out[:, :, 9:] = tangent_planes.first(vectors)
        return out

    def near(self, shape: SheetShape) -> ContactPoints:
        """Return the positions and depths of points (faces, m, p) relative to the obstacle."""
        return near(self.obstacle, self._points(shape.vectors), self.offset, shape.sheet.instant(shape.at))

    def _pressed(self, shape: SheetShape) -> tuple[ContactPoints, Pressed]:
        """Return the points' positions and depths, and the energies, loads and load derivatives of their
        groups."""
        found = self.near(shape)
        depth = found.penetration[..., self.groups]
        k = self.share * self.full[:, self.groups] * self.of_groups + 0.0 * depth
        if not self.rounded:
            return found, patch.integrals(depth, k, 2)
        over = self.rounded * self.thickness[:, self.groups[:, :1]]
        both = (patch.integrals(depth - less, k / over, 3) for less in (0.0, over))
        energy, load, slope = (all_of - less for all_of, less in zip(*both, strict=True))
        return found, (energy, load, slope)

    def _at_points(self, load: np.ndarray) -> np.ndarray:
        """Add up the loads of groups at points (faces, m, p)."""
        out = np.zeros((*load.shape[:2], len(self.basis)))
        face, element = (np.arange(n)[:, None, None] for n in load.shape[:2])
        np.add.at(out, (face[..., None], element, self.groups), load)
        return out

    def _pulled(self, shape: SheetShape) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return the contact forces at points (faces, m, p, 3) [N], their dashpot and friction part, and that
        part's derivatives by the points' velocities (faces, m, p, 3, 3)."""
        found, (_, load, _) = self._pressed(shape)
        velocity = self.obstacle.velocity(shape.sheet.instant(shape.at)[1])
        speed = self.basis @ self._faces(shape.rates) - velocity
        rubbed, by_rate = found.resistance(self._at_points(load @ SPREAD), speed)
        return self._at_points(load)[..., None] * found.slope + rubbed, rubbed, by_rate

    def force(self, shape: SheetShape) -> np.ndarray:
        return self._onto(shape, self._pulled(shape)[0])

    def _onto(self, shape: SheetShape, pull: np.ndarray) -> np.ndarray:
        """Return forces on the coordinates (N,) from forces at points (faces, m, p, 3)."""
        on = np.flatnonzero(pull.any(axis=(0, 2, 3)))
        by = self._slopes(shape.vectors[on], on)
        pull = np.einsum("fmni,fmnijc->mjc", self.shares.T @ pull[:, on], by, optimize=True)
        return shape.sheet.of_surface(on, pull)

    def tangent(self, shape: SheetShape) -> Tangent | None:
        found, (_, load, slope) = self._pressed(shape)
        face, element, group = np.nonzero(load.any(axis=3))
        on, back = np.unique(element, return_inverse=True)
        points, n = self.groups[group], self.shares.shape[1]
        out = np.zeros((len(load), len(on), 3 * n, 3 * n))
        at = face[:, None], element[:, None], points
        change = self.shares[points][..., None] * found.slope[at][:, :, None]
        change = change.reshape(len(face), points.shape[1], 3 * n)
        np.add.at(out, (face, back), -change.swapaxes(1, 2) @ slope[face, element, group] @ change)
        loads = self._at_points(load)[:, on]
        bent = loads[..., None] * found.curvature[:, on]
        both = np.einsum("fmpj,pa,pb->fmabj", bent, self.shares, self.shares, optimize=True)
        out += (both[:, :, :, None] * projector(self.obstacle)[:, None]).reshape(out.shape)
        return self._between(shape, on, out, (loads[..., None] * found.slope[:, on]).sum(axis=0))

    def rate(self, shape: SheetShape, low: ObstacleContact, high: ObstacleContact, over: float) -> np.ndarray:
        """Return the derivative (N,) of the contact force by a parameter that changes by `over` from contact
        `low` to contact `high`, through the obstacle's position and size, offset and stiffness. The patch
        stays."""
        found, (_, load, slope) = self._pressed(shape)
        stiffer = copy(self)
        stiffer.full = (high.full - low.full) / over
        before, after = low.near(shape), high.near(shape)
        deeper, turned = (after.penetration - before.penetration) / over, (after.slope - before.slope) / over
        more = stiffer._pressed(shape)[1][1] + (slope @ deeper[..., self.groups, None])[..., 0]
        pull = self._at_points(more)[..., None] * found.slope + self._at_points(load)[..., None] * turned
        return self._onto(shape, pull)

    def _between(
        self, shape: SheetShape, on: np.ndarray, by: np.ndarray, pull: np.ndarray | None = None
    ) -> Tangent | None:
        """Return the tangent of elements `on` by their vectors, from the derivatives `by` (faces, k, 3 n, 3
        n) by the faces' nodal positions and a; pull: forces at points (k, p, 3)."""
        vectors = shape.vectors[on]
        first = self._slopes(vectors, on).reshape(*by.shape[:3], 54)
        out = (first.swapaxes(-1, -2) @ by @ first).sum(axis=0).reshape(-1, 18, 3, 18, 3)
        if self.bent and pull is not None:
            out += tangent_planes.second(vectors, self.shares[:, 9:].T @ pull)
        return (on, out) if len(on) else None

    def damping(self, shape: SheetShape) -> Tangent | None:
        by_rate = self._pulled(shape)[2]
        on = np.flatnonzero(by_rate.any(axis=(0, 2, 3, 4)))
        by = np.einsum("pa,pb,fmpij->fmaibj", self.shares, self.shares, by_rate[:, on], optimize=True)
        return self._between(shape, on, by.reshape(*by.shape[:2], 27, 27))

    def potential(self, shape: SheetShape) -> float:
        return float(self._pressed(shape)[1][0].sum())

    stored = potential

    def powers(self, shape: SheetShape) -> tuple[float, float]:
        velocity, (pull, rubbed, _) = self.obstacle.velocity(shape.at), self._pulled(shape)
        taken = rubbed.sum(axis=(0, 1, 2)) @ velocity - self._onto(shape, rubbed) @ shape.v
        return float(taken), float(pull.sum(axis=(0, 1, 2)) @ velocity)

    def support_forces(self, shape: SheetShape) -> dict[str, tuple[np.ndarray, np.ndarray]]:
        return {self.name: (self._points(shape.vectors), self._pulled(shape)[0])}

    def report(self, shape: SheetShape) -> tuple[ContactState, np.ndarray]:
        """Return the state of contact and the pressure (n,) [Pa] at the nodes of the plan."""
        found, (energy, load, slope) = self._pressed(shape)
        first, on = self.groups[:, 0], self.on.ravel()
        area = self._at_points((SIMPSON * self.of_groups[None]) @ SPREAD)[0] @ self.hats
        pressed = self._at_points(load @ SPREAD).sum(axis=0) @ self.hats
        pressure = np.bincount(on, pressed.ravel()) / np.bincount(on, area.ravel())
        touched = slope.sum(axis=(0, 3, 4)) / (self.share * self.full[:, first])
        mean = np.where(energy > 0.0, 2.0 * energy / (load.sum(axis=3) + 1e-300), -np.inf)
        deepest = np.maximum(found.penetration[..., self.groups].max(axis=3), mean).max(axis=0)
        deepest /= self.thickness[:, first]
        return ContactState.of(deepest, touched, load), pressure
