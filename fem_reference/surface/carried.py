"""The scene's payloads in a reference (`sheetbench.scenes.masses`): what they add to the mass of elements.

    at a point      m N Nᵀ + Pxx N,x N,xᵀ + Pyy N,y N,yᵀ  on the mid-surface,    Pzz N Nᵀ  on the director
    over a part     m/A ∫ N Nᵀ dA                          on the mid-surface

with the shape functions N of the element that holds the point, and the second moments P of its body. The
first derivatives add up to zero over an element: what a row adds up to is the mass that weighs at a node.
Units: kg, kg m², m.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fem_reference.surface.biquadratic import AT_GAUSS, NODES, areas, jacobians, shape
from fem_reference.surface.location import locate
from fem_reference.surface.mesh import Plan, elements_in
from sheetbench.scenes import Scene


@dataclass(frozen=True)
class Carried:
    """elements: (k,), each once; by_place (k, 9, 9) [kg]: of the mid-surface's vectors there; by_turn
    (k, 9, 9) [kg m²]: of the directors."""

    elements: np.ndarray
    by_place: np.ndarray
    by_turn: np.ndarray

    def at_nodes(self, plan: Plan) -> np.ndarray:
        """What weighs at every node of the plan, (n,) [kg]."""
        nodes = plan.elements[self.elements]
        return np.bincount(nodes.ravel(), self.by_place.sum(axis=2).ravel(), len(plan.nodes))

    def on_surface(self) -> np.ndarray:
        """On the positions, then the directors of each element, (k, 18, 3, 18, 3)."""
        both = np.zeros((len(self.elements), 2, NODES, 2, NODES))
        both[:, 0, :, 0], both[:, 1, :, 1] = self.by_place, self.by_turn
        return np.einsum("eij,cd->eicjd", both.reshape(-1, 2 * NODES, 2 * NODES), np.eye(3))


def of_scene(scene: Scene, plan: Plan) -> Carried:
    """What a scene's payloads add to the elements of a plan."""
    found: list[tuple[np.ndarray, np.ndarray, np.ndarray]] = []
    for payload in scene.masses:
        if payload.at is not None:
            found.append(_body(payload.mass, payload.second_moments, plan, np.array(payload.at)))
            continue
        on = elements_in(payload.where, plan.nodes, plan.elements)
        shares = areas(plan.corners[on])
        by_place = np.einsum("eg,gi,gj->eij", payload.mass / shares.sum() * shares, AT_GAUSS[0], AT_GAUSS[0])
        found.append((on, by_place, np.zeros_like(by_place)))
    on = np.concatenate([np.zeros(0, dtype=int), *(each for each, _, _ in found)])
    elements, where = np.unique(on, return_inverse=True)
    out = Carried(elements, *np.zeros((2, len(elements), NODES, NODES)))
    if found:
        np.add.at(out.by_place, where, np.concatenate([each for _, each, _ in found]))
        np.add.at(out.by_turn, where, np.concatenate([each for _, _, each in found]))
    return out


def _body(
    mass: float, moments: tuple[float, float, float], plan: Plan, at: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The element (1,) of a body at a plan point (2,) [m], and what it adds there (1, 9, 9)."""
    element, place = locate(plan.mesh, at.reshape(1, 2))
    value, slope = shape(*place)
    by_local = jacobians(plan.corners[element], slope)[0, 0]  # ∂x_b/∂ξ_a
    by_x, by_y = np.linalg.solve(by_local.T, slope[:, 0])
    own = np.outer(value[0], value[0])
    by_place = mass * own + moments[0] * np.outer(by_x, by_x) + moments[1] * np.outer(by_y, by_y)
    return element, by_place[None], moments[2] * own[None]
