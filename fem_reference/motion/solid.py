"""The solid in motion: consistent mass ∫ ρ N N dV, positions alone, so that no constraint is curved."""

from __future__ import annotations

from typing import Any

import numpy as np
from scipy.sparse import bsr_matrix, csc_matrix, csr_matrix

from fem_reference.motion.loads import factor_at
from fem_reference.motion.plate import refuse_edge_motions
from fem_reference.motion.sheet import Sheet
from fem_reference.solid.element import geometric
from fem_reference.solid.statics import discretise, plan_mesh
from fem_reference.solid.supports import components, vectors
from fem_reference.solving.equilibrium import trace
from fem_reference.surface import loads
from fem_reference.surface.loads import Follower
from fem_reference.surface.mesh import Elements, divisions
from sheetbench.choices import STRAIN_LAW
from sheetbench.numerics.direct import DirectSolver
from sheetbench.scenes import FieldMesh, Scene
from sheetbench.scenes.kinematics import bent_or_tilted


class MovingSolid(Sheet):
    """The solid of a scene in motion; q: displacements of all nodes, (n, levels, 3)."""

    model = "solid"

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
        self.conservative = law == STRAIN_LAW
        self._structure = structure = discretise(
            plan_mesh(scene, counts, grading), self.still, layers, law, clamp
        )
        self._columns, self._bricks = structure.columns, structure.bricks
        self.unknowns = structure.unknowns
        self._shape = self._columns.positions.shape
        products = scene.material.density * self._bricks.products()
        self._inertia = structure.stack(np.einsum("eij,cd->eicjd", products, np.eye(3)))
        stacks = self._columns.stacks
        width = 3 * stacks.shape[1]
        sites = (3 * stacks[:, :, None] + np.arange(3)).reshape(len(stacks), width)
        rows, columns = np.repeat(sites, width, axis=1).ravel(), np.tile(sites, (1, width)).ravel()
        size = self._columns.positions.size
        self.mass = csr_matrix((self._inertia.ravel(), (rows, columns)), (size, size))
        self._bases = structure.supports.bases(1.0)
        blocks = np.arange(len(self._bases) + 1)
        whole = bsr_matrix((self._bases, blocks[:-1], blocks)).tocsc()
        self._basis = whole[:, np.flatnonzero(structure.free)]
        plan = self._columns.plan
        of_plan = self._columns.plan_elements, self._columns.plan_nodes
        self.load(scene, lambda alone: loads.of_scene(alone, plan.mesh, *of_plan))

    def start(self) -> np.ndarray:
        """As `Moving` has it."""
        if not bent_or_tilted(self.still.supports, self.still.sheet):
            return self.placed(np.zeros(self._columns.positions.size), 0.0)
        path = trace(self._structure, DirectSolver(self._structure.symmetric))
        return self.placed(path.state.displacement.ravel(), 0.0)

    def placed(self, q: np.ndarray, time: float) -> np.ndarray:
        """As `Moving` has it."""
        target = self._structure.supports.target(1.0) + self._shift(time, rate=False)
        return self._holding(q, target)

    def rate_placed(self, q: np.ndarray, v: np.ndarray, time: float) -> np.ndarray:
        """As `Moving` has it."""
        return self._holding(v, np.broadcast_to(self._shift(time, rate=True), self._shape))

    def _shift(self, time: float, rate: bool) -> np.ndarray:
        return self.shift(self._structure.supports.line.edges, time, rate)[:, None]

    def _holding(self, q: np.ndarray, target: np.ndarray) -> np.ndarray:
        """q with the held components of a target (n, levels, 3)."""
        gap = components(self._bases, target - q.reshape(self._shape))
        step = vectors(self._bases, np.where(self._structure.free, 0.0, gap))
        return q + step.ravel()

    def basis(self, q: np.ndarray) -> csc_matrix:
        """As `Moving` has it."""
        return self._basis

    def tangent(
        self, q: np.ndarray, v: np.ndarray, time: float, residual: np.ndarray, by_a: float, by_v: float
    ) -> csr_matrix:
        """As `Moving` has it."""
        gradient, strain, rate = self._strained(q, v)
        flat = gradient.reshape(*gradient.shape[:2], -1)
        moduli = (1.0 + by_v * self.tau) * self._bricks.stiffness(strain)
        bricks = (flat.swapaxes(1, 2) @ (moduli @ flat)).reshape(len(flat), -1, 3, flat.shape[2] // 3, 3)
        form = geometric(self._stress(strain, rate))
        for axis in range(3):
            bricks[:, :, axis, :, axis] += form
        stiffness = self._structure.stack(bricks) + (by_a + self.alpha * by_v) * self._inertia
        places = self._structure.surface(self._columns.positions + q.reshape(self._shape))
        for load, factor in self.followers:
            on = load.elements
            stiffness[on] -= factor_at(factor, time) * self._structure.of_surface(load.tangent(places[on]))
        return self._structure.pattern.matrix(self._structure.turn(stiffness, self._bases))

    def solver(self) -> DirectSolver:
        """As `Moving` has it."""
        return DirectSolver(not self.followers)

    @property
    def nodes(self) -> int:
        """As `Sheet` has it."""
        return self._shape[0]

    def on_coordinates(self, dead: np.ndarray) -> np.ndarray:
        """As `Sheet` has it: uniform through the thickness."""
        return (self._columns.averages[0][:, None] * dead[:, None, :]).ravel()

    def internal(self, q: np.ndarray, v: np.ndarray) -> np.ndarray:
        """As `Sheet` has it."""
        gradient, strain, rate = self._strained(q, v)
        pull = np.einsum("ekic,ek->eic", gradient, self._stress(strain, rate))
        return self._structure.scatter(pull).ravel()

    def mean_internal(self, start: np.ndarray, end: np.ndarray, h: float) -> np.ndarray:
        """As `Sheet` has it."""
        before, after = (self._structure.of_bricks(q.reshape(self._shape)) for q in (start, end))
        strains = [self._bricks.strain(change) for change in (before, after)]
        stress = self._stress(0.5 * (strains[0] + strains[1]), (strains[1] - strains[0]) / h)
        pull = np.einsum("ekic,ek->eic", self._bricks.gradient(0.5 * (before + after)), stress)
        return self._structure.scatter(pull).ravel()

    def following(self, q: np.ndarray, load: Follower) -> np.ndarray:
        """As `Sheet` has it."""
        return self._structure.of_follower(q.reshape(self._shape), load).ravel()

    def elastic(self, q: np.ndarray) -> float:
        """As `Sheet` has it."""
        change = self._structure.of_bricks(q.reshape(self._shape))
        return sum(self._bricks.energies(self._bricks.strain(change)))

    def stiffness_of(self, q: np.ndarray, step: np.ndarray) -> float:
        """As `Sheet` has it."""
        _, strain, change = self._strained(q, step)
        return float(np.einsum("ek,ekl,el->", change, self._bricks.stiffness(strain), change, optimize=True))

    def displacement(self, q: np.ndarray) -> np.ndarray:
        """As `Moving` has it."""
        return q.reshape(-1, 3)

    def sample(self, displacement: np.ndarray, points: np.ndarray) -> np.ndarray:
        """As `Moving` has it."""
        return self._columns.sample(displacement.reshape(self._shape), points)

    def reactions(self, exerted: np.ndarray) -> dict[str, np.ndarray]:
        """As `Moving` has it."""
        return self._structure.supports.reactions(exerted.reshape(self._shape), 1.0)

    def mesh(self, displacement: np.ndarray) -> FieldMesh:
        """As `Moving` has it."""
        return self._columns.field_mesh(displacement.reshape(self._shape))

    def _strained(self, q: np.ndarray, v: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Of the bricks B (m, k, 27, 3), strains and their rates (m, k)."""
        change, rates = (self._structure.of_bricks(x.reshape(self._shape)) for x in (q, v))
        gradient = self._bricks.gradient(change)
        return gradient, self._bricks.strain(change), np.einsum("ekic,eic->ek", gradient, rates)

    def _stress(self, strain: np.ndarray, rate: np.ndarray) -> np.ndarray:
        elastic = self._bricks.stress(strain)
        if not self.tau:
            return elastic
        return elastic + self.tau * np.einsum("ekl,el->ek", self._bricks.stiffness(strain), rate)
