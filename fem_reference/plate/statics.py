"""Linear Mindlin plate with its in-plane field: the answer for small deflections.

    ∫ N·δε + M·δκ + Q·δγ dA = δ(loads),   N = h C ε,   M = h³/12 C κ,   Q = 5/6 h G γ

with plane-stress C (see `materials`) and the strains of `element`. Bending and membrane do not know of
each other: no stiffening by stretching, no shortening by bending; where that stops meaning anything says
`fem_reference.plate.validity`. Loads act on the flat sheet: pressure
along +z, an edge moment m as −m on the tilt towards the outward normal. Actuators are linearised about the
flat sheet (`rods`), and their forces' moments taken there. So are bent, tilted and moved edges (the first
orders of `sheetbench.scenes.kinematics`): the shortening of a bent edge's mid-line is of second order.

Along an edge whose director nothing holds (free, hinged, held) the twisting moment fades within a layer of
width √(D66/κGh) = h/√10, far less than an element. On equal elements the answer then converges like the width
of the elements there: on 16 × 16 of Habibi et al.'s sheet it is 0.06 to 0.4 % off with such edges, and 0.01 %
with all edges clamped. Divided finer towards all edges it is 0.002 to 0.03 % off with such edges, and 0.04 %
with all edges clamped: so it is graded where an edge lets twist go.
Source: Hughes, The Finite Element Method (2000), ch. 5. SI units.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any, NamedTuple

import numpy as np
from scipy.sparse import csr_matrix
from skfem import Basis, ElementQuad2, MeshQuad

from fem_reference.plate.balance import Solved, balance
from fem_reference.plate.element import TILT_X, PlateElements, W
from fem_reference.plate.natural import NaturalPlate
from fem_reference.plate.rods import PlateRods
from fem_reference.plate.validity import judge
from fem_reference.surface import carried, loads, rod
from fem_reference.surface import supports as surface_supports
from fem_reference.surface.actuator_forces import Held, exerted, on_edges
from fem_reference.surface.balance import Surface
from fem_reference.surface.biquadratic import GAUSS, integrated, shape
from fem_reference.surface.bound_rods import on_surface
from fem_reference.surface.location import interpolate
from fem_reference.surface.materials import Section, constants_of, section_at
from fem_reference.surface.mesh import Elements, Plan, divisions, field_mesh, mesh_of, require_upright
from fem_reference.surface.rod import Rod
from fem_reference.surface.supports import Supports
from sheetbench.clock import now
from sheetbench.numerics.direct import SingularMatrixError, solve_free
from sheetbench.numerics.sparsity import Pattern
from sheetbench.numerics.threads import one_blas_thread
from sheetbench.scenes import (
    EDGES,
    Iteration,
    Scene,
    Solution,
    Status,
)
from sheetbench.scenes.rigid_motions import require_static

PARTS = ("membrane", "bending", "shear")


@dataclass(frozen=True)
class Plate:
    """A meshed plate: n nodes, unknowns 5·node + field, fields ux, uy, w [m] and the director's tilts."""

    basis: Basis
    elements: PlateElements

    @classmethod
    def on(cls, mesh: MeshQuad) -> Plate:
        """The plate on any flat mesh of straight-sided quadrilaterals [m]; BadInput for folded ones."""
        require_upright(mesh)
        basis = Basis(mesh, ElementQuad2())
        return cls(basis, PlateElements.build(basis.element_dofs.T, basis.doflocs.T))

    @property
    def nodes(self) -> np.ndarray:
        """Plan positions (n, 2) [m]."""
        return self.basis.doflocs.T

    @property
    def plan(self) -> Plan:
        return Plan(self.basis.mesh, self.elements.nodes, self.nodes)

    def strains(self) -> dict[str, np.ndarray]:
        """Strain operators by part: membrane, bending (m, q, 3, 45) and shear (m, q, 2, 45)."""
        element = self.elements
        return dict(zip(PARTS, (element.membrane, element.curvature, element.shear), strict=True))

    def sample(self, fields: np.ndarray, points: np.ndarray) -> np.ndarray:
        """Nodal fields (n, k) at plan points (p, 2) [m]: (p, k). Raises BadInput off the mesh."""
        return interpolate(self.plan.mesh, self.plan.elements, fields, points)


def solve(
    scene: Scene,
    elements: Elements = 16,
    hard_edges: tuple[str, ...] = (),
    section: Section | None = None,
    graded: bool | None = None,
) -> Solution:
    """The linear static answer; elements along the shorter side (near-square), or (nx, ny).

    graded: finer towards the edges, or equal elements; unless given, where an edge lets twist go. hard_edges:
    edges on which the tilt along the edge is held as well. A hinged support is soft; with its edge hard it is
    the simple support of the published Mindlin benchmarks. section: stiffness per width, from material and
    thickness unless given. Raises SceneError if the supports leave a rigid motion free.
    """
    require_static(scene)
    along_x, along_y = divisions(scene.sheet, elements)
    if graded is None:
        graded = not scene.twisting_edges() <= set(hard_edges)
    settings: dict[str, Any] = {"elements": [along_x, along_y], "graded": graded}
    if hard_edges:
        settings["hard_edges"] = list(hard_edges)
    if section is not None:
        settings["section"] = section._asdict()
    mesh = mesh_of(scene, (along_x, along_y), graded)
    return _solved(mesh, scene, f"plate {along_x} × {along_y}", settings, hard_edges, section)


def solve_on(mesh: MeshQuad, scene: Scene) -> Solution:
    """Return the linear answer on any flat mesh of straight-sided quadrilaterals [m], its edges named."""
    return _solved(mesh, scene, "plate", {"elements": mesh.nelements}, own=True)


def _solved(
    mesh: MeshQuad,
    scene: Scene,
    label: str,
    settings: dict[str, Any],
    hard_edges: tuple[str, ...] = (),
    section: Section | None = None,
    own: bool = False,
) -> Solution:
    """own: whether the mesh has an outline of its own, in place of the scene's sheet."""
    begin = now()
    plate = Plate.on(mesh)
    posed = _pose(scene, plate, hard_edges, section)
    rods, supports = posed.rods, posed.supports
    ready = now()
    solved, status, notes = _solve(scene, plate, posed, section)
    done = now()
    u, free = solved.u, solved.free
    fields = u[: 5 * len(plate.nodes)]

    fields, nodal = u[: fields.size].reshape(-1, 5), solved.unbalanced[: fields.size].reshape(-1, 5)
    couple = np.column_stack([-nodal[:, 4], nodal[:, 3], np.zeros(len(nodal))])  # e_z × what holds the tilts
    flat, up = np.column_stack([plate.nodes, np.zeros(len(nodal))]), np.tile([0.0, 0.0, 1.0], (len(nodal), 1))
    holding = Held(np.concatenate([nodal[:, :3], couple], axis=1), flat)
    edges = on_edges(rods.bound, rods.strained(u).pull, holding, up)
    wrenches, line = exerted(scene, edges, supports.moved, holding)
    reactions = supports.reactions(nodal[:, :3])
    surface = Surface(plate.plan, flat, up, own)
    director = up + np.pad(fields[:, 3:], ((0, 0), (0, 1)))
    of_rods = {"actuator_line_force": line} if scene.actuators else {}
    singular = status is Status.SINGULAR
    by_part = energies(scene, plate, u[: fields.size], section)
    return Solution(
        model="plate",
        label=label,
        settings=settings,
        status=status,
        unknowns=len(free),
        iterations=1,
        setup_seconds=ready - begin,
        solve_seconds=done - ready,
        sample=partial(plate.sample, fields[:, :3]),
        reactions=reactions,
        energies={**by_part, "rod": rods.energy(u)} if scene.actuators else by_part,
        mesh=field_mesh(plate.nodes, plate.elements.nodes, fields[:, :3], director, **of_rods),
        history=(Iteration(1.0, solved.residual, 1.0),),
        load_factor=0.0 if singular else 1.0,
        actuators=wrenches,
        balance=None if singular else balance(scene, surface, rods, solved, reactions, edges),
        remarks=notes,
    )


class _Posed(NamedTuple):
    """What a plate is solved for: forces, values where held, and the free ones of all unknowns (N,)."""

    supports: Supports
    rods: PlateRods
    force: np.ndarray
    u: np.ndarray
    free: np.ndarray


def equilibrium(scene: Scene, plate: Plate) -> tuple[np.ndarray, Status, Sequence[str]]:
    """The unknowns (N,) under the full load, the status and notes."""
    solved, status, notes = _solve(scene, plate, _pose(scene, plate))
    return solved.u, status, notes


def _pose(
    scene: Scene, plate: Plate, hard_edges: tuple[str, ...] = (), section: Section | None = None
) -> _Posed:
    along = rod.of_scene(scene, plate.plan)
    rods = PlateRods.on(on_surface(along, len(plate.nodes)), len(plate.nodes))
    supports, held, fields = constrain(scene, plate, hard_edges, along)
    free = np.flatnonzero(~np.concatenate([held.ravel(), rods.held]))
    u = np.concatenate([fields.ravel(), np.zeros(len(rods.held))])
    force = rods.force(u.size)
    force[: fields.size] += nodal_forces(scene, plate).ravel()
    force += natural_of(scene, plate, section).force(force.size)
    return _Posed(supports, rods, force, u, free)


def _solve(
    scene: Scene, plate: Plate, posed: _Posed, section: Section | None = None
) -> tuple[Solved, Status, tuple[str, ...]]:
    u, force, free = posed.u, posed.force, posed.free
    status, notes = Status.CONVERGED, tuple[str, ...]()
    with one_blas_thread():
        stiffness = stiffness_matrix(scene, plate, section, posed.rods)
        try:
            u = solve_free(stiffness, force, u, free)
        except SingularMatrixError as error:
            status, notes = Status.SINGULAR, (str(error),)
    if status is Status.CONVERGED:
        of_plate = section or section_at(scene, plate.plan.corners)
        natural = natural_of(scene, plate, section).strains()[0]
        status, notes = judge(scene, plate.elements, of_plate, u, stiffness, free, natural)
    return Solved(stiffness, force, u, free), status, notes


def natural_of(scene: Scene, plate: Plate, section: Section | None = None) -> NaturalPlate:
    """Return what makes a scene's plate other than flat at rest."""
    corners = plate.plan.corners
    return NaturalPlate(scene, plate.elements, corners, section or section_at(scene, corners))


def section_stiffness(scene: Scene, plate: Plate, section: Section | None = None) -> dict[str, np.ndarray]:
    """Stiffness of the section by part, membrane, bending and shear, as `Section` has it."""
    return dict(zip(PARTS, section or section_at(scene, plate.plan.corners), strict=True))


def stiffness_matrix(
    scene: Scene, plate: Plate, section: Section | None = None, rods: PlateRods | None = None
) -> csr_matrix:
    """Stiffness of the free plate, (5 n, 5 n) [N/m, N, N·m], or of the plate and its rods."""
    sections = section_stiffness(scene, plate, section)
    areas, strains = plate.elements.areas, plate.strains()
    blocks = [integrated(b, sections[part], areas) for part, b in strains.items()]
    total = np.sum(blocks, axis=0)
    if rods is None or not rods.bound.rods:
        return _assemble(plate, total)
    size = 5 * plate.basis.N + len(rods.held)
    return Pattern(plate.elements.unknowns, rods.unknowns, size=size).matrix(total, rods.stiffness())


def mass_matrix(scene: Scene, plate: Plate) -> csr_matrix:
    """Consistent mass with rotary inertia: ρh on the displacements, ρh³/12 on the tilts, and the payloads';
    (5 n, 5 n)."""
    constants, (values, _) = constants_of(scene, plate.plan.corners), shape(*GAUSS)
    moved, turned = (plate.elements.areas * m for m in (constants.per_area, constants.rotary_per_area))
    products = np.einsum("imq,qa,qb->imab", np.array([moved] * 3 + [turned] * 2), values, values)
    payloads = carried.of_scene(scene, plate.plan)
    products[:3, payloads.elements] += payloads.by_place
    products[3:, payloads.elements] += payloads.by_turn[:2]
    return _assemble(plate, np.einsum("imab,ij->maibj", products, np.eye(5)))


def energies(scene: Scene, plate: Plate, u: np.ndarray, section: Section | None = None) -> dict[str, float]:
    """Membrane, bending and shear energy [J] of the unknowns u (5 n,)."""
    sections, areas = section_stiffness(scene, plate, section), plate.elements.areas
    own = dict(zip(PARTS, natural_of(scene, plate, section).strains(), strict=False))
    nodal = u[plate.elements.unknowns]
    out = {}
    for part, operator in plate.strains().items():
        strain = (operator @ nodal[:, None, :, None])[..., 0] - own.get(part, 0.0)
        force = (sections[part] @ strain[..., None])[..., 0]
        out[part] = 0.5 * float(np.einsum("mq,mqi,mqi", areas, strain, force))
    return out


def constrain(
    scene: Scene, plate: Plate, hard_edges: tuple[str, ...] = (), rods: Sequence[Rod] = ()
) -> tuple[Supports, np.ndarray, np.ndarray]:
    """The supports, which fields they hold (n, 5), and the prescribed values (n, 5), 0 where free.

    rods: of the scene, whose bases hold a node.
    """
    supports = rod.hold_bases(surface_supports.of_scene(scene, plate.basis.mesh), rods)
    held = np.column_stack([supports.position, supports.director[:, None] | supports.tilt])
    for name in hard_edges:
        held[edge_nodes(plate, name), TILT_X + EDGES[name].along_axis] = True
    values = np.zeros(held.shape)
    for driven in supports.driven:
        displacement, director = driven.edge.linear(driven.points)
        values[driven.nodes, : W + 1], values[driven.nodes, TILT_X:] = displacement, director[..., :2]
    values[:, : W + 1] += supports.shift
    return supports, held, values


def edge_nodes(plate: Plate, edge: str) -> np.ndarray:
    """Numbers of the nodes on an edge."""
    return plate.basis.get_dofs(edge).flatten()


def nodal_forces(scene: Scene, plate: Plate) -> np.ndarray:
    """Work-equivalent nodal forces [N] and couples [N·m], (n, 5), with the last factor of every history."""
    dead, followers = loads.of_scene(scene, plate.plan)
    return np.column_stack([dead, np.zeros((len(dead), 2))]) + on_flat_sheet(plate, followers)


def on_flat_sheet(plate: Plate, followers: Sequence[loads.Follower]) -> np.ndarray:
    """Nodal forces and couples (n, 5) of follower loads on the flat sheet."""
    nodes, element_nodes = plate.nodes, plate.elements.nodes
    force, flat = np.zeros((len(nodes), 5)), _flat(plate)
    for load in followers:
        on, pull = element_nodes[load.elements], load.force(flat[load.elements])
        np.add.at(force[:, :3], on, pull[:, :9])
        np.add.at(force[:, 3:], on, pull[:, 9:, :2])
    return force


def tangent_on_flat_sheet(plate: Plate, load: loads.Follower, size: int) -> csr_matrix:
    """The derivative (size, size) [N/m] of a follower load on positions alone, on the flat sheet."""
    blocks = np.zeros((len(plate.elements.nodes), 9, 5, 9, 5))
    blocks[:, :, :3, :, :3] = load.tangent(_flat(plate))[:, :9, :, :9]
    return _assemble(plate, blocks, size)


def _flat(plate: Plate) -> np.ndarray:
    """Positions and directors (m, 18, 3) of the elements' nodes."""
    flat = np.zeros((len(plate.elements.nodes), 18, 3))
    flat[:, :9, :2], flat[:, 9:, 2] = plate.plan.corners, 1.0
    return flat


def _assemble(plate: Plate, blocks: np.ndarray, size: int | None = None) -> csr_matrix:
    number = plate.elements.unknowns
    return Pattern(number, size=size or 5 * plate.basis.N).matrix(blocks.reshape(*number.shape, -1))
