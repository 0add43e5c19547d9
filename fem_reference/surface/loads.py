"""Loads of the sheet: dead nodal forces, a follower pressure and a follower edge moment.

gravity    f = ∫ ρ h g N dA                       dead, and that of payloads (`surface.carried`)
point      f = F N(x)                             dead
edge       f = ∫ q N dL                           dead, per undeformed length
area       f = ∫ q N dA                           dead, per undeformed area
pressure   f = ∫ p N φ,r × φ,s dr ds              follows the normal, per current area
moment     f_d = ∫ m N t̂ × d dL,  t̂ = φ,L/|φ,L|   on the directors, about the current edge tangent

With ν the outward normal, L runs along ν × e_z, so that m > 0 turns the edge towards +z outside it:
the virtual work of a moment m t̂ on δd = δθ × d is δd · (m t̂ × d). Units: N, N/m, N·m/m, Pa, m.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from fem_reference.surface.biquadratic import (
    AT_GAUSS,
    GAUSS_WEIGHTS,
    THREE,
    THREE_WEIGHTS,
    areas,
    shape,
    side_shape,
)
from fem_reference.surface.carried import weighing
from fem_reference.surface.location import locate
from fem_reference.surface.materials import constants_of
from fem_reference.surface.mesh import Plan, elements_in, facets_on
from sheetbench.scenes import EdgeLoad, PointLoad, Pressure, Scene, encloses_volume
from sheetbench.scenes.objects.loads import AreaLoad

# Local nodes of the four sides, in scikit-fem's order of facets: corner, mid-side, corner.
_SIDES = np.array([[0, 4, 1], [1, 5, 2], [2, 6, 3], [0, 7, 3]])
_LINE, _LINE_SLOPE = side_shape(THREE)  # (3 points, 3 nodes)


def _cross_matrix(a: np.ndarray) -> np.ndarray:
    """[a]× with [a]× b = a × b, for vectors (…, 3)."""
    return np.cross(a[..., None, :], np.eye(3), axisa=-1, axisb=-1, axisc=-1).swapaxes(-1, -2)


@dataclass(frozen=True)
class FollowerPressure:
    """Pressure [Pa] on elements (k,); orientation: (k,) +1 where r, s run counter-clockwise, else −1;
    conservative: where the rim of what is pressed sweeps no area (`scenes.encloses_volume`)."""

    value: float
    elements: np.ndarray
    orientation: np.ndarray
    conservative: bool = False

    def force(self, vectors: np.ndarray) -> np.ndarray:
        value, slope = AT_GAUSS
        along, across = np.einsum("agi,eic->aegc", slope, vectors[:, :9])
        out = np.zeros_like(vectors)
        out[:, :9] = np.einsum(
            "e,g,gi,egc->eic", self._strength, GAUSS_WEIGHTS, value, np.cross(along, across)
        )
        return out

    def tangent(self, vectors: np.ndarray) -> np.ndarray:
        value, slope = AT_GAUSS
        along, across = np.einsum("agi,eic->aegc", slope, vectors[:, :9])
        weighted = GAUSS_WEIGHTS[:, None] * value
        out = np.zeros((len(vectors), 18, 3, 18, 3))
        by_along = -np.einsum("gi,egcd,gj->eicjd", weighted, _cross_matrix(across), slope[0], optimize=True)
        by_across = np.einsum("gi,egcd,gj->eicjd", weighted, _cross_matrix(along), slope[1], optimize=True)
        out[:, :9, :, :9] = self._strength[:, None, None, None, None] * (by_along + by_across)
        return out

    def work(self, vectors: np.ndarray) -> float:
        """p times the volume over the plan, ∫ z (φ,r × φ,s)·e_z dr ds = Σ z f_z/p of the nodes."""
        return float(np.sum(vectors[:, :9, 2] * self.force(vectors)[:, :9, 2]))

    @property
    def _strength(self) -> np.ndarray:
        return self.value * self.orientation


@dataclass(frozen=True)
class Line:
    """Element sides along an edge.

    elements: (k,); sides, nodes: (k, 3) along ν × e_z, numbers in the element and in the plan; speed: |X,ξ|
    (k, 3) [m] at three Gauss points.
    """

    elements: np.ndarray
    sides: np.ndarray
    nodes: np.ndarray
    speed: np.ndarray

    @classmethod
    def along(cls, plan: Plan, facets: np.ndarray, elements: np.ndarray | None = None) -> Line:
        """The sides that are `facets` (k,) of a plan's mesh, of these elements or of any."""
        mesh = plan.mesh
        elements = mesh.f2t[0, facets] if elements is None else elements
        sides = _SIDES[np.argmax(mesh.t2f[:, elements] == facets, axis=0)]
        first, middle, last = np.moveaxis(plan.nodes[plan.elements[elements[:, None], sides]], 1, 0)
        tangent, inward = last - first, plan.nodes[plan.elements[elements, 8]] - middle
        # The sheet must lie to the right.
        wrong = tangent[:, 0] * inward[:, 1] - tangent[:, 1] * inward[:, 0] > 0
        sides = np.where(wrong[:, None], sides[:, ::-1], sides)
        nodes = plan.elements[elements[:, None], sides]
        return cls(elements, sides, nodes, np.linalg.norm(_LINE_SLOPE @ plan.nodes[nodes], axis=-1))

    @property
    def shares(self) -> np.ndarray:
        """∫ N dL (k, 3) [m] of the three nodes."""
        return np.einsum("g,eg,gi->ei", THREE_WEIGHTS, self.speed, _LINE)


@dataclass(frozen=True)
class FollowerMoment:
    """A moment per undeformed length [N·m/m] on a line, about its current tangent."""

    value: float
    line: Line
    conservative: ClassVar[bool] = False

    @property
    def elements(self) -> np.ndarray:
        return self.line.elements

    def force(self, vectors: np.ndarray) -> np.ndarray:
        tangent, _, director = self._frame(vectors)
        out = np.zeros_like(vectors)
        rows = np.arange(len(vectors))[:, None]
        out[rows, 9 + self.line.sides] = np.einsum(
            "eg,gi,egc->eic", self._weight, _LINE, np.cross(tangent, director)
        )
        return out

    def tangent(self, vectors: np.ndarray) -> np.ndarray:
        tangent, stretch, director = self._frame(vectors)
        normal_part = np.eye(3) - np.einsum("egc,egd->egcd", tangent, tangent)
        by_slope = -np.einsum("egcb,egbd->egcd", _cross_matrix(director), normal_part) / stretch[..., None]
        by_director = _cross_matrix(tangent)
        weighted = np.einsum("eg,gi->egi", self._weight, _LINE)
        out = np.zeros((len(vectors), 18, 3, 18, 3))
        rows = np.arange(len(vectors))[:, None, None]
        to, of = 9 + self.line.sides[:, :, None], self.line.sides[:, None, :]
        out[rows, to, :, of, :] = np.einsum(
            "egi,egcd,gj->eijcd", weighted, by_slope, _LINE_SLOPE, optimize=True
        )
        out[rows, to, :, 9 + of, :] = np.einsum(
            "egi,egcd,gj->eijcd", weighted, by_director, _LINE, optimize=True
        )
        return out

    def work(self, vectors: np.ndarray) -> float:
        """Zero: it has no potential."""
        return 0.0

    @property
    def _weight(self) -> np.ndarray:
        return self.value * THREE_WEIGHTS * self.line.speed

    def _frame(self, vectors: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Unit tangent (k, 3, 3), |φ,ξ| (k, 3, 1) and director (k, 3, 3) at the points of the sides."""
        rows = np.arange(len(vectors))[:, None]
        slope = np.einsum("gi,eic->egc", _LINE_SLOPE, vectors[rows, self.line.sides])
        stretch = np.linalg.norm(slope, axis=-1, keepdims=True)
        return slope / stretch, stretch, np.einsum("gi,eic->egc", _LINE, vectors[rows, 9 + self.line.sides])


Follower = FollowerPressure | FollowerMoment


def area_force(
    element_areas: np.ndarray, element_nodes: np.ndarray, count: int, force_per_area: np.ndarray
) -> np.ndarray:
    """∫ f N dA (count, 3) [N] of a dead force per area f (3,) [Pa].

    element_areas: w |det J| at the Gauss points (m, 9) [m²]; element_nodes: (m, 9).
    """
    shares = np.bincount(element_nodes.ravel(), (element_areas @ AT_GAUSS[0]).ravel(), count)
    return shares[:, None] * force_per_area


def line_force(line: Line, plan: Plan, force_per_length: np.ndarray) -> np.ndarray:
    """∫ q N dL (count, 3) [N] of a dead force per undeformed length q (3,) [N/m]."""
    shares = np.bincount(line.nodes.ravel(), line.shares.ravel(), len(plan.nodes))
    return shares[:, None] * force_per_length


def point_force(plan: Plan, at: np.ndarray, force: np.ndarray) -> np.ndarray:
    """F N(x) (count, 3) [N] of a dead force F (3,) at the plan point (2,) [m]."""
    element, place = locate(plan.mesh, at.reshape(1, 2))
    value, _ = shape(*place)
    out = np.zeros((len(plan.nodes), 3))
    out[plan.elements[element[0]]] = value[0][:, None] * force
    return out


def of_scene(scene: Scene, plan: Plan) -> tuple[np.ndarray, list[Follower]]:
    """Dead nodal forces (n, 3) [N] and follower loads of a scene on a mesh that carries the edges' names;
    every load with the last factor of its history."""
    count, corners = len(plan.nodes), plan.corners
    dead, followers = np.zeros((count, 3)), list[Follower]()
    if scene.gravity is not None:
        weighed = areas(corners) * constants_of(scene, corners).per_area
        acceleration = np.array(scene.gravity.last_acceleration)
        dead += area_force(weighed, plan.elements, count, acceleration)
        if scene.masses:
            dead += np.outer(weighing(scene, plan), acceleration)
    for load in scene.loads:
        factor = load.last_factor
        match load:
            case PointLoad():
                force = factor * np.array(load.force)
                dead += point_force(plan, np.array(load.at), force)
            case EdgeLoad():
                line = Line.along(plan, facets_on(plan.mesh, load))
                dead += line_force(line, plan, factor * np.array(load.force_per_length))
                if load.moment_per_length:
                    followers.append(FollowerMoment(factor * load.moment_per_length, line))
            case AreaLoad():
                on = elements_in(load.where, plan.nodes, plan.elements)
                force = factor * np.array(load.force_per_area)
                dead += area_force(areas(corners[on]), plan.elements[on], count, force)
            case Pressure():
                on = elements_in(load.where, plan.nodes, plan.elements)
                closed = encloses_volume(scene.supports) and not (scene.pierced or load.where)
                followers.append(FollowerPressure(factor * load.value, on, orientation(corners[on]), closed))
    return dead, followers


def orientation(nodes: np.ndarray) -> np.ndarray:
    """+1 or −1 (m,): whether r, s turn counter-clockwise in elements with node positions (m, 9, 2)."""
    r, s = nodes[:, 5] - nodes[:, 7], nodes[:, 6] - nodes[:, 4]
    return np.sign(r[:, 0] * s[:, 1] - r[:, 1] * s[:, 0])
