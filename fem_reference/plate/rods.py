"""The elastic rods of `rod` on the linear plate: the same strains, linearised about the flat sheet.

    ½ Σ S (B q − e₀)²,    B = H Q₀

with q the change of Q = (φ, d, m). With s along the edge, t outwards, tilt β and the axis at the height c the
strains are, per length,

    axial u_s,s + c β_s,s    shear w,s + β_s    aside u_t,s + c β_t,s + m_s    twist β_t,s    square β_t + m_z
    bending −β_s,s out of the plane, −m_s,s in it

so that a rod off the mid-surface couples bending and membrane, as it should. Its intrinsic curvature is an
initial moment EI κ₀; what that moment does as the rod deflects is of second order. Unknowns beside the
plate's are m_s and m_z at the nodes of the edges. SI units.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.sparse import block_diag, coo_matrix, csr_matrix
from skfem import MeshQuad

from fem_reference.surface import actuator_forces, edge_motion, rod
from fem_reference.surface.edge_motion import MovedEdge
from fem_reference.surface.rod import Rod
from fem_reference.surface.supports import Supports
from sheetbench.scenes import EDGES, EdgeMotion, Scene

UP = np.array([0.0, 0.0, 1.0])


@dataclass(frozen=True)
class BoundRod:
    """A rod and the unknowns (k, 27) of its sides' q, −1 where q has none; aside: those of m (p, 2)."""

    rod: Rod
    numbers: np.ndarray
    aside: np.ndarray

    @property
    def operator(self) -> np.ndarray:
        """B (k, 15, 27)."""
        reference = self.rod.reference
        return self.rod.gradient(np.zeros_like(reference)).reshape(len(reference), -1, 27)

    def strain(self, u: np.ndarray) -> np.ndarray:
        """Strains (k, 15) of all unknowns."""
        return np.einsum("esc,ec->es", self.operator, np.where(self.numbers >= 0, u[self.numbers], 0.0))

    def pull(self, u: np.ndarray) -> np.ndarray:
        """Force on q (k, 9, 3): internal, less the rod's weight."""
        stress = self.rod.stress(self.strain(u), 1.0)
        return np.einsum("es,esc->ec", stress, self.operator).reshape(-1, 9, 3) - self.rod.weight


@dataclass(frozen=True)
class PlateRods:
    """The rods of a plate with n nodes, whose unknowns are 5·node + field."""

    bound: tuple[BoundRod, ...]

    @classmethod
    def on(cls, rods: list[Rod], nodes: int) -> PlateRods:
        """The rods on a plate with so many nodes."""
        bound, size = [], 5 * nodes
        for one in rods:
            edge = EDGES[one.edge]
            aside = size + np.arange(2 * len(one.line)).reshape(-1, 2)
            numbers = np.full((len(one.nodes), 9, 3), -1)
            numbers[:, :3] = 5 * one.nodes[:, :, None] + np.arange(3)
            numbers[:, 3:6, :2] = 5 * one.nodes[:, :, None] + 3 + np.arange(2)
            numbers[:, 6:, [edge.along_axis, 2]] = aside[one.places]
            bound.append(BoundRod(one, numbers.reshape(-1, 27), aside))
            size += aside.size
        return cls(tuple(bound))

    @property
    def rods(self) -> list[Rod]:
        return [one.rod for one in self.bound]

    @property
    def held(self) -> np.ndarray:
        """Which of the rods' own unknowns their bases hold."""
        held = [np.zeros(one.aside.shape, dtype=bool) for one in self.bound]
        for one, here in zip(self.bound, held, strict=True):
            if one.rod.base is not None:
                here[one.rod.base] = True
        return np.concatenate([np.zeros(0, dtype=bool), *(here.ravel() for here in held)])

    def stiffness(self, plate: csr_matrix) -> csr_matrix:
        """The plate's stiffness with the rods' added; the plate's own if there are none."""
        if not self.bound:
            return plate
        own = len(self.held)
        total = block_diag([plate, csr_matrix((own, own))], format="csr")
        for one in self.bound:
            matrix = np.einsum("esc,es,esd->ecd", one.operator, one.rod.stiffness, one.operator)
            free = (one.numbers[:, :, None] >= 0) & (one.numbers[:, None, :] >= 0)
            row, column = np.broadcast_arrays(one.numbers[:, :, None], one.numbers[:, None, :])
            total = total + coo_matrix((matrix[free], (row[free], column[free])), total.shape).tocsr()
        return total

    def force(self, plate: np.ndarray) -> np.ndarray:
        """The plate's nodal forces with the rods' weight and initial moments."""
        total = np.concatenate([plate, np.zeros(len(self.held))])
        for one in self.bound:
            pull, free = one.pull(np.zeros(len(total))).reshape(-1, 27), one.numbers >= 0
            np.subtract.at(total, one.numbers[free], pull[free])
        return total

    def energy(self, u: np.ndarray) -> float:
        """Strain energy [J] of all rods."""
        strains = ((one.rod, one.strain(u) - one.rod.intrinsic) for one in self.bound)
        return sum(0.5 * float(np.sum(rod.stiffness * strain**2)) for rod, strain in strains)

    def on_sheet(self, one: BoundRod, u: np.ndarray, unbalanced: np.ndarray) -> np.ndarray:
        """Force and couple (p, 6) [N, N·m] of a rod on the plate's nodes; unbalanced: held forces (n, 5)."""
        pull = np.zeros((2, len(one.rod.line), 3))
        of_sides = one.pull(u)
        np.add.at(pull[0], one.rod.places, -of_sides[:, :3])
        np.add.at(pull[1], one.rod.places, -of_sides[:, 3:6])
        if one.rod.base is not None:  # what holds the base reaches the sheet through the rod
            there = unbalanced[one.rod.line[one.rod.base]]
            pull[0, one.rod.base] += there[:3]
            pull[1, one.rod.base, :2] += there[3:]
        return np.concatenate([pull[0], np.cross(UP, pull[1])], axis=1)


def of_scene(scene: Scene, mesh: MeshQuad, element_nodes: np.ndarray, nodes: np.ndarray) -> PlateRods:
    """The rods of a scene on a plate with nodes at plan positions (n, 2) [m]; element_nodes: (m, 9)."""
    sides = rod.sides(scene, mesh, element_nodes, nodes)
    return PlateRods.on(rod.of_scene(scene, nodes, sides), len(nodes))


def exerted(
    scene: Scene,
    rods: PlateRods,
    supports: Supports,
    u: np.ndarray,
    unbalanced: np.ndarray,
    nodes: np.ndarray,
) -> tuple[dict[str, np.ndarray], np.ndarray]:
    """Name of an actuator → wrenches (segments, 6) on the flat sheet; the rods' line force (n, 3) [N/m].

    unbalanced: what holds the plate's fields (n, 5); nodes: plan positions (n, 2) [m].
    """
    found, line = {}, np.zeros((len(nodes), 3))
    for one in rods.bound:
        nodal, on = rods.on_sheet(one, u, unbalanced), one.rod.line
        flat, up = np.column_stack([nodes[on], np.zeros(len(on))]), np.tile(UP, (len(on), 1))
        wrench = actuator_forces.by_segment(one.rod, nodal, flat, up)
        found.update({name: wrench / len(one.rod.names) for name in one.rod.names})
        line[on] += actuator_forces.line_force(one.rod, nodal)[0]
    motions = [n for n, a in scene.named_actuators().items() if isinstance(a, EdgeMotion)]
    for name, moved in zip(motions, edge_motion.moved(supports), strict=True):
        found[name] = _of_motion(moved, unbalanced)
    return {name: found[name] for name in scene.named_actuators()}, line


def _of_motion(moved: MovedEdge, unbalanced: np.ndarray) -> np.ndarray:
    nodal = moved.part[:, None] * unbalanced[moved.nodes]
    force = nodal[:, :3]
    couple = np.column_stack([-nodal[:, 4], nodal[:, 3], np.zeros(len(nodal))])
    moment = np.cross(moved.arm, force) + couple
    return np.concatenate([force.sum(axis=0), moment.sum(axis=0)])[None]
