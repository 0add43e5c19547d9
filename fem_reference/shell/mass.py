"""Mass of a shell: ∫ ρh N_i N_j dA of positions, ∫ ρh³/12 N_i N_j dA of directors, and of payloads."""

from __future__ import annotations

import numpy as np
from scipy.sparse import block_diag, csr_matrix, kron

from fem_reference.surface import carried
from fem_reference.surface.biquadratic import AT_GAUSS
from fem_reference.surface.materials import constants_of
from fem_reference.surface.mesh import Plan
from sheetbench.numerics.sparsity import Pattern
from sheetbench.scenes import Scene


def products(scene: Scene, plan: Plan, areas: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the elements' masses of positions (m, 9, 9) [kg] and of the directors' x, y and z (3, m, 9, 9)
    [kg m²]; areas: of their Gauss points (m, 9) [m²]."""
    value, of = AT_GAUSS[0], constants_of(scene, plan.corners)
    by_place, by_turn = (
        np.asarray(np.einsum("eg,gi,gj->eij", part * areas, value, value))
        for part in (of.per_area, of.rotary_per_area)
    )
    payloads = carried.of_scene(scene, plan)
    by_place[payloads.elements] += payloads.by_place
    by_axis = np.tile(by_turn, (3, 1, 1, 1))
    by_axis[:, payloads.elements] += payloads.by_turn
    return by_place, by_axis


def mass_matrix(plan: Plan, products: tuple[np.ndarray, np.ndarray], size: int) -> csr_matrix:
    """Return M (size, size) of `products` on nodes' positions, then directors; other vectors have none."""
    nodes = len(plan.nodes)
    pattern, none = Pattern(plan.elements, size=nodes), csr_matrix((size - 6 * nodes,) * 2)
    by_place, by_turn = products
    turning = sum(kron(pattern.matrix(by_turn[axis]), np.diag(row)) for axis, row in enumerate(np.eye(3)))
    return block_diag([kron(pattern.matrix(by_place), np.eye(3)), turning, none], format="csr")
