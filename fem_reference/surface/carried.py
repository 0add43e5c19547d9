"""The scene's payloads in a reference (`scenes.objects.masses`): what they add to the mass of elements.

    at a point      m N Nᵀ on the mid-surface,    N Nᵀ J on the director
    over a part     m/A ∫ N Nᵀ dA on the mid-surface

with the shape functions N of the element that holds the point, and what resists the components of the
director's rate, J. What a row adds up to is the mass that weighs at a node. Units: kg, kg m², m.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fem_reference.surface.biquadratic import AT_GAUSS, NODES, areas, shape
from fem_reference.surface.location import locate
from fem_reference.surface.mesh import Plan, elements_in
from sheetbench.scenes import Mass, Scene


@dataclass(frozen=True)
class Carried:
    """elements: (k,), each once; by_place (k, 9, 9) [kg]: of the mid-surface's vectors there; by_turn
    (3, k, 9, 9) [kg m²]: of the directors' x, y and z."""

    elements: np.ndarray
    by_place: np.ndarray
    by_turn: np.ndarray

    def at_nodes(self, plan: Plan) -> np.ndarray:
        """What weighs at every node of the plan, (n,) [kg]."""
        nodes = plan.elements[self.elements]
        return np.bincount(nodes.ravel(), self.by_place.sum(axis=2).ravel(), len(plan.nodes))

    def on_surface(self) -> np.ndarray:
        """On the positions, then the directors of each element, (k, 18, 3, 18, 3)."""
        out = np.zeros((len(self.elements), 2, NODES, 3, 2, NODES, 3))
        for axis in range(3):
            out[:, 0, :, axis, 0, :, axis] = self.by_place
            out[:, 1, :, axis, 1, :, axis] = self.by_turn[axis]
        return out.reshape(-1, 2 * NODES, 3, 2 * NODES, 3)


def of_scene(scene: Scene, plan: Plan) -> Carried:
    """What a scene's payloads add to the elements of a plan."""
    found = [_added(payload, plan) for payload in scene.masses]
    each = [np.zeros(0, dtype=int), *(elements for elements, _, _ in found)]
    elements, rows = np.unique(np.concatenate(each), return_inverse=True)
    by_place, *by_turn = np.zeros((4, len(elements), NODES, NODES))
    out = Carried(elements, by_place, np.array(by_turn))
    ends = np.cumsum([len(one) for one in each])
    for start, end, (_, places, turns) in zip(ends[:-1], ends[1:], found, strict=True):
        out.by_place[rows[start:end]] += places
        out.by_turn[:, rows[start:end]] += turns
    return out


def _added(payload: Mass, plan: Plan) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The elements (k,) that a payload is on, and what it adds there, (k, 9, 9) and (3, k, 9, 9)."""
    if payload.at is None:
        on = elements_in(payload.where, plan.nodes, plan.elements)
        shares = areas(plan.corners[on])
        shares *= payload.mass / shares.sum()
        by_place = np.einsum("eg,gi,gj->eij", shares, AT_GAUSS[0], AT_GAUSS[0])
        return on, by_place, np.zeros((3, *by_place.shape))
    element, place = locate(plan.mesh, np.array([payload.at]))
    value = shape(*place)[0]
    pairs = value[:, :, None] * value[:, None, :]
    return element, payload.mass * pairs, payload.of_director[:, None, None, None] * pairs
