"""The linear plate in motion: M ü + (τ K + α M) u̇ + K u = F(t), loads and drag on the flat sheet."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from scipy.sparse import csc_matrix, csr_matrix, identity

from fem_reference.motion.moving import Moving
from fem_reference.motion.relaxation import Strained
from fem_reference.motion.rods import MovingRods
from fem_reference.plate import statics as plate
from fem_reference.plate.rods import PlateRods
from fem_reference.plate.validity import TURN_LIMIT, strained
from fem_reference.surface import loads, rod
from fem_reference.surface.bound_rods import BoundRods, on_surface
from fem_reference.surface.loads import Follower
from fem_reference.surface.mesh import Elements, divisions, field_mesh, mesh_of
from sheetbench.errors import BadInput
from sheetbench.numerics.direct import DirectSolver
from sheetbench.scenes import EdgeMotion, FieldMesh, Scene, Status, outside_model


class MovingPlate(Moving):
    """The plate of a scene in motion; q: ux, uy, w and the director's tilts, (n, 5), then two
    components of every m of the rods."""

    model, conservative = "plate", True

    def __init__(self, scene: Scene, elements: Elements = 16, graded: bool | None = None):
        refuse_edge_motions(scene, self.model)
        super().__init__(scene)
        counts = divisions(scene.sheet, elements)
        graded = bool(scene.twisting_edges()) if graded is None else graded
        graded = graded and scene.sheet.mesh is None
        self.label = f"plate {counts[0]} × {counts[1]}"
        self.settings: dict[str, Any] = {"elements": list(counts), "graded": graded}
        self._plate = plate.Plate.on(mesh_of(scene, counts, graded))
        plan = self._plate.plan
        self.nodes = len(plan.nodes)

        def bound(alone: Scene) -> BoundRods:
            return on_surface(rod.of_scene(alone, plan), self.nodes)

        along = bound(self.still)
        rods = PlateRods.on(along, self.nodes)
        self._supports, held, values = plate.constrain(self.still, self._plate, rods=along.rods)
        self._held = np.concatenate([held.ravel(), rods.held])
        self._values = np.concatenate([values.ravel(), np.zeros(len(rods.held))])
        size = self._held.size
        self.mass = _widened(plate.mass_matrix(scene, self._plate), size)
        self.carry(MovingRods(scene, bound, lambda _: rods.unknowns, size, linear=True))
        self._stiffness = _widened(plate.stiffness_matrix(scene, self._plate), size)
        self._natural = plate.natural_of(scene, self._plate)
        self.grow(0.0)
        self._free = np.flatnonzero(~self._held)
        self.unknowns = len(self._free)
        self._basis = identity(size, format="csc")[:, self._free]
        self.load(scene, lambda alone: loads.of_scene(alone, plan))

    def equilibrium(self, scene: Scene) -> tuple[np.ndarray, Status, Sequence[str]]:
        return plate.equilibrium(scene, self._plate)

    def grow(self, time: float) -> None:
        state = self._natural.state
        factors = None if state is None else state.factors(time)
        self._pull = self._natural.force(self._held.size, factors)
        self._stored = self._natural.stored(factors)

    @property
    def grows(self) -> bool:
        return self._natural.moves

    def placed(self, q: np.ndarray, time: float) -> np.ndarray:
        return np.where(self._held, self._values + self._shift(time, rate=False), q)

    def rate_placed(self, q: np.ndarray, v: np.ndarray, time: float) -> np.ndarray:
        return np.where(self._held, self._shift(time, rate=True), v)

    def _shift(self, time: float, rate: bool) -> np.ndarray:
        return self.on_coordinates(self.shift(self._supports.edges, time, rate))

    def basis(self, q: np.ndarray) -> csc_matrix:
        return self._basis

    def tangent(
        self, q: np.ndarray, v: np.ndarray, time: float, residual: np.ndarray, by_a: float, by_v: float
    ) -> csr_matrix:
        self.memory.now = time
        whole = self._whole(by_a, by_v)
        for load, _ in self.drag(v, by_v):
            whole = whole - plate.tangent_on_flat_sheet(self._plate, load, self._held.size)
        return whole[self._free][:, self._free]

    def _whole(self, by_a: float, by_v: float) -> csr_matrix:
        """by_a M + by_v C + K of all coordinates."""
        sheet = (by_a + self.alpha * by_v) * self.sheet_mass + (
            1.0 + self.tau * by_v + self.memory.gain
        ) * self._stiffness
        if not self.rods:
            return sheet
        flat = np.zeros(self._held.size)
        return (sheet + self.rods.matrix(self.rods.tangent(flat, flat, 0.0, by_a, by_v))).tocsr()

    def stretch(self, q: np.ndarray) -> float:
        return strained(self._plate.elements, q)

    def beyond(self, stretch: float) -> str:
        if stretch > TURN_LIMIT:
            return f"slopes, turns or twice the strain of {stretch:.3g}, beyond 1: linear theory ends before"
        return outside_model(self._scene, 0.0)

    def solver(self) -> DirectSolver:
        return DirectSolver()

    def on_coordinates(self, dead: np.ndarray) -> np.ndarray:
        every = np.zeros(self._held.size)
        self.displacement(every)[:] = dead
        return every

    def internal(self, q: np.ndarray, v: np.ndarray) -> np.ndarray:
        elastic = self._stiffness @ q
        added = self.memory.added(elastic) if self.memory else 0.0
        return np.asarray(elastic + added + self.tau * (self._stiffness @ v) - self._pull)

    def strains(self, q: np.ndarray) -> Strained:
        return q, self._stiffness @ q

    def following(self, q: np.ndarray, load: Follower) -> np.ndarray:
        """On the flat sheet."""
        on_sheet = plate.on_flat_sheet(self._plate, [load]).ravel()
        return np.pad(on_sheet, (0, self._held.size - on_sheet.size))

    def on_surface(self, v: np.ndarray) -> np.ndarray:
        return self.displacement(v)[self._plate.elements.nodes]

    def elastic(self, q: np.ndarray) -> float:
        return 0.5 * self.stiffness_of(q, q, q) - float(self._pull @ q) + self._stored

    def stiffness_of(self, q: np.ndarray, step: np.ndarray, other: np.ndarray) -> float:
        return float(step @ (self._stiffness @ other))

    def displacement(self, q: np.ndarray) -> np.ndarray:
        return q[: 5 * self.nodes].reshape(-1, 5)[:, :3]

    def sample(self, displacement: np.ndarray, points: np.ndarray) -> np.ndarray:
        return self._plate.sample(displacement, points)

    def reactions(self, exerted: np.ndarray) -> dict[str, np.ndarray]:
        return self._supports.reactions(self.displacement(exerted))

    def mesh(self, displacement: np.ndarray) -> FieldMesh:
        up = np.tile([0.0, 0.0, 1.0], (len(displacement), 1))
        return field_mesh(self._plate.nodes, self._plate.elements.nodes, displacement, up)


def _widened(matrix: csr_matrix, size: int) -> csr_matrix:
    """A matrix with more rows and columns, zero."""
    pointers = np.pad(matrix.indptr, (0, size - matrix.shape[0]), "edge")
    return csr_matrix((matrix.data, matrix.indices, pointers), (size, size))


def refuse_edge_motions(scene: Scene, model: str) -> None:
    """Raise BadInput for an edge that an actuator moves: the shell alone moves it."""
    for name, actuator in scene.named_actuators().items():
        if isinstance(actuator, EdgeMotion):
            raise BadInput(f"actuator {name}: the {model} in motion has no edge motions; the shell has")
