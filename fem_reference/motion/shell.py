"""The shell in motion: positions and directors, of the kinetic energy of `shell.inertia`."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from scipy.sparse import csc_matrix, csr_matrix

from fem_reference.motion.loads import factor_at
from fem_reference.motion.moving import MovingElements
from fem_reference.motion.rods import MovingRods, components_of
from fem_reference.shell import inertia
from fem_reference.shell.directors import multiplier, projected
from fem_reference.shell.element import Element, add_tangents
from fem_reference.shell.state import State
from fem_reference.shell.statics import discretise, trace_on
from fem_reference.shell.structure import UP
from fem_reference.shell.validity import inverted, membrane_strain
from fem_reference.surface import loads, rod
from fem_reference.surface.bound_rods import BoundRods, on_surface
from fem_reference.surface.loads import Follower
from fem_reference.surface.location import interpolate
from fem_reference.surface.mesh import Elements, Plan, divisions, field_mesh, mesh_of
from sheetbench.choices import STRAIN_LAW
from sheetbench.numerics.direct import DirectSolver
from sheetbench.numerics.sparsity import add_blocks
from sheetbench.scenes import FieldMesh, Scene, Status
from sheetbench.scenes.kinematics import MovedEdge


class MovingShell(MovingElements):
    """The shell of a scene in motion; q: displacements and changes of directors d, then of the
    rods' m, (2 n + p, 3)."""

    model = "shell"
    element: Element

    def __init__(self, scene: Scene, elements: Elements = 16, graded: bool = True, law: str = STRAIN_LAW):
        super().__init__(scene)
        counts = divisions(scene.sheet, elements)
        graded = graded and scene.sheet.mesh is None
        self.label = f"shell {counts[0]} × {counts[1]}"
        self.settings: dict[str, Any] = {"elements": list(counts), "graded": graded, "law": law}
        self.conservative = law == STRAIN_LAW
        self._plan = mesh_of(scene, counts, graded)
        self._structure, self._nodes = discretise(self._plan, self.still, law=law)
        structure = self._structure
        self.any_strain = structure.element.stands_any_strain
        self.element, self._on, self.nodes = structure.element, structure.element_nodes, structure.count
        turns = np.concatenate([structure.supports.director, structure.rods.held])
        self._held = np.concatenate([structure.supports.position, np.tile(turns, (3, 1)).T])
        self._upright = np.concatenate([np.tile(UP, (self.nodes, 1)), structure.rods.own])
        plan = Plan(self._plan, self._on, self._nodes)
        by_place, self._on_turns = products = inertia.products(structure, scene, plan)
        self.mass = inertia.mass(structure, products)
        self._on_places = np.einsum("eij,ab->eiajb", by_place, np.eye(3)).reshape(-1, 27, 27)
        self.unknowns, self._basis = structure.unknowns, inertia.Basis(structure)

        def bound(alone: Scene) -> BoundRods:
            return on_surface(rod.of_scene(alone, plan), self.nodes)

        self.carry(MovingRods(scene, bound, components_of, self._held.size))
        self.load(scene, lambda alone: loads.of_scene(alone, plan))
        moved = structure.supports.moved.values()
        self._edges = [(d.edge, d.nodes, d.points) for d in moved if isinstance(d.edge, MovedEdge)]

    def equilibrium(self, scene: Scene) -> tuple[np.ndarray, Status, Sequence[str]]:
        structure, _ = discretise(self._plan, scene, law=self.settings["law"])
        state, status, notes = trace_on(scene, structure)
        return np.append(state.change, state.aside), status, notes

    def placed(self, q: np.ndarray, time: float) -> np.ndarray:
        supports = self._structure.supports
        target, n = np.zeros(self._held.shape), self.nodes
        target[: 2 * n] = supports.change(1.0).reshape(-1, 3)
        target[:n] += self.shift(supports.edges, time, rate=False)
        for edge, nodes, points in self._edges:
            placed = edge.placed(points, 1.0, time)
            target[nodes], target[n + nodes] = placed.displacement, placed.director
        return self._of_unit_directors(np.where(self._held, target, q.reshape(target.shape)))

    def rate_placed(self, q: np.ndarray, v: np.ndarray, time: float) -> np.ndarray:
        rate = np.where(self._held, 0.0, v.reshape(self._held.shape))
        rate[: self.nodes] += self.shift(self._structure.supports.edges, time, rate=True)
        for edge, nodes, points in self._edges:
            low, high = (edge.velocity(points, np.full(len(points), at), time) for at in (0.0, 1.0))
            rate[nodes], rate[self.nodes + nodes] = low, high - low
        directors, turns = self._directors(q), rate[self.nodes :]
        turns -= np.einsum("nc,nc->n", turns, directors)[:, None] * directors
        return rate.ravel()

    def centripetal(self, q: np.ndarray, v: np.ndarray) -> np.ndarray:
        """−|ḋ|² d of the directors that are free."""
        rate = v.reshape(-1, 3)[self.nodes :]
        inward = -np.sum(rate**2, axis=1)[:, None] * self._directors(q)
        turns = np.where(self._held[self.nodes :], 0.0, inward)
        return np.append(np.zeros((self.nodes, 3)), turns)

    def basis(self, q: np.ndarray) -> csc_matrix:
        return self._basis.at(self._frames(q))

    def on_coordinates(self, dead: np.ndarray) -> np.ndarray:
        """Dead forces turn no director."""
        return np.pad(dead.ravel(), (0, self._held.size - dead.size))

    def following(self, q: np.ndarray, load: Follower) -> np.ndarray:
        return self._structure.of_follower(self.element.reference + self.gather(q), load).ravel()

    def gather(self, q: np.ndarray) -> np.ndarray:
        return self._structure.gather(q)

    def on_surface(self, v: np.ndarray) -> np.ndarray:
        return self.gather(v)[:, :9]

    def scatter(self, pull: np.ndarray) -> np.ndarray:
        return self._structure.scatter(pull).ravel()

    def of_supports(self, exerted: np.ndarray) -> np.ndarray:
        """Along directors that are free M ü + g is what keeps them unit vectors."""
        return np.where(self._held.ravel(), exerted, 0.0)

    def inside_out(self, q: np.ndarray) -> str:
        fault = inverted(self._structure, self._state(q))
        return "" if fault is None else fault.message

    def stretch(self, q: np.ndarray) -> float:
        return membrane_strain(self._structure, self._state(q))

    def tangent(
        self, q: np.ndarray, v: np.ndarray, time: float, residual: np.ndarray, by_a: float, by_v: float
    ) -> csr_matrix:
        self.memory.now, change = time, self.gather(q)
        self.grow(time)
        vectors, (strain, rate) = self.element.reference + change, self.strained(change, v)
        moduli = (1.0 + by_v * self.tau + self.memory.gain) * self.element.moduli(strain)
        frames = self._frames(q)
        along = multiplier(self._directors(q), residual.reshape(-1, 3)[self.nodes :])
        on_turns = self._structure.of_unknowns(np.zeros((self.nodes, 3)), np.tile(along, (2, 1)).T)
        pattern = self._structure.pattern
        data, slots = pattern.zeros(on_turns), pattern.slots[0]
        add_tangents(data, slots, self.element, vectors, moduli, self.stress(strain, rate), self._on, frames)
        of_elements, share = frames[self._on], by_a + self.alpha * by_v
        blocks = np.zeros(slots.shape)
        blocks[:, :27, :27] = share * self._on_places
        weighed = np.einsum("ceij,ejcb->eicjb", self._on_turns, of_elements)
        turned = share * np.einsum("eica,eicjb->eiajb", of_elements, weighed)
        blocks[:, 27:, 27:] = turned.reshape(-1, 18, 18)
        for follower, factor in [*self.followers, *self.drag(v, by_v)]:
            on = follower.elements
            by_shape = projected(follower.tangent(vectors[on]), of_elements[on])
            blocks[on] -= factor_at(factor, time) * by_shape
        add_blocks(data, slots, blocks)
        if self.rods:
            onto, sides = self._structure.onto_rods(frames), self.rods.tangent(q, v, time, by_a, by_v)
            add_blocks(data, pattern.slots[1], onto.swapaxes(1, 2) @ sides @ onto)
        return pattern.with_data(data)

    def moved(self, q: np.ndarray, step: np.ndarray) -> np.ndarray:
        return self._of_unit_directors((q + step).reshape(-1, 3))

    def _of_unit_directors(self, change: np.ndarray) -> np.ndarray:
        """q (N,) of changes (2 n + p, 3) with those directors that are free brought to unit length."""
        turns = change[self.nodes :]
        directors = turns + self._upright
        unit = directors / np.linalg.norm(directors, axis=1)[:, None] - self._upright
        return np.append(change[: self.nodes], np.where(self._held[self.nodes :], turns, unit))

    def solver(self) -> DirectSolver:
        return DirectSolver(all(f.conservative for f, _ in self.followers), self._structure.fronts)

    def displacement(self, q: np.ndarray) -> np.ndarray:
        return q.reshape(-1, 3)[: self.nodes]

    def sample(self, displacement: np.ndarray, points: np.ndarray) -> np.ndarray:
        return interpolate(self._plan, self._on, displacement, points)

    def reactions(self, exerted: np.ndarray) -> dict[str, np.ndarray]:
        return self._structure.supports.reactions(self.displacement(exerted))

    def mesh(self, displacement: np.ndarray) -> FieldMesh:
        return field_mesh(self._nodes, self._on, displacement, np.tile(UP, (self.nodes, 1)))

    def _directors(self, q: np.ndarray) -> np.ndarray:
        return q.reshape(-1, 3)[self.nodes :] + self._upright

    def _frames(self, q: np.ndarray) -> np.ndarray:
        return self._structure.frames(self._state(q))

    def _state(self, q: np.ndarray) -> State:
        vectors, cut = q.reshape(-1, 3), 2 * self.nodes
        return State(vectors[:cut].reshape(2, -1, 3), vectors[cut:])
