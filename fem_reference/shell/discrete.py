"""Discrete shell: positions and directors, five unknowns a node.

Reissner and Mindlin's shell of large displacements and rotations, with the energy ½ h E:C:E + h³/24 κ:C:κ +
½ k h G γ·γ, k = 5/6, or the energy of another law (`laws`).

q: displacements u and changes d − e_z of the directors of all nodes, (2 n, 3), then changes of the rods' own
third director m, one more director at every node of their edges, (p, 3): in all 2 n + p vectors. Unknowns are
u and two tangent-plane components β of every director: δd = T β with T ⊥ d. The constraint |d|² = 1 is linear
in the step of statics,

    d · δd = ½ (1 − d · d),

and its multiplier, −(R_d · d)/(d · d), stiffens T (the curvature of the sphere). The kinetic energy per area
is ½ ρh |u̇|² + ½ ρh³/12 |ḋ|², with ∫ρz dz u̇·ḋ added for layers of different density.
"""

from collections.abc import Callable
from copy import copy
from functools import cached_property, partial
from typing import Any, ClassVar, Self

import numpy as np
from scipy.sparse import csc_matrix, csr_matrix, eye_array
from skfem import MeshQuad

from fem_reference.discrete.course import commands_of
from fem_reference.discrete.elements import DiscreteElements
from fem_reference.discrete.shape import SheetShape
from fem_reference.discrete.sheet import UP
from fem_reference.shell.directors import multiplier, projected, tangent_frames, to_unit
from fem_reference.shell.element import AT_SITES, OF_POSITIONS, TABLES, Element
from fem_reference.shell.hyperelastic import HyperelasticElement
from fem_reference.shell.laws import LAWS
from fem_reference.shell.natural import grown, natural_strains
from fem_reference.shell.tangent import add_tangents
from fem_reference.shell.validity import inverted, membrane_strain
from fem_reference.surface import rod
from fem_reference.surface import supports as surface_supports
from fem_reference.surface.actuator_forces import HoldingForces
from fem_reference.surface.biquadratic import AT_GAUSS
from fem_reference.surface.materials import Section, constants_of, section_at, stretched
from fem_reference.surface.mesh import plan_of, quarters
from fem_reference.surface.payloads import add_payloads
from fem_reference.surface.rod import block_diagonal
from fem_reference.surface.rubber import require_law
from fem_reference.surface.supports import Supports
from sheetbench.answers.solution import FieldMesh
from sheetbench.choices import STRAIN_LAW
from sheetbench.errors import BadInput
from sheetbench.numerics.sparsity import Pattern, add_blocks, pattern_of
from sheetbench.scenes import Scene, require_uniform
from sheetbench.scenes.meaning.natural_state import NaturalState, natural_at


class DiscreteShell(DiscreteElements):
    """Shell of a scene on a flat mesh, at rest unless it is moving. moves, turns: numbers of unknowns (n, 3)
    of every node and (n + p, 2) of every director, −1 where held."""

    model = "shell"
    norm: ClassVar[int] = 1
    creeps: ClassVar[bool] = True
    element: Element

    def __init__(
        self,
        mesh: MeshQuad,
        scene: Scene,
        section: Section | None = None,
        law: str = STRAIN_LAW,
        moving: bool = False,
    ):
        super().__init__(scene, moving)
        self.section, self.law = section, law
        self.plan = plan = plan_of(mesh)
        self.sites = self.both
        self.element, self.natural = self.elements_of(section, law)
        self.any_strain = LAWS[law].stands_any_strain
        n = self.nodes

        bound = self.bound_rods()
        self.supports = supports = rod.hold_bases(self.supports_of(), bound.rods)
        self.held, held = supports.position.ravel(), np.concatenate([supports.director, bound.held])
        turning = np.repeat(~held[:, None], 2, axis=1)
        turning[:n][supports.tilt.any(axis=1), 0] = False  # there the first tangent is the held axis
        is_free = np.concatenate([~self.held, turning.ravel()])
        numbered = np.where(is_free, np.cumsum(is_free) - 1, -1)
        self.moves, self.turns = numbered[: 3 * n].reshape(-1, 3), numbered[3 * n :].reshape(-1, 2)
        self._free = np.flatnonzero(is_free)  # indices among all displacements, then all rotations
        sides, directors = np.split(bound.sites, [3], axis=1)
        vectors = [(plan.elements, plan.elements), (sides, directors - n)]
        unknowns = (np.hstack([_flat(self.moves[at]), _flat(self.turns[on])]) for at, on in vectors)
        self.pattern = pattern_of(self.places(bound), *unknowns, size=len(self._free))
        self.unknowns, self.size, self.first_director = self.pattern.size, 6 * n + bound.vectors.size, 3 * n
        self._upright = np.concatenate([np.tile(UP, (n, 1)), bound.vectors])
        self._held = np.concatenate([supports.position, np.tile(held, (3, 1)).T])
        self.bind(bound)

    def elements_of(self, section: Section | None, law: str) -> tuple[Any, NaturalState | None]:
        """Return all elements, and their natural strains. Raises BadInput for a law that the scene's material
        or a section of the caller's own does not have."""
        scene, nodes = self.scene, self.plan.corners
        require_law(law, LAWS, scene)
        if law == STRAIN_LAW:
            element_section = grown(section or section_at(scene, nodes), scene, nodes)
            return Element.build(nodes, element_section), self.natural_of(scene)
        require_uniform(scene, f"the shell's law '{law}'", f"its law '{STRAIN_LAW}' is for all sheets")
        if section is not None:
            raise BadInput(f"law = '{law}': a given section needs the law '{STRAIN_LAW}'")
        return HyperelasticElement.of(nodes, scene.material, scene.sheet.thickness, LAWS[law]), None

    def rebuild(self) -> Callable[[], Self] | None:
        law = () if self.linear else (self.law,)
        return None if self.section else partial(type(self), self.plan.mesh, self.scene, None, *law)

    def natural_of(self, scene: Scene) -> NaturalState | None:
        """Return the natural strains of a scene's sheet, at which it has no stress."""
        sites, make = self.natural_form()
        state = natural_at(scene if self.linear else stretched(scene), sites)
        return state and state.made(make)

    def natural_form(self) -> tuple[np.ndarray, Callable[[np.ndarray, np.ndarray], np.ndarray]]:
        """Return the points (m, p, 2) [m] at which e0 and k0 (m, p, 2, 2) are evaluated, and a function from
        both to the elements' natural strains."""
        return AT_SITES @ self.plan.corners, partial(natural_strains, self.plan.corners)

    def with_scene(self, scene: Scene) -> Self:
        """Return the sheet at rest with supports, loads, chains and natural state of another scene of equal
        plan. It keeps its own elements."""
        other = copy(self)
        for name in ("_inertia", "sheet_mass", "mass"):
            vars(other).pop(name, None)
        other.scene, other.items, other.weights = scene, [], []
        other.commanded, other._commands = commands_of(scene, moving=False)
        other.natural = self.natural_of(scene) if self.natural is not None else None
        bound = other.bound_rods()
        if (scene.supports, scene.actuators) != (self.scene.supports, self.scene.actuators):
            other.supports = rod.hold_bases(other.supports_of(), bound.rods)
        other.bind(bound)
        return other

    def supports_of(self) -> Supports:
        """Return the prescribed positions and directors of supports and motions."""
        return surface_supports.of_scene(self.scene, self.plan)

    @cached_property
    def _inertia(self) -> np.ndarray:
        """Return ∫ ρh N N dA of φ, ∫ ρh³/12 N N dA of d, ∫ρz dz N N dA of both, and payloads, (m, 18, 3, 18,
        3) [kg, kg m²]."""
        value, of = AT_GAUSS[0], constants_of(self.scene, self.plan.corners)
        kinds = ((of.per_area, of.moment_per_area), (of.moment_per_area, of.rotary_per_area))
        parts = np.array([[self.element.areas * part for part in row] for row in kinds])
        masses = np.einsum("preg,gi,gj->preij", parts, value, value)
        out = np.einsum("preij,cd->epicrjd", masses, np.eye(3)).reshape(-1, 18, 3, 18, 3)
        add_payloads(self.scene, self.plan, out)
        return out

    @cached_property
    def sheet_mass(self) -> csr_matrix:
        pattern = Pattern(self._components.reshape(-1, 54), size=self.size)
        mass = pattern.matrix(self._inertia.reshape(-1, 54, 54)).copy()
        mass.eliminate_zeros()
        return mass

    # prescribed displacements and the unknowns

    def directors(self, q: np.ndarray) -> np.ndarray:
        """Return d of the nodes, then m of the rods, (n + p, 3)."""
        return q[3 * self.nodes :].reshape(-1, 3) + self._upright

    def frame(self, q: np.ndarray, at: float) -> np.ndarray:
        """Return T (n + p, 3, 2) ⊥ d, and ⊥ m of the rods."""
        return tangent_frames(self.directors(q), self._held_axes)

    @cached_property
    def _held_axes(self) -> np.ndarray:
        """Number of the axis that is the first tangent of every director (n + p,), −1 for any tangent."""
        axes = np.full(len(self.turns), -1)
        nodes, along = np.nonzero(self.supports.tilt & ~self.supports.director[:, None])
        axes[nodes] = along
        return axes

    def change(self, at: float) -> np.ndarray:
        """Return the prescribed change (2, n, 3) of positions [m] and directors."""
        return self.supports.change(*self.instant(at))

    def constrained_rate(self, q: np.ndarray, v: np.ndarray, time: float) -> np.ndarray:
        prescribed = np.zeros(self._held.shape)
        prescribed[: 2 * self.nodes] = self.supports.rate(time).reshape(-1, 3)
        rate = np.where(self._held, prescribed, v.reshape(self._held.shape))
        directors, turns = self.directors(q), rate[self.nodes :]
        turns -= np.einsum("nc,nc->n", turns, directors)[:, None] * directors
        return rate.ravel()

    def gap_step(self, shape: SheetShape) -> np.ndarray:
        free = np.concatenate([np.zeros((self.nodes, 3)), to_unit(self.directors(shape.q))])
        target = np.zeros(self._held.shape)  # rods stand still
        target[: 2 * self.nodes] = self.change(shape.at).reshape(-1, 3)
        return np.where(self._held, target - shape.q.reshape(-1, 3), free).ravel()

    def moved(self, q: np.ndarray, step: np.ndarray) -> np.ndarray:
        """Return q (N,) after a step, its free directors brought to unit length."""
        change = (q + step).reshape(-1, 3)
        turns = change[self.nodes :]
        directors = turns + self._upright
        normalised = directors / np.linalg.norm(directors, axis=1)[:, None] - self._upright
        return np.append(change[: self.nodes], np.where(self._held[self.nodes :], turns, normalised))

    def centripetal(self, q: np.ndarray, v: np.ndarray) -> np.ndarray:
        """Return −|ḋ|² d of the free directors."""
        rate = v.reshape(-1, 3)[self.nodes :]
        inward = -np.sum(rate**2, axis=1)[:, None] * self.directors(q)
        turns = np.where(self._held[self.nodes :], 0.0, inward)
        return np.append(np.zeros((self.nodes, 3)), turns)

    def of_supports(self, exerted: np.ndarray) -> np.ndarray:
        """Return the supports' forces M ü + g, without forces that keep free directors unit vectors."""
        return np.where(self._held.ravel(), exerted, 0.0)

    def basis(self, q: np.ndarray, at: float = 0.0) -> csc_matrix:
        ones, rows, starts, director, tangent = self._basis
        data = np.append(ones, self.frame(q, at)[director, :, tangent])
        return csc_matrix((data, rows, starts), (self.size, self.unknowns))

    @cached_property
    def _basis(self) -> tuple[np.ndarray, ...]:
        """Entries of displacements in Z, rows and starts of its columns (one row a displacement, three a
        rotation), and the directors and tangents of the rotations."""
        moves = np.flatnonzero(~self.held)
        director, tangent = np.nonzero(self.turns >= 0)
        rows = np.append(moves, 3 * (self.nodes + director[:, None]) + np.arange(3))
        widths = np.repeat([1, 3], [len(moves), len(director)])
        return np.ones(len(moves)), rows, np.append(0, np.cumsum(widths)), director, tangent

    def reduce(self, shape: SheetShape, force: np.ndarray) -> np.ndarray:
        couple = np.einsum("nc,nck->nk", force[3 * self.nodes :].reshape(-1, 3), shape.frame)
        return np.append(force[: 3 * self.nodes], couple)[self._free]

    def expand(self, shape: SheetShape, step: np.ndarray) -> np.ndarray:
        all_steps, n = np.zeros(3 * self.nodes + self.turns.size), self.nodes
        all_steps[self._free] = step
        turned = np.einsum("nck,nk->nc", shape.frame, all_steps[3 * n :].reshape(-1, 2))
        return np.concatenate([all_steps[: 3 * n], turned.ravel()])

    # forces

    def stiffness(
        self, shape: SheetShape, moduli: np.ndarray, stress: np.ndarray, residual: np.ndarray, by_a: float
    ) -> np.ndarray:
        along = multiplier(self.directors(shape.q), residual[3 * self.nodes :].reshape(-1, 3))
        on_turns = np.append(np.zeros(3 * self.nodes), np.repeat(along, 2))[self._free]
        data, slots, on = self.pattern.zeros(on_turns), self.pattern.slots[0], self.plan.elements
        forms, coupled = (stress @ OF_POSITIONS).reshape(-1, 9, 18), self.element.coupled
        add_tangents(shape.operator, moduli, coupled, forms, shape.frame, on, TABLES, slots, data)
        if by_a:
            blocks = self.fold(shape, np.arange(len(self.plan.elements)), self._inertia)
            add_blocks(data, self.pattern.slots[0], by_a * blocks)
        return data

    def fold(self, shape: SheetShape, on: np.ndarray, tangent: np.ndarray) -> np.ndarray:
        return projected(tangent, shape.frame[self.plan.elements[on]])

    def onto_rods(self, shape: SheetShape) -> np.ndarray:
        directors = self.rods.bound.sites[:, 3:] - self.nodes
        fixed = np.tile(np.eye(3), (len(directors), 1, 1))
        return block_diagonal([fixed] * 3 + [shape.frame[directors[:, i]] for i in range(6)])

    @cached_property
    def onto_surface(self) -> csr_matrix:
        return eye_array(6 * self.nodes, self.size, format="csr")

    def of_vectors(self, displacement: np.ndarray, turn: np.ndarray) -> np.ndarray:
        rods = np.zeros(self.size - 6 * self.nodes)
        return np.concatenate([displacement.ravel(), turn.ravel(), rods])

    # results and validity

    def inverted_element(self, q: np.ndarray) -> str:
        return inverted(self.element, self.gather(q))

    def stretch(self, shape: SheetShape) -> float:
        return membrane_strain(self.element, shape.strain)

    def drawn(self, q: np.ndarray, line_force: np.ndarray | None = None) -> FieldMesh:
        fields = {} if line_force is None else {"actuator_line_force": line_force}
        directors = UP + q.reshape(-1, 3)[self.nodes : 2 * self.nodes]
        fields |= {"displacement": self.displacement(q), "director": directors}
        return FieldMesh(self.flat, [("quad", quarters(self.plan.elements.T))], fields)

    def exerted(self, q: np.ndarray, exerted: np.ndarray) -> HoldingForces:
        surface, (force, turning) = self.surface(q), exerted[: 6 * self.nodes].reshape(2, -1, 3)
        nodal = np.concatenate([force, np.cross(surface.director, turning)], axis=1)
        return HoldingForces(nodal, surface.position)

    def holding(self, q: np.ndarray, exerted: np.ndarray, at: float) -> list[tuple[np.ndarray, np.ndarray]]:
        frames, turning = self.frame(q, at), exerted[3 * self.nodes :].reshape(-1, 3)
        couple = np.where(self.turns < 0, np.einsum("nc,nck->nk", turning, frames), 0.0)
        on_nodes = np.where(self.supports.position, self.displacement(exerted), 0.0)
        across = np.einsum("nck,nk->nc", frames, couple)
        return [(self.surface(q).position, on_nodes), (self.directors(q), across)]


def _flat(numbers: np.ndarray) -> np.ndarray:
    """Return numbers (m, k, c) by element, (m, k c)."""
    return numbers.reshape(len(numbers), numbers.shape[1] * numbers.shape[2])
