"""Loads of the sheet: dead nodal forces, a follower pressure and a follower edge moment.

gravity    f = ∫ ρ h g N dA                       dead; weight of payloads: `surface.payloads`
           f_d = ∫ (∫ρz dz) g N dA                dead, on the directors, of layers of different density
point      f = F N(x)                             dead
edge       f = ∫ q N dL                           dead, per undeformed length
area       f = ∫ q N dA                           dead, per undeformed area
pressure   f = ∫ p N φ,r × φ,s dr ds              follows the normal, per current area
moment     f_d = ∫ m N t̂ × d dL,  t̂ = φ,L/|φ,L|   on the directors, about the current edge tangent

L runs along ν × e_z, ν the outward normal, so that m > 0 turns the edge towards +z outside it:
the virtual work of a moment m t̂ on δd = δθ × d is δd · (m t̂ × d). Units: N, N/m, N·m/m, Pa, m.
"""

from dataclasses import dataclass
from typing import ClassVar, Self

import numpy as np

from fem_reference.surface.biquadratic import AT_GAUSS, GAUSS_WEIGHTS, THREE, THREE_WEIGHTS, areas, side_shape
from fem_reference.surface.location import shares
from fem_reference.surface.materials import constants_of
from fem_reference.surface.mesh import Plan, facets_on
from fem_reference.surface.payloads import payloads
from sheetbench.scenes import EdgeLoad, PointLoad, Pressure, Scene, encloses_volume
from sheetbench.scenes.objects.loads import AreaLoad

# Local nodes of the four sides, in scikit-fem's order of facets: corner, mid-side, corner.
_SIDES = np.array([[0, 4, 1], [1, 5, 2], [2, 6, 3], [0, 7, 3]])
_LINE, _LINE_SLOPE = side_shape(THREE)  # (3 points, 3 nodes)
_CROSS = np.cross(np.eye(3)[:, None], np.eye(3)).swapaxes(1, 2)  # (a × b)_c = a_a _CROSS_acd b_d


@dataclass(frozen=True)
class FollowerPressure:
    """Pressure [Pa] on elements (k,). orientation: (k,) +1 where r, s run counter-clockwise, else −1;
    conservative: whether the rim of the pressed part sweeps no area (`scenes.encloses_volume`)."""

    value: float
    elements: np.ndarray
    orientation: np.ndarray
    conservative: bool = False

    def force(self, vectors: np.ndarray) -> np.ndarray:
        value, slope = AT_GAUSS
        along, across = np.einsum("agi,eic->aegc", slope, vectors[:, :9])
        out, signed = np.zeros_like(vectors), self.value * self.orientation
        out[:, :9] = np.einsum("e,g,gi,egc->eic", signed, GAUSS_WEIGHTS, value, np.cross(along, across))
        return out

    def tangent(self, vectors: np.ndarray) -> np.ndarray:
        value, slope = AT_GAUSS
        along, across = np.einsum("agi,eic->aegc", slope, vectors[:, :9])
        weighed = GAUSS_WEIGHTS[:, None] * value
        sides = (self.value * self.orientation)[:, None, None] * [-across, along]
        out = np.zeros((len(vectors), 18, 3, 18, 3))
        out[:, :9, :, :9] = np.einsum("gi,agj,aegb,bcd->eicjd", weighed, slope, sides, _CROSS, optimize=True)
        return out

    def work(self, vectors: np.ndarray) -> float:
        """Return p times the volume over the plan, ∫ z (φ,r × φ,s)·e_z dr ds = Σ z f_z/p of the nodes."""
        return float(np.sum(vectors[:, :9, 2] * self.force(vectors)[:, :9, 2]))


@dataclass(frozen=True)
class Line:
    """Element sides along an edge. elements: (k,); sides, nodes: (k, 3) along ν × e_z, numbers in the element
    and in the plan; speed: |X,ξ| (k, 3) [m] at three Gauss points."""

    elements: np.ndarray
    sides: np.ndarray
    nodes: np.ndarray
    speed: np.ndarray

    @classmethod
    def along(cls, plan: Plan, facets: np.ndarray, elements: np.ndarray | None = None) -> Self:
        """Return the sides at `facets` (k,) of a plan's mesh, of given elements (k,) or of any."""
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

    def shares(self) -> np.ndarray:
        """Return ∫ N dL (k, 3) [m] of the three nodes."""
        return np.einsum("g,eg,gi->ei", THREE_WEIGHTS, self.speed, _LINE)


@dataclass(frozen=True)
class FollowerMoment:
    """Moment per undeformed length [N·m/m] on a line of elements (k,), about its current tangent."""

    value: float
    elements: np.ndarray
    line: Line
    conservative: ClassVar[bool] = False

    def force(self, vectors: np.ndarray) -> np.ndarray:
        tangent, _, director = self._frame(vectors)
        out = np.zeros_like(vectors)
        rows, couple = np.arange(len(vectors))[:, None], np.cross(tangent, director)
        out[rows, 9 + self.line.sides] = np.einsum("eg,gi,egc->eic", self._weight, _LINE, couple)
        return out

    def tangent(self, vectors: np.ndarray) -> np.ndarray:
        tangent, stretch, director = self._frame(vectors)
        normal_part = np.eye(3) - np.einsum("egc,egd->egcd", tangent, tangent)
        by_slope = -np.einsum("ega,acb,egbd->egcd", director / stretch, _CROSS, normal_part)
        by_director = np.einsum("ega,acd->egcd", tangent, _CROSS)
        weighted = np.einsum("eg,gi->egi", self._weight, _LINE)
        out = np.zeros((len(vectors), 18, 3, 18, 3))
        rows = np.arange(len(vectors))[:, None, None]
        to, of = 9 + self.line.sides[:, :, None], self.line.sides[:, None, :]
        form = "egi,egcd,gj->eijcd"
        out[rows, to, :, of, :] = np.einsum(form, weighted, by_slope, _LINE_SLOPE, optimize=True)
        out[rows, to, :, 9 + of, :] = np.einsum(form, weighted, by_director, _LINE, optimize=True)
        return out

    def work(self, vectors: np.ndarray) -> float:
        """Return zero: the moment has no potential."""
        return 0.0

    @property
    def _weight(self) -> np.ndarray:
        return self.value * THREE_WEIGHTS * self.line.speed

    def _frame(self, vectors: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return unit tangent, |φ,ξ| and director (k, 3, 3), (k, 3, 1), (k, 3, 3) at the sides' points."""
        rows = np.arange(len(vectors))[:, None]
        slope = np.einsum("gi,eic->egc", _LINE_SLOPE, vectors[rows, self.line.sides])
        stretch = np.linalg.norm(slope, axis=-1, keepdims=True)
        return slope / stretch, stretch, np.einsum("gi,eic->egc", _LINE, vectors[rows, 9 + self.line.sides])


Follower = FollowerPressure | FollowerMoment


def spread(plan: Plan, nodes: np.ndarray, shares: np.ndarray, force: np.ndarray) -> np.ndarray:
    """Return dead nodal forces (n, 3) of a force (3,) of which nodes (k, a) have shares (k, a)."""
    return np.outer(np.bincount(nodes.ravel(), shares.ravel(), len(plan.nodes)), force)


def of_scene(scene: Scene, plan: Plan) -> tuple[np.ndarray, list[Follower]]:
    """Return dead forces (2 n, 3) [N, N m] on positions, then directors of nodes, and the loads that follow
    the sheet. The mesh carries the edges' names; every load has the last factor of its history."""
    corners, followers = plan.corners, list[Follower]()
    dead, on_directors = [np.zeros((len(plan.nodes), 3))], np.zeros((len(plan.nodes), 3))
    if scene.gravity is not None:
        acceleration = np.array(scene.gravity.last_acceleration)
        of = constants_of(scene, corners)
        weighed, turned = (areas(corners) * per_area for per_area in (of.per_area, of.moment_per_area))
        dead.append(spread(plan, plan.elements, weighed @ AT_GAUSS[0], acceleration))
        on_directors = spread(plan, plan.elements, turned @ AT_GAUSS[0], acceleration)
        for on, mass, _ in payloads(scene, plan):
            dead.append(spread(plan, plan.elements[on], mass.sum(axis=2), acceleration))
    for load in scene.loads:
        factor = load.last_factor
        match load:
            case PointLoad():
                element, value = shares(plan.mesh, np.array([load.at]))
                dead.append(spread(plan, plan.elements[element], value, factor * np.array(load.force)))
            case EdgeLoad():
                line = Line.along(plan, facets_on(plan.mesh, load))
                force = factor * np.array(load.force_per_length)
                dead.append(spread(plan, line.nodes, line.shares(), force))
                if load.moment_per_length:
                    moment = factor * load.moment_per_length
                    followers.append(FollowerMoment(moment, line.elements, line))
            case AreaLoad():
                on = plan.within(load.where)
                force = factor * np.array(load.force_per_area)
                dead.append(spread(plan, plan.elements[on], areas(corners[on]) @ AT_GAUSS[0], force))
            case Pressure():
                on = plan.within(load.where)
                closed = encloses_volume(scene.supports) and not (scene.pierced or load.where)
                followers.append(FollowerPressure(factor * load.value, on, orientation(corners[on]), closed))
    return np.concatenate([np.sum(dead, axis=0), on_directors]), followers


def orientation(nodes: np.ndarray) -> np.ndarray:
    """Return +1 or −1 (m,): whether r, s turn counter-clockwise in elements with node positions (m, 9, 2)."""
    r, s = nodes[:, 5] - nodes[:, 7], nodes[:, 6] - nodes[:, 4]
    return np.sign(r[:, 0] * s[:, 1] - r[:, 1] * s[:, 0])
