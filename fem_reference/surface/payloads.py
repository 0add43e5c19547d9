"""Payloads of a scene in a reference (`scenes.objects.masses`): their part of the elements' mass.

    at a point      m N Nᵀ on the mid-surface
    over a part     m/A ∫ N Nᵀ dA on the mid-surface,   J/A ∫ N Nᵀ dA on the director

with the shape functions N of the element that holds the point, and the inertia J against the components of
the director's rate. The sum of a row is the mass that weighs at a node. Units: kg, kg m², m.
"""

from collections.abc import Iterator

import numpy as np

from fem_reference.surface.biquadratic import AT_GAUSS, areas
from fem_reference.surface.location import shares
from fem_reference.surface.mesh import Plan
from sheetbench.scenes import Scene


def payloads(scene: Scene, plan: Plan) -> Iterator[tuple[np.ndarray, np.ndarray, np.ndarray]]:
    """Yield for each payload its elements (k,) and masses of vectors: of the mid-surface (k, 9, 9) [kg], of
    the directors. The directors' are by component x, y and z, (3, k, 9, 9) [kg m²]."""
    for payload in scene.masses:
        if payload.at is None:
            on = plan.within(payload.where)
            sizes = areas(plan.corners[on])
            pairs = np.einsum("eg,gi,gj->eij", sizes / sizes.sum(), AT_GAUSS[0], AT_GAUSS[0])
        else:
            on, value = shares(plan.mesh, np.array([payload.at]))
            pairs = value[:, :, None] * value[:, None, :]
        yield on, payload.mass * pairs, payload.of_director[:, None, None, None] * pairs


def add_payloads(scene: Scene, plan: Plan, masses: np.ndarray) -> None:
    """Add the payloads to masses (m, 18, 3, 18, 3) of the positions, then the directors of all elements."""
    for on, by_place, by_turn in payloads(scene, plan):
        for axis in range(3):
            masses[on, :9, axis, :9, axis] += by_place
            masses[on, 9:, axis, 9:, axis] += by_turn[axis]
