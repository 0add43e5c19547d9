"""Discrete solid: three coordinates a node, with the mass ∫ ρ N N dV and linear constraints.

q: displacements of all nodes, (n, levels, 3), then changes of the rods' own vectors. Held components c of a
column, u = Z c (see `supports`), go to their targets in the first step.

    ∫ S(E) : δE dV = δ(loads),    E = ½ (Fᵀ F − 1)

total Lagrangian, on 27-node bricks that lock neither in a thin sheet nor as ν → ½ (`element`). At every edge
the solid has a layer as wide as the sheet is thick: at a free edge the twisting stress turns round, at a
clamp the Poisson contraction is stopped. On a uniform mesh much coarser than the layer, answers converge like
1/n (a full clamp's stress is singular besides): the mesh is graded towards the edges.

Loads act on the sheet as a surface, its mean position x̄ and director D (see `mesh`), with the shell's
work: a dead force or the pressure on x̄ is a body force uniform through the thickness, an edge moment
on D a traction linear in ζ. The power of pressure and moment is the shell's to first order in the strain.
Rods along edges (see `rods`) are further elements with directors of their own.
"""

from functools import cached_property
from typing import ClassVar

import numpy as np
from scipy.sparse import (
    block_diag,
    bsr_matrix,
    csc_matrix,
    csr_matrix,
    eye_array,
    hstack,
    identity,
    kron,
    vstack,
)
from skfem import MeshQuad

from fem_reference.discrete.elements import DiscreteElements
from fem_reference.discrete.shape import SheetShape
from fem_reference.solid.element import Bricks, at_rest, tangent
from fem_reference.solid.materials import LAWS
from fem_reference.solid.mesh import columns_of
from fem_reference.solid.rods import DIRECTORS, on_columns
from fem_reference.solid.supports import applied, of_scene
from fem_reference.surface import rod
from fem_reference.surface.actuator_forces import HoldingForces
from fem_reference.surface.biquadratic import AT_GAUSS, GAUSS_WEIGHTS
from fem_reference.surface.payloads import add_payloads
from fem_reference.surface.rod import BoundRods, block_diagonal
from sheetbench.answers.solution import FieldMesh
from sheetbench.choices import STRAIN_LAW
from sheetbench.numerics.sparsity import Pattern, pattern_of
from sheetbench.scenes import Scene


class DiscreteSolid(DiscreteElements):
    """Solid of a scene on columns of bricks, layer by layer over a plan mesh of straight-sided
    quadrilaterals. It is at rest unless it is moving."""

    model = "solid"
    norm: ClassVar[int] = 2
    element: Bricks
    _share = np.nan  # load factor of the frames that are kept

    def __init__(
        self,
        mesh: MeshQuad,
        scene: Scene,
        layers: int = 1,
        law: str = STRAIN_LAW,
        clamp: str = "shell-like",
        moving: bool = False,
    ):
        """Raise BadInput for an unknown law or clamp, no layers or a folded element."""
        super().__init__(scene, moving)
        columns, material = columns_of(mesh, scene, layers, law)
        self.columns, self.plan = columns, columns.plan
        self.any_strain = not LAWS[law].quadratic
        self.sites = columns.bricks
        positions = columns.positions.reshape(-1, 3)[self.sites]
        self.element, self.natural = at_rest(drawn := Bricks.build(positions, LAWS[law], material), scene)
        self._products = drawn.products

        bound = self.bound_rods()
        self.column_supports = of_scene(scene, columns, clamp, bound.rods)
        self.supports = self.column_supports.line
        self.held = self.column_supports.held.ravel()
        self._turned = self.column_supports.turned[columns.plan.elements].any(axis=1)
        self._held_aside = np.repeat(bound.held, 3)
        is_free = ~np.concatenate([self.held, self._held_aside])
        self._free = np.flatnonzero(is_free)
        number = np.where(is_free, np.cumsum(is_free) - 1, -1).reshape(-1, 3)  # of all vectors
        kinds = (number[s].reshape(len(s), 3 * s.shape[1]) for s in (columns.stacks, bound.sites))
        self.pattern = pattern_of(self.places(bound), *kinds, size=len(self._free))
        self.unknowns, self.size, self.first_director = len(self._free), is_free.size, len(self.held)
        levels = columns.levels
        places = np.concatenate([levels * np.arange(3) + columns.layers, 3 * levels + np.arange(6)])
        self.bind(bound, places)

    def bound_rods(self) -> BoundRods:
        return on_columns(rod.of_scene(self.commanded, self.plan), self.columns)

    @cached_property
    def _inertia(self) -> np.ndarray:
        """Return ∫ ρ N N dV (m, 3 s, 3 s) of the stacks, with payloads on columns' means and directors."""
        blocks = self._stack(np.einsum("eij,cd->eicjd", self._products(), np.eye(3)))
        if self.scene.masses:
            add_payloads(self.scene, self.plan, payloads := np.zeros((len(blocks), 18, 3, 18, 3)))
            blocks += self._of_columns(payloads)
        return blocks

    @cached_property
    def sheet_mass(self) -> csr_matrix:
        sites = (3 * self.columns.stacks[:, :, None] + np.arange(3)).reshape(len(self._inertia), -1)
        return Pattern(sites, size=self.size).matrix(self._inertia)

    # prescribed displacements and the unknowns

    def frame(self, q: np.ndarray, at: float) -> np.ndarray:
        """Return Z of the columns (n, 3 levels, 3 levels)."""
        return self._frames(at)[0]

    def basis(self, q: np.ndarray, at: float = 0.0) -> csc_matrix:
        return self._frames(at)[1]

    def _frames(self, at: float) -> tuple[np.ndarray, csc_matrix]:
        """Return Z of the columns, and of all vectors; both are kept for the last load factor."""
        share = self.instant(at)[0] if self.supports.driven else 1.0
        if share != self._share:
            bases = self.column_supports.bases(share)
            blocks, aside = np.arange(len(bases) + 1), identity(len(self._held_aside))
            of_columns = bsr_matrix((bases, blocks[:-1], blocks))
            of_all = block_diag([of_columns, aside], format="csc")[:, self._free]
            self._share, self._kept_frames = share, (bases, of_all)
        return self._kept_frames

    def constrained_rate(self, q: np.ndarray, v: np.ndarray, time: float) -> np.ndarray:
        rate = self.column_supports.spread(self.supports.rate(time))
        return v + self._to_supports(self.frame(q, time), v, rate)

    def gap_step(self, shape: SheetShape) -> np.ndarray:
        target = self.column_supports.spread(self.supports.change(*self.instant(shape.at)))
        return self._to_supports(shape.frame, shape.q, target)

    def _to_supports(self, bases: np.ndarray, q: np.ndarray, target: np.ndarray) -> np.ndarray:
        """Return the step (N,) from q (N,) to the held components of a target (n, levels, 3)."""
        gap = applied(np.linalg.inv(bases), target - self._on_columns(q))
        step = applied(bases, np.where(self.column_supports.held, gap, 0.0))
        return np.append(step, np.where(self._held_aside, -q[self.first_director :], 0.0))

    def _on_columns(self, q: np.ndarray) -> np.ndarray:
        """Return the columns' part (n, levels, 3) of q."""
        return self.displacement(q).reshape(self.columns.positions.shape)

    # forces

    def pressure(self, shape: SheetShape, by: np.ndarray) -> np.ndarray | None:
        return None if self.element.law.quadratic else self.element.pressure(shape.strain, by)

    def stiffness(
        self, shape: SheetShape, moduli: np.ndarray, stress: np.ndarray, residual: np.ndarray, by_a: float
    ) -> np.ndarray:
        stacks = self._stack(tangent(shape.operator, moduli, stress))
        if by_a:
            stacks += by_a * self._inertia
        return self.pattern.matrix(self._turn(stacks, shape.frame, np.arange(len(stacks)))).data

    def fold(self, shape: SheetShape, on: np.ndarray, tangent: np.ndarray) -> np.ndarray:
        return self._turn(self._of_columns(tangent), shape.frame, on)

    def onto_rods(self, shape: SheetShape) -> np.ndarray:
        nodes = self.rods.bound.sites[:, : -DIRECTORS : self.columns.levels] // self.columns.levels
        directors = np.tile(np.eye(3 * DIRECTORS), (len(nodes), 1, 1))
        return block_diagonal([*(shape.frame[nodes[:, i]] for i in range(3)), directors])

    def _stack(self, of_bricks: np.ndarray) -> np.ndarray:
        """Return matrices (m, 3 s, 3 s) of stacks, sums of bricks' (layers · m, 27, 3, 27, 3)."""
        m, s = self.columns.stacks.shape
        out = np.zeros((m, s, 3, s, 3))
        for place, bricks in zip(self.columns.places, np.split(of_bricks, self.columns.layers), strict=True):
            out[:, place[:, None], :, place[None, :], :] += bricks.transpose(1, 3, 0, 2, 4)
        return out.reshape(m, 3 * s, 3 * s)

    def _turn(self, stacks: np.ndarray, bases: np.ndarray, on: np.ndarray) -> np.ndarray:
        """Return Zᵀ K Z (k, 3 s, 3 s) of the stacks over elements `on`, in place."""
        turned = self._turned[on]
        if not np.any(turned):
            return stacks
        k, size = stacks[turned].shape[:2]
        z = bases[self.plan.elements[on[turned]]]  # (k, 9, 3 levels, 3 levels)
        half = stacks[turned]
        for _ in range(2):
            rows = half.reshape(*z.shape[:3], size)
            half = (z.swapaxes(2, 3) @ rows).reshape(k, size, size).swapaxes(1, 2)
        stacks[turned] = half
        return stacks

    def _of_columns(self, tangent: np.ndarray) -> np.ndarray:
        """Return derivatives of surface forces (k, 18, 3, 18, 3) as matrices of stacks (k, 3 s, 3 s)."""
        k, size = len(tangent), 3 * self.columns.stacks.shape[1]
        parts = tangent.reshape(k, 2, 9, 3, 2, 9, 3)
        averages = self.columns.averages
        stacks = np.einsum("epicrjd,pl,rm->eilcjmd", parts, averages, averages, optimize=True)
        return stacks.reshape(k, size, size)

    @cached_property
    def onto_surface(self) -> csr_matrix:
        """Matrix from coordinates to means and directors of columns."""
        n, aside = self.nodes, self.size - self.first_director
        rows = (np.kron(weights, np.eye(3)) for weights in self.columns.averages[:, None])
        of_columns = vstack([kron(eye_array(n), row) for row in rows])
        return hstack([of_columns, csr_matrix((6 * n, aside))], format="csr")

    def of_vectors(self, displacement: np.ndarray, turn: np.ndarray) -> np.ndarray:
        columns = self.column_supports.spread(np.array([displacement, turn]))
        return np.pad(columns.ravel(), (0, self.size - self.first_director))

    # results and validity

    def inverted_element(self, q: np.ndarray) -> str:
        ratio = self.element.volume_ratio(self.gather(q))
        return "a brick has turned inside out: use more elements" if np.any(ratio <= 0.0) else ""

    def stretch(self, shape: SheetShape) -> float:
        """Return the largest stretching √(1 + 2 E) − 1 along elements' sides, E the mean Green strain."""
        places = (self.on_surface(q)[:, :9] for q in (np.zeros_like(shape.q), shape.q))
        rest, current = (np.sum(np.einsum("agi,eic->aegc", AT_GAUSS[1], at) ** 2, axis=3) for at in places)
        # 2 E, of both sides of every element
        mean = (current / rest - 1.0) @ GAUSS_WEIGHTS / GAUSS_WEIGHTS.sum()
        return float(np.max(np.abs(np.sqrt(np.maximum(1.0 + mean, 0.0)) - 1.0)))

    def middles(self, displacement: np.ndarray) -> np.ndarray:
        return displacement.reshape(self.columns.positions.shape)[:, self.columns.layers]

    def reactions(self, exerted: np.ndarray, at: float = 1.0) -> dict[str, np.ndarray]:
        return self.column_supports.reactions(self._on_columns(exerted), self.instant(at)[0])

    def drawn(self, q: np.ndarray, line_force: np.ndarray | None = None) -> FieldMesh:
        return self.columns.field_mesh(self._on_columns(q))

    def exerted(self, q: np.ndarray, exerted: np.ndarray) -> HoldingForces:
        position, nodal = self.columns.positions + self._on_columns(q), self._on_columns(exerted)
        middle = position[:, self.columns.layers]
        moment = np.cross(position - middle[:, None], nodal).sum(axis=1)
        return HoldingForces(np.concatenate([nodal.sum(axis=1), moment], axis=1), middle)

    def holding(self, q: np.ndarray, exerted: np.ndarray, at: float) -> list[tuple[np.ndarray, np.ndarray]]:
        turned = self.frame(q, at).swapaxes(1, 2)
        held = np.where(self.column_supports.held, applied(turned, self._on_columns(exerted)), 0.0)
        aside = np.where(self._held_aside, exerted[self.first_director :], 0.0).reshape(-1, 3)
        return [
            (self.columns.positions + self._on_columns(q), applied(np.linalg.inv(turned), held)),
            (q[self.first_director :].reshape(-1, 3) + self.rods.bound.vectors, aside),
        ]
