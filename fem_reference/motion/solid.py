"""The solid in motion: consistent mass ∫ ρ N N dV, positions alone, so that no constraint is curved."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from typing import Any

import numpy as np
from scipy.sparse import block_diag, csc_matrix, csr_matrix, identity

from fem_reference.motion.loads import factor_at
from fem_reference.motion.moving import MovingElements
from fem_reference.motion.plate import refuse_edge_motions
from fem_reference.motion.rods import MovingRods, components_of
from fem_reference.solid.element import Bricks, tangent
from fem_reference.solid.materials import LAWS
from fem_reference.solid.rods import on_columns
from fem_reference.solid.statics import discretise, inspected, judge, plan_mesh
from fem_reference.solid.supports import components, vectors
from fem_reference.surface import carried, loads, rod
from fem_reference.surface.bound_rods import BoundRods
from fem_reference.surface.loads import Follower
from fem_reference.surface.mesh import Elements, divisions
from fem_reference.surface.stretch import largest_stretch
from sheetbench.choices import STRAIN_LAW
from sheetbench.numerics.continuation.trace import trace_path
from sheetbench.numerics.direct import DirectSolver
from sheetbench.numerics.sparsity import Pattern
from sheetbench.scenes import FieldMesh, Scene, Status


class MovingSolid(MovingElements):
    """The solid of a scene in motion; q: displacements of all nodes, (n, levels, 3), then changes
    of the rods' own vectors."""

    model = "solid"
    element: Bricks

    def __init__(
        self,
        scene: Scene,
        elements: Elements = 16,
        layers: int = 1,
        law: str = STRAIN_LAW,
        clamp: str = "shell-like",
        grading: str = "edges",
    ):
        refuse_edge_motions(scene, self.model)
        super().__init__(scene)
        counts = divisions(scene.sheet, elements)
        self.label = f"solid {counts[0]} × {counts[1]} × {layers}"
        self.settings: dict[str, Any] = {"elements": list(counts), "grading": grading, "layers": layers}
        self.settings |= {"law": law, "clamp": clamp}
        self.conservative, self.any_strain = law == STRAIN_LAW, LAWS[law].stands_any_strain
        self._mesh = plan_mesh(scene, counts, grading)
        self._structure = structure = discretise(self._mesh, self.still, layers, law, clamp)
        self._columns, self.element = structure.columns, structure.bricks
        self._shape = self._columns.positions.shape
        self.nodes, self.unknowns = self._shape[0], structure.unknowns
        self._inertia = structure.inertia(carried.of_scene(scene, self._columns.plan))
        sites = (3 * self._columns.stacks[:, :, None] + np.arange(3)).reshape(len(self._inertia), -1)
        self._cut = self._columns.positions.size
        self.size = size = self._cut + structure.rods.own.size
        self.mass = Pattern(sites, size=size).matrix(self._inertia)
        self._bases = structure.supports.bases(1.0)
        of_columns = structure.supports.basis(1.0).tocsc()[:, np.flatnonzero(structure.free)]
        self._held_aside = np.repeat(structure.rods.held, 3)
        aside = identity(len(self._held_aside), format="csc")[:, ~self._held_aside]
        self._basis = block_diag([of_columns, aside], format="csc")
        plan, levels = self._columns.plan, self._columns.levels

        def bound(alone: Scene) -> BoundRods:
            return on_columns(rod.of_scene(alone, plan), self._columns)

        middles = levels * np.arange(3) + self._columns.layers
        places = np.concatenate([middles, 3 * levels + np.arange(6)])
        self.carry(MovingRods(scene, bound, components_of, size, places))
        self.load(scene, lambda alone: loads.of_scene(alone, plan))

    def equilibrium(self, scene: Scene) -> tuple[np.ndarray, Status, Sequence[str]]:
        structure = discretise(
            self._mesh, scene, self.settings["layers"], self.settings["law"], self.settings["clamp"]
        )
        path = trace_path(structure, DirectSolver(structure.symmetric), partial(inspected, structure))
        status, notes, _ = judge(scene, structure, path, self.settings["law"])
        return np.append(path.state.displacement, path.state.aside), status, notes

    def placed(self, q: np.ndarray, time: float) -> np.ndarray:
        target = self._structure.supports.target(1.0) + self._shift(time, rate=False)
        return self._holding(q, target)

    def rate_placed(self, q: np.ndarray, v: np.ndarray, time: float) -> np.ndarray:
        return self._holding(v, np.broadcast_to(self._shift(time, rate=True), self._shape))

    def _shift(self, time: float, rate: bool) -> np.ndarray:
        return self.shift(self._structure.supports.line.edges, time, rate)[:, None]

    def _holding(self, q: np.ndarray, target: np.ndarray) -> np.ndarray:
        """q with the held components of a target (n, levels, 3)."""
        gap = components(self._bases, target - self._on_sheet(q))
        step = vectors(self._bases, np.where(self._structure.free, 0.0, gap))
        aside = np.where(self._held_aside, 0.0, q[self._cut :])
        return np.append(self._on_sheet(q) + step, aside)

    def _on_sheet(self, q: np.ndarray) -> np.ndarray:
        """The sheet's part (n, levels, 3)."""
        return q[: self._cut].reshape(self._shape)

    def _padded(self, on_sheet: np.ndarray) -> np.ndarray:
        """Forces (N,) of those on the sheet (n, levels, 3)."""
        return np.pad(on_sheet.ravel(), (0, self.size - self._cut))

    def basis(self, q: np.ndarray) -> csc_matrix:
        return self._basis

    def tangent(
        self, q: np.ndarray, v: np.ndarray, time: float, residual: np.ndarray, by_a: float, by_v: float
    ) -> csr_matrix:
        self.memory.now, change = time, self.gather(q)
        self.grow(time)
        strain, rate = self.strained(change, v)
        moduli = (1.0 + by_v * self.tau + self.memory.gain) * self.element.moduli(strain)
        bricks = tangent(self.element.gradient(change), moduli, self.stress(strain, rate))
        stiffness = self._structure.stack(bricks) + (by_a + self.alpha * by_v) * self._inertia
        places = self._structure.surface(self._columns.positions + self._on_sheet(q))
        for load, factor in [*self.followers, *self.drag(v, by_v)]:
            on = load.elements
            stiffness[on] -= factor_at(factor, time) * self._structure.of_surface(load.tangent(places[on]))
        stiffness = self._structure.turn(stiffness, self._bases)
        if not self.rods:
            return self._structure.pattern.matrix(stiffness)
        onto = self._structure.onto_rods(self._bases)
        on_rods = onto.swapaxes(1, 2) @ self.rods.tangent(q, v, time, by_a, by_v) @ onto
        return self._structure.pattern.matrix(stiffness, on_rods)

    def inside_out(self, q: np.ndarray) -> str:
        ratio = self.element.volume_ratio(self.gather(q))
        return "a brick has turned inside out: use more elements" if np.any(ratio <= 0.0) else ""

    def stretch(self, q: np.ndarray) -> float:
        return largest_stretch(
            self._structure.mid_surface(0.0), self._structure.mid_surface(self._on_sheet(q))
        )

    def solver(self) -> DirectSolver:
        return DirectSolver(not self.followers)

    def on_coordinates(self, dead: np.ndarray) -> np.ndarray:
        """Uniform through the thickness."""
        return self._padded(self._columns.averages[0][:, None] * dead[:, None, :])

    def gather(self, q: np.ndarray) -> np.ndarray:
        return self._structure.of_bricks(self._on_sheet(q))

    def on_surface(self, v: np.ndarray) -> np.ndarray:
        return self._structure.surface(self._on_sheet(v))[:, :9]

    def scatter(self, pull: np.ndarray) -> np.ndarray:
        return self._padded(self._structure.scatter(pull))

    def following(self, q: np.ndarray, load: Follower) -> np.ndarray:
        return self._padded(self._structure.of_follower(self._on_sheet(q), load))

    def displacement(self, q: np.ndarray) -> np.ndarray:
        return self._on_sheet(q).reshape(-1, 3)

    def sample(self, displacement: np.ndarray, points: np.ndarray) -> np.ndarray:
        return self._columns.sample(displacement.reshape(self._shape), points)

    def reactions(self, exerted: np.ndarray) -> dict[str, np.ndarray]:
        return self._structure.supports.reactions(self._on_sheet(exerted), 1.0)

    def mesh(self, displacement: np.ndarray) -> FieldMesh:
        return self._columns.field_mesh(displacement.reshape(self._shape))
