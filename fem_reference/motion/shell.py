"""The shell in motion: positions and directors, kinetic energy ½ ρh |u̇|² + ½ ρh³/12 |ḋ|² per area."""

from __future__ import annotations

from typing import Any

import numpy as np
from scipy.sparse import block_diag, csc_matrix, csr_matrix, kron

from fem_reference.motion.loads import factor_at
from fem_reference.motion.sheet import Sheet
from fem_reference.shell.directors import multiplier
from fem_reference.shell.element import add_tangents, forces_of, strain_of, weighed
from fem_reference.shell.reduction import projected
from fem_reference.shell.state import State
from fem_reference.shell.statics import discretise, field_mesh, trace_on
from fem_reference.shell.structure import UP
from fem_reference.surface import loads
from fem_reference.surface.biquadratic import AT_GAUSS
from fem_reference.surface.loads import Follower
from fem_reference.surface.location import interpolate
from fem_reference.surface.mesh import Elements, divisions, mesh_of
from sheetbench.choices import STRAIN_LAW
from sheetbench.numerics.direct import DirectSolver
from sheetbench.numerics.sparsity import add_blocks
from sheetbench.scenes import FieldMesh, Scene
from sheetbench.scenes.kinematics import MovedEdge, bent_or_tilted


class MovingShell(Sheet):
    """The shell of a scene in motion; q: displacements and changes of directors, (2, n, 3)."""

    model = "shell"

    def __init__(self, scene: Scene, elements: Elements = 16, graded: bool = True, law: str = STRAIN_LAW):
        super().__init__(scene)
        counts = divisions(scene.sheet, elements)
        self.label = f"shell {counts[0]} × {counts[1]}"
        self.settings: dict[str, Any] = {"elements": list(counts), "graded": graded, "law": law}
        self.conservative = law == STRAIN_LAW
        self._plan = mesh_of(scene, counts, graded)
        self._structure, self._nodes = discretise(self._plan, self.still, law=law)
        structure, thickness = self._structure, scene.sheet.thickness
        self._element, self._on, self._n = structure.element, structure.element_nodes, structure.count
        self._held = np.array([structure.supports.position, np.zeros((self._n, 3), bool)])
        self._held[1] = structure.supports.director[:, None]
        self._set_mass(scene.material.density * thickness, thickness**2 / 12.0)
        self.unknowns = structure.unknowns
        self._set_basis()
        self.load(scene, lambda alone: loads.of_scene(alone, self._plan, self._on, self._nodes))
        moved = structure.supports.moved.values()
        self._edges = [(d.edge, d.nodes, d.points) for d in moved if isinstance(d.edge, MovedEdge)]

    def _set_mass(self, per_area: float, rotary: float) -> None:
        value = AT_GAUSS[0]
        products = np.einsum("eg,gi,gj->eij", per_area * self._element.areas, value, value)
        rows, columns = np.repeat(self._on, 9, axis=1).ravel(), np.tile(self._on, (1, 9)).ravel()
        of_nodes = csr_matrix((products.ravel(), (rows, columns)), (self._n, self._n))
        by_axis = kron(of_nodes, np.eye(3))
        self.mass = block_diag([by_axis, rotary * by_axis], format="csr")
        self._on_places = np.einsum("eij,ab->eiajb", products, np.eye(3)).reshape(-1, 27, 27)
        self._on_turns = rotary * products

    def _set_basis(self) -> None:
        """Where the entries of Z lie: a column has one of a displacement, three of a rotation."""
        number = self._structure.number
        node, field = np.nonzero(number >= 0)  # in the order of the unknowns
        self._turn = node[field >= 3], field[field >= 3] - 3
        widths = np.where(field < 3, 1, 3)
        self._starts = np.concatenate([[0], np.cumsum(widths)])
        rows = np.where(field < 3, 3 * node + field, 3 * (self._n + node))
        within = np.arange(self._starts[-1]) - np.repeat(self._starts[:-1], widths)
        self._rows, self._turning = np.repeat(rows, widths) + within, np.repeat(field >= 3, widths)

    def start(self) -> np.ndarray:
        """As `Moving` has it."""
        state = self._structure.rest()
        if bent_or_tilted(self.still.supports, self.still.sheet):
            state, _, _ = trace_on(self.still, self._structure)
        return self.placed(state.change.ravel(), 0.0)

    def placed(self, q: np.ndarray, time: float) -> np.ndarray:
        """As `Moving` has it."""
        supports = self._structure.supports
        target = supports.change(1.0)
        target[0] += self.shift(supports.edges, time, rate=False)
        for edge, nodes, points in self._edges:
            placed = edge.placed(points, 1.0, time)
            target[0, nodes], target[1, nodes] = placed.displacement, placed.director
        change = np.where(self._held, target, q.reshape(target.shape))
        directors = change[1] + UP
        unit = directors / np.linalg.norm(directors, axis=1)[:, None] - UP
        change[1] = np.where(self._held[1], change[1], unit)
        return change.ravel()

    def rate_placed(self, q: np.ndarray, v: np.ndarray, time: float) -> np.ndarray:
        """As `Moving` has it."""
        rate = np.where(self._held, 0.0, v.reshape(self._held.shape))
        rate[0] += self.shift(self._structure.supports.edges, time, rate=True)
        for edge, nodes, points in self._edges:
            low, high = (edge.velocity(points, np.full(len(points), at), time) for at in (0.0, 1.0))
            rate[0, nodes], rate[1, nodes] = low, high - low
        directors = self._directors(q)
        rate[1] -= np.einsum("nc,nc->n", rate[1], directors)[:, None] * directors
        return rate.ravel()

    def centripetal(self, q: np.ndarray, v: np.ndarray) -> np.ndarray:
        """−|ḋ|² d of the directors that are free."""
        rate = v.reshape(self._held.shape)[1]
        inward = -np.sum(rate**2, axis=1)[:, None] * self._directors(q)
        return np.array([np.zeros_like(rate), np.where(self._held[1], 0.0, inward)]).ravel()

    def basis(self, q: np.ndarray) -> csc_matrix:
        """As `Moving` has it."""
        data = np.ones(len(self._rows))
        node, tangent = self._turn
        data[self._turning] = self._frames(q)[node, :, tangent].ravel()
        return csc_matrix((data, self._rows, self._starts), (6 * self._n, self.unknowns))

    @property
    def nodes(self) -> int:
        """As `Sheet` has it."""
        return self._n

    def on_coordinates(self, dead: np.ndarray) -> np.ndarray:
        """As `Sheet` has it: dead forces turn no director."""
        return np.array([dead, np.zeros_like(dead)]).ravel()

    def internal(self, q: np.ndarray, v: np.ndarray) -> np.ndarray:
        """As `Sheet` has it."""
        vectors, strain, rate = self._strained(q, v)
        return self._scattered(forces_of(vectors, self._stress(strain, rate)))

    def mean_internal(self, start: np.ndarray, end: np.ndarray, h: float) -> np.ndarray:
        """As `Sheet` has it."""
        before, after = (self._structure.gather(q.reshape(2, -1, 3)) for q in (start, end))
        strains = [self._element.strain(change) for change in (before, after)]
        stress = self._stress(0.5 * (strains[0] + strains[1]), (strains[1] - strains[0]) / h)
        return self._scattered(forces_of(self._element.reference + 0.5 * (before + after), stress))

    def following(self, q: np.ndarray, load: Follower) -> np.ndarray:
        """As `Sheet` has it."""
        vectors = self._element.reference + self._structure.gather(q.reshape(2, -1, 3))
        on_elements = np.zeros_like(vectors)
        on_elements[load.elements] = load.force(vectors[load.elements])
        return self._scattered(on_elements)

    def of_supports(self, exerted: np.ndarray) -> np.ndarray:
        """As `Sheet` has it; along directors that are free M ü + g is what keeps them unit vectors."""
        return np.where(self._held.ravel(), exerted, 0.0)

    def elastic(self, q: np.ndarray) -> float:
        """As `Sheet` has it."""
        strain = self._element.strain(self._structure.gather(q.reshape(2, -1, 3)))
        return sum(self._element.energies(strain).values())

    def stiffness_of(self, q: np.ndarray, step: np.ndarray) -> float:
        """As `Sheet` has it."""
        _, strain, change = self._strained(q, step)
        return float(np.sum(change * weighed(self._element.moduli(strain), change)))

    def tangent(
        self, q: np.ndarray, v: np.ndarray, time: float, residual: np.ndarray, by_a: float, by_v: float
    ) -> csr_matrix:
        """As `Moving` has it."""
        vectors, strain, rate = self._strained(q, v)
        moduli, frames = (1.0 + by_v * self.tau) * self._element.moduli(strain), self._frames(q)
        along = multiplier(self._directors(q), residual.reshape(2, -1, 3)[1])
        number, pattern = self._structure.number, self._structure.pattern
        on_turns = np.zeros(number.shape)
        on_turns[:, 3:] = along[:, None]
        data, slots = pattern.zeros(on_turns[number >= 0]), pattern.slots[0]
        stress = self._stress(strain, rate)
        add_tangents(data, slots, self._element, vectors, moduli, stress, self._on, frames)
        of_elements, inertia = frames[self._on], by_a + self.alpha * by_v
        blocks = np.zeros(slots.shape)
        blocks[:, :27, :27] = inertia * self._on_places
        turned = np.einsum("eica,ejcb->eiajb", of_elements, of_elements)
        turned *= inertia * self._on_turns[:, :, None, :, None]
        blocks[:, 27:, 27:] = turned.reshape(-1, 18, 18)
        for follower, factor in self.followers:
            on = follower.elements
            by_shape = projected(follower.tangent(vectors[on]), of_elements[on])
            blocks[on] -= factor_at(factor, time) * by_shape
        add_blocks(data, slots, blocks)
        return pattern.with_data(data)

    def moved(self, q: np.ndarray, step: np.ndarray) -> np.ndarray:
        """As `Moving` has it."""
        change = (q + step).reshape(2, -1, 3)
        directors = change[1] + UP
        directors = directors / np.linalg.norm(directors, axis=1)[:, None]
        change[1] = np.where(self._held[1], change[1], directors - UP)
        return change.ravel()

    def solver(self) -> DirectSolver:
        """As `Moving` has it."""
        return DirectSolver(all(f.conservative for f, _ in self.followers), self._structure.fronts)

    def displacement(self, q: np.ndarray) -> np.ndarray:
        """As `Moving` has it."""
        return q.reshape(2, -1, 3)[0]

    def sample(self, displacement: np.ndarray, points: np.ndarray) -> np.ndarray:
        """As `Moving` has it."""
        return interpolate(self._plan, self._on, displacement, points)

    def reactions(self, exerted: np.ndarray) -> dict[str, np.ndarray]:
        """As `Moving` has it."""
        return self._structure.supports.reactions(exerted.reshape(2, -1, 3)[0])

    def mesh(self, displacement: np.ndarray) -> FieldMesh:
        """As `Moving` has it."""
        upright = np.tile(UP, (self._n, 1))
        return field_mesh(self._nodes, self._on, displacement, upright)

    def _strained(self, q: np.ndarray, v: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Of the elements Q (m, 18, 3), strains and their rates (m, 54)."""
        change = self._structure.gather(q.reshape(2, -1, 3))
        vectors = self._element.reference + change
        rate = strain_of(vectors, self._structure.gather(v.reshape(2, -1, 3)))
        return vectors, self._element.strain(change), rate

    def _stress(self, strain: np.ndarray, rate: np.ndarray) -> np.ndarray:
        elastic = self._element.stress(strain)
        return elastic + self.tau * weighed(self._element.moduli(strain), rate) if self.tau else elastic

    def _scattered(self, on_elements: np.ndarray) -> np.ndarray:
        both = np.concatenate([self._on, self._n + self._on], axis=1)
        components = (3 * both.ravel()[:, None] + np.arange(3)).ravel()
        return np.bincount(components, on_elements.ravel(), 6 * self._n)

    def _directors(self, q: np.ndarray) -> np.ndarray:
        return q.reshape(2, -1, 3)[1] + UP

    def _frames(self, q: np.ndarray) -> np.ndarray:
        return self._structure.frames(State(q.reshape(2, -1, 3)))
