"""The discrete plate: linear, K u = f on the flat sheet, which all loads act on.

    M ü + (τ K + α M) u̇ + K u = F

q: ux, uy, w and the director's tilts, (n, 5), then m_s and m_z at the nodes of the rods' edges. A pressure
acts along +z, an edge moment m as −m on the tilt towards the outward normal. The mass has ρh on the
displacements and ρh³/12 on the tilts.
"""

from __future__ import annotations

from functools import cached_property, partial
from typing import ClassVar, NamedTuple, cast

import numpy as np
from scipy.sparse import csc_matrix, csr_matrix, identity
from skfem import MeshQuad

from fem_reference.discrete.relaxation import Strained, gain, with_branches
from fem_reference.discrete.shape import SheetShape
from fem_reference.discrete.sheet import Discrete
from fem_reference.plate.element import TILT_X, PlateElements, W
from fem_reference.plate.validity import TURN_LIMIT, strained
from fem_reference.surface import carried, rod
from fem_reference.surface import supports as surface_supports
from fem_reference.surface.actuator_forces import HoldingForces
from fem_reference.surface.balance import Surface
from fem_reference.surface.biquadratic import AT_GAUSS, GAUSS, integrated, shape
from fem_reference.surface.materials import Section, constants_of, section_at
from fem_reference.surface.mesh import field_mesh, on_boundary, plan_of, require_upright
from sheetbench.answers.solution import FieldMesh
from sheetbench.numerics.sparsity import Pattern
from sheetbench.scenes import EDGES, Scene, outside_model
from sheetbench.scenes.meaning.natural_state import natural_at

PARTS = ("membrane", "bending", "shear")


class OwnStrains(NamedTuple):
    """Membrane and bending strains (m, 9, 3) without stress; f (N,) [N, N·m] on all unknowns."""

    strains: tuple[np.ndarray | float, np.ndarray | float] = (0.0, 0.0)
    force: np.ndarray | float = 0.0


def own_strains(
    elements: PlateElements, section: Section, size: int, strain: np.ndarray, curvature: np.ndarray
) -> OwnStrains:
    """Return those of e0 and k0 at the Gauss points (m, 9, 2, 2): e0 of the middle and −k0 in bending,

    f = ∫ (Bᵀ A e0 − Bᵀ D k0) dA,
    W = ½ ∫ (e − e0)·A (e − e0) + (κ + k0)·D (κ + k0) dA = ½ u·K u − f·u + W₀
    """
    xx_yy_2xy = np.array([1.0, 1.0, 2.0])
    strains = [xx_yy_2xy * form[..., [0, 1, 0], [0, 1, 1]] for form in (strain, -curvature)]
    force = np.zeros(size)
    parts = (elements.membrane, section.membrane), (elements.curvature, section.bending)
    for (operator, stiffness), own in zip(parts, strains, strict=True):
        stress = elements.areas[..., None] * (stiffness @ own[..., None])[..., 0]
        np.add.at(force, elements.unknowns, np.einsum("mqic,mqi->mc", operator, stress))
    return OwnStrains((strains[0], strains[1]), force)


class DiscretePlate(Discrete):
    """A scene's plate on any flat mesh of straight-sided quadrilaterals [m]; BadInput for folded ones.

    hard_edges: edges on which the tilt along the edge is held as well; section: stiffness per width, from
    material and thickness unless given. number: of the components (2 n + p, 3) of the vectors φ, d and m, −1
    for none; is_held: (N,).
    """

    model = "plate"
    norm: ClassVar[int] = 2

    def __init__(
        self,
        mesh: MeshQuad,
        scene: Scene,
        section: Section | None = None,
        hard_edges: tuple[str, ...] = (),
        moving: bool = False,
    ):
        super().__init__(scene, moving)
        require_upright(mesh)
        self.plan = plan = plan_of(mesh)
        nodes, self.elements = plan.nodes, PlateElements.build(plan.elements, plan.nodes)
        self.section = section or section_at(scene, plan.corners)
        self._cut = 5 * len(nodes)

        bound = self.rods_of(scene)
        self.number = number = np.full(
            (2 * len(nodes) + len(bound.own), 3), -1
        )  # of every vector's components
        of_plate = np.arange(self._cut).reshape(-1, 5)
        number[: len(nodes)], number[len(nodes) : 2 * len(nodes), :2] = of_plate[:, :3], of_plate[:, 3:]
        across = bound.own == 0.0
        number[2 * len(nodes) :][across] = self._cut + np.arange(across.sum())
        self.supports = supports = rod.hold_bases(surface_supports.of_scene(scene, mesh), bound.rods)
        held = np.column_stack([supports.position, supports.director[:, None] | supports.tilt])
        for name in hard_edges:
            held[on_boundary(mesh, name), TILT_X + EDGES[name].along_axis] = True
        self.is_held = np.concatenate([held.ravel(), np.repeat(bound.held, 2)])
        self.free, self.size = np.flatnonzero(~self.is_held), self.is_held.size
        self.unknowns, self.scale = len(self.free), np.full(self.size, self.lever)
        self.scale[number[: len(nodes)]] = 1.0
        self.bind(bound, number[bound.sites].reshape(-1, 27))
        if (state := natural_at(scene, AT_GAUSS[0] @ plan.corners)) is not None:
            self.natural = state.made(partial(own_strains, self.elements, self.section, self.size))

    def at_rest(self, at: float) -> OwnStrains:
        """What it has without stress at a load factor or time [s]."""
        return OwnStrains() if self.natural is None else cast(OwnStrains, self.natural.at(*self.instant(at)))

    @cached_property
    def stiffness(self) -> csr_matrix:
        strains = zip(self._strains, self.section, strict=True)
        blocks = [integrated(operator, part, self.elements.areas) for operator, part in strains]
        return self._assembled(np.sum(blocks, axis=0))

    @cached_property
    def sheet_mass(self) -> csr_matrix:
        constants, (values, _) = constants_of(self.scene, self.plan.corners), shape(*GAUSS)
        areas = self.elements.areas
        moved, turned = (areas * part for part in (constants.per_area, constants.rotary_per_area))
        products = np.einsum("imq,qa,qb->imab", np.array([moved] * 3 + [turned] * 2), values, values)
        payloads = carried.of_scene(self.scene, self.plan)
        products[:3, payloads.elements] += payloads.by_place
        products[3:, payloads.elements] += payloads.by_turn[:2]
        return self._assembled(np.einsum("imab,ij->maibj", products, np.eye(5)))

    @property
    def _strains(self) -> tuple[np.ndarray, ...]:
        """Strain operators of the `PARTS`, (m, q, 3 or 2, 45)."""
        return self.elements.membrane, self.elements.curvature, self.elements.shear

    def _assembled(self, blocks: np.ndarray) -> csr_matrix:
        number = self.elements.unknowns
        return Pattern(number, size=self.size).matrix(blocks.reshape(*number.shape, -1))

    # what is prescribed, and the unknowns

    def placed(self, q: np.ndarray, at: float) -> np.ndarray:
        share, time = self.instant(at)
        values = np.zeros((self.nodes, 5))
        for driven in self.supports.driven:
            displacement, director = driven.edge.linear(driven.points)
            values[driven.nodes, : W + 1], values[driven.nodes, TILT_X:] = displacement, director[..., :2]
        values[:, : W + 1] += self.supports.shift(time)
        return np.where(self.is_held, share * self._padded(values), q)

    def rate_placed(self, q: np.ndarray, v: np.ndarray, time: float) -> np.ndarray:
        return np.where(self.is_held, self.on_coordinates(self.supports.rate(time)[0]), v)

    def held(self, vectors: np.ndarray, at: float) -> np.ndarray:
        return vectors[self.is_held]

    def basis(self, q: np.ndarray, at: float = 0.0) -> csc_matrix:
        return self._basis

    @cached_property
    def _basis(self) -> csc_matrix:
        return identity(self.size, format="csc")[:, self.free]

    def _padded(self, fields: np.ndarray) -> np.ndarray:
        return np.pad(fields.ravel(), (0, self.size - self._cut))

    def _fields(self, q: np.ndarray) -> np.ndarray:
        """Displacements and tilts (n, 5), a view."""
        return q[: self._cut].reshape(-1, 5)

    # forces

    def elements_internal(self, shape: SheetShape) -> np.ndarray:
        out = with_branches(self.stiffness @ shape.q, shape.branches)
        viscous = 0.0 if shape.v is None else self.tau * (self.stiffness @ shape.v)
        return np.asarray(out + viscous - self.at_rest(shape.at).force)

    def tangent(self, shape: SheetShape, residual: np.ndarray, by_a: float, by_v: float) -> csr_matrix:
        return self.whole_tangent(shape, by_a, by_v)[self.free][:, self.free]

    def whole_tangent(self, shape: SheetShape, by_a: float = 0.0, by_v: float = 0.0) -> csr_matrix:
        """by_a M + by_v C + K of all coordinates."""
        whole = (1.0 + self.tau * by_v + gain(shape.branches)) * self.stiffness
        if by_a or by_v:
            whole = (by_a + self.alpha * by_v) * self.sheet_mass + whole
        for body in self.bodies:
            whole = whole + body.matrix(body.tangent(shape, body.stress(shape), by_a, by_v))
        for item in (
            self.items if by_v else ()
        ):  # which act on the flat sheet: rates alone change their forces
            if (found := item.damping(shape)) is not None:
                on, by_rates = found
                blocks = np.zeros((len(self.plan.elements), 9, 5, 9, 5))
                blocks[on, :, :3, :, :3] = by_v * by_rates[:, :9, :, :9]
                whole = whole - self._assembled(blocks)
        return whole.tocsr()

    def on_coordinates(self, dead: np.ndarray) -> np.ndarray:
        return self._padded(np.pad(dead, ((0, 0), (0, 2))))

    def of_vectors(self, displacement: np.ndarray, turn: np.ndarray) -> np.ndarray:
        return self._padded(np.column_stack([displacement, turn[:, :2]]))

    def on_surface(self, q: np.ndarray) -> np.ndarray:
        """Of the flat sheet."""
        return self._flat

    @cached_property
    def _flat(self) -> np.ndarray:
        flat = np.zeros((len(self.plan.elements), 18, 3))
        flat[:, :9, :2], flat[:, 9:, 2] = self.plan.corners, 1.0
        return flat

    def surface_change(self, change: np.ndarray) -> np.ndarray:
        fields = self._fields(change)[self.plan.elements]
        return np.concatenate([fields[..., :3], np.pad(fields[..., 3:], ((0, 0), (0, 0), (0, 1)))], axis=1)

    def of_surface(self, on: np.ndarray, pull: np.ndarray) -> np.ndarray:
        force, nodes = np.zeros((self.nodes, 5)), self.plan.elements[on]
        np.add.at(force[:, :3], nodes, pull[:, :9])
        np.add.at(force[:, 3:], nodes, pull[:, 9:, :2])
        return self._padded(force)

    # energies

    def strains(self, q: np.ndarray) -> Strained:
        return q, self.stiffness @ q

    def energies_by_part(self, shape: SheetShape) -> dict[str, float]:
        own = dict(zip(PARTS, self.at_rest(shape.at).strains, strict=False))
        nodal, out = shape.q[self.elements.unknowns], {}
        for name, operator, section in zip(PARTS, self._strains, self.section, strict=True):
            strain = (operator @ nodal[:, None, :, None])[..., 0] - own.get(name, 0.0)
            force = (section @ strain[..., None])[..., 0]
            out[name] = 0.5 * float(np.einsum("mq,mqi,mqi", self.elements.areas, strain, force))
        return out

    def stiffness_of(self, q: np.ndarray, step: np.ndarray, other: np.ndarray) -> float:
        return float(step @ (self.stiffness @ other))

    # what is shown

    def stretch(self, shape: SheetShape) -> float:
        return strained(self.elements, shape.q)

    def beyond(self, stretch: float) -> str:
        if stretch > TURN_LIMIT:
            return f"slopes, turns or twice the strain of {stretch:.3g}, beyond 1: linear theory ends before"
        return outside_model(self.scene, 0.0)

    def displacement(self, q: np.ndarray) -> np.ndarray:
        return self._fields(q)[:, :3]

    def drawn(self, q: np.ndarray, line_force: np.ndarray | None = None) -> FieldMesh:
        fields = {} if line_force is None else {"actuator_line_force": line_force}
        director = self.surface(q).director + np.pad(self._fields(q)[:, 3:], ((0, 0), (0, 1)))
        return field_mesh(self.plan.nodes, self.plan.elements, self.displacement(q), director, **fields)

    def surface(self, q: np.ndarray) -> Surface:
        """The flat one, on which everything acts."""
        return Surface(self.plan, self.flat, np.tile([0.0, 0.0, 1.0], (self.nodes, 1)), self.own)

    def exerted(self, q: np.ndarray, exerted: np.ndarray) -> HoldingForces:
        nodal = self._fields(exerted)  # of the tilts' forces f the couple is e_z × f
        couple = np.column_stack([-nodal[:, 4], nodal[:, 3], np.zeros(len(nodal))])
        return HoldingForces(np.concatenate([nodal[:, :3], couple], axis=1), self.surface(q).position)

    def holding(self, q: np.ndarray, exerted: np.ndarray, at: float) -> list[tuple[np.ndarray, np.ndarray]]:
        surface, held = self.surface(q), np.where(self.is_held, exerted, 0.0)
        vectors = np.concatenate([surface.director, self.rods.bound.own])
        on_vectors = np.where(self.number >= 0, held[self.number], 0.0)
        return [(surface.position, on_vectors[: self.nodes]), (vectors, on_vectors[self.nodes :])]
