"""The shell's kinetic energy ½ ρh |u̇|² + ½ ρh³/12 |ḋ|² per area, and its vectors in terms of its unknowns."""

from __future__ import annotations

import numpy as np
from scipy.sparse import block_diag, csc_matrix, csr_matrix, kron

from fem_reference.shell.structure import ShellStructure
from fem_reference.surface import carried
from fem_reference.surface.biquadratic import AT_GAUSS
from fem_reference.surface.materials import constants_of
from fem_reference.surface.mesh import Plan
from sheetbench.numerics.sparsity import Pattern
from sheetbench.scenes import Scene


def products(structure: ShellStructure, scene: Scene, plan: Plan) -> tuple[np.ndarray, np.ndarray]:
    """∫ ρh N_i N_j dA (m, 9, 9) [kg] and, of the directors' x, y and z, ∫ ρh³/12 N_i N_j dA (3, m, 9, 9)
    [kg m²], with what the payloads add."""
    value, of = AT_GAUSS[0], constants_of(scene, structure.element.reference[:, :9, :2])
    by_place, by_turn = (
        np.asarray(np.einsum("eg,gi,gj->eij", part * structure.element.areas, value, value))
        for part in (of.per_area, of.rotary_per_area)
    )
    payloads = carried.of_scene(scene, plan)
    by_place[payloads.elements] += payloads.by_place
    by_axis = np.tile(by_turn, (3, 1, 1, 1))
    by_axis[:, payloads.elements] += payloads.by_turn
    return by_place, by_axis


def mass(structure: ShellStructure, products: tuple[np.ndarray, np.ndarray]) -> csr_matrix:
    """Consistent mass of all vectors' components (3 (2 n + q),); rods have none."""
    pattern = Pattern(structure.element_nodes, size=structure.count)
    none = csr_matrix((3 * len(structure.rods.own),) * 2)
    by_place, by_turn = products
    turning = sum(kron(pattern.matrix(by_turn[axis]), np.diag(row)) for axis, row in enumerate(np.eye(3)))
    return block_diag([kron(pattern.matrix(by_place), np.eye(3)), turning, none], format="csr")


class Basis:
    """Z with δq = Z x: where its entries lie; a column has one of a displacement, three of a rotation."""

    def __init__(self, structure: ShellStructure):
        n = structure.count
        node, field = np.nonzero(structure.number >= 0)  # in the order of the unknowns
        of_rod, tangent = np.nonzero(structure.turns[n:] >= 0)
        node, field = np.append(node, n + of_rod), np.append(field, 3 + tangent)
        self._turn = node[field >= 3], field[field >= 3] - 3
        widths = np.where(field < 3, 1, 3)
        self._starts = np.concatenate([[0], np.cumsum(widths)])
        rows = np.where(field < 3, 3 * node + field, 3 * (n + node))
        within = np.arange(self._starts[-1]) - np.repeat(self._starts[:-1], widths)
        self._rows, self._turning = np.repeat(rows, widths) + within, np.repeat(field >= 3, widths)
        self._shape = 3 * (n + len(structure.turns)), structure.unknowns

    def at(self, frames: np.ndarray) -> csc_matrix:
        """Z where directors have the frames T (n + q, 3, 2)."""
        data = np.ones(len(self._rows))
        node, tangent = self._turn
        data[self._turning] = frames[node, :, tangent].ravel()
        return csc_matrix((data, self._rows, self._starts), self._shape)
