"""The linear plate in motion: M ü + (τ K + α M) u̇ + K u = F(t), loads on the flat sheet."""

from __future__ import annotations

from typing import Any

import numpy as np
from scipy.sparse import csc_matrix, csr_matrix, identity

from fem_reference.motion.moving import Moving
from fem_reference.plate import statics as plate
from fem_reference.surface import loads
from fem_reference.surface.loads import Follower
from fem_reference.surface.mesh import Elements, divisions, mesh_of
from sheetbench.errors import BadInput
from sheetbench.numerics.direct import DirectSolver, solve_free
from sheetbench.scenes import EdgeMotion, FieldMesh, Scene


class MovingPlate(Moving):
    """The plate of a scene in motion; q: ux, uy, w and the director's tilts, (n, 5)."""

    model, conservative = "plate", True

    def __init__(self, scene: Scene, elements: Elements = 16, graded: bool | None = None):
        refuse_edge_motions(scene, self.model)
        super().__init__(scene)
        counts = divisions(scene.sheet, elements)
        graded = bool(scene.twisting_edges()) if graded is None else graded
        self.label = f"plate {counts[0]} × {counts[1]}"
        self.settings: dict[str, Any] = {"elements": list(counts), "graded": graded}
        self._plate = plate.Plate.on(mesh_of(scene, counts, graded))
        self._supports, self._held, self._values = plate.constrain(self.still, self._plate)
        self._stiffness = plate.stiffness_matrix(scene, self._plate)
        self.mass = plate.mass_matrix(scene, self._plate)
        self._free = np.flatnonzero(~self._held)
        self.nodes, self.unknowns = len(self._held), len(self._free)
        self._basis = identity(self._held.size, format="csc")[:, self._free]
        mesh, nodes = self._plate.basis.mesh, self._plate.nodes
        self.load(scene, lambda alone: loads.of_scene(alone, mesh, self._plate.elements.nodes, nodes))

    def start(self) -> np.ndarray:
        values = self._values.ravel()
        return self.placed(solve_free(self._stiffness, np.zeros_like(values), values, self._free), 0.0)

    def placed(self, q: np.ndarray, time: float) -> np.ndarray:
        target = self._values.copy()
        target[:, :3] += self.shift(self._supports.edges, time, rate=False)
        return np.where(self._held, target, q.reshape(-1, 5)).ravel()

    def rate_placed(self, q: np.ndarray, v: np.ndarray, time: float) -> np.ndarray:
        target = np.zeros_like(self._values)
        target[:, :3] = self.shift(self._supports.edges, time, rate=True)
        return np.where(self._held, target, v.reshape(-1, 5)).ravel()

    def basis(self, q: np.ndarray) -> csc_matrix:
        return self._basis

    def tangent(
        self, q: np.ndarray, v: np.ndarray, time: float, residual: np.ndarray, by_a: float, by_v: float
    ) -> csr_matrix:
        whole = (by_a + self.alpha * by_v) * self.mass + (1.0 + self.tau * by_v) * self._stiffness
        return whole[self._free][:, self._free]

    def solver(self) -> DirectSolver:
        return DirectSolver()

    def on_coordinates(self, dead: np.ndarray) -> np.ndarray:
        return np.column_stack([dead, np.zeros((len(dead), 2))]).ravel()

    def internal(self, q: np.ndarray, v: np.ndarray) -> np.ndarray:
        return np.asarray(self._stiffness @ (q + self.tau * v))

    def following(self, q: np.ndarray, load: Follower) -> np.ndarray:
        """On the flat sheet."""
        return plate.on_flat_sheet(self._plate, [load]).ravel()

    def elastic(self, q: np.ndarray) -> float:
        return 0.5 * self.stiffness_of(q, q)

    def stiffness_of(self, q: np.ndarray, step: np.ndarray) -> float:
        return float(step @ (self._stiffness @ step))

    def displacement(self, q: np.ndarray) -> np.ndarray:
        return q.reshape(-1, 5)[:, :3]

    def sample(self, displacement: np.ndarray, points: np.ndarray) -> np.ndarray:
        return self._plate.sample(displacement, points)

    def reactions(self, exerted: np.ndarray) -> dict[str, np.ndarray]:
        return self._supports.reactions(exerted.reshape(-1, 5)[:, :3])

    def mesh(self, displacement: np.ndarray) -> FieldMesh:
        flat = np.column_stack([displacement, np.zeros((len(displacement), 2))])
        return plate.field_mesh(self._plate, flat, {})


def refuse_edge_motions(scene: Scene, model: str) -> None:
    """Raise BadInput for an edge that an actuator moves: the shell alone moves it."""
    for name, actuator in scene.named_actuators().items():
        if isinstance(actuator, EdgeMotion):
            raise BadInput(f"actuator {name}: the {model} in motion has no edge motions; the shell has")
