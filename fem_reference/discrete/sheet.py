"""Discrete sheet: coordinates with a constant mass, forces that depend on them, prescribed displacements.

    M ü + g(q, u̇, t) ⊥ Z(q),     g = internal − external forces,     δq = Z(q) x

q are the nodes' vectors: displacements and, of a shell, directors with three coordinates each. |d| = 1 and
the supports are constraints; x are the unknowns of the remaining tangent space. M does not depend on q, so
that there are no gyroscopic forces: they come from the constraint. Statics are the sheet at rest with the
load factor in place of the time (`discrete.static`), modes use its tangent.

Viscous stresses come from the rate of strain under the elastic moduli, s = D (e + τ ė) with ė = B u̇ and τ
the material's `dashpot_time`, as every spring of a lattice has the damper τ k; `damping_rate` α adds α M u̇.
Their tangent neglects the change of B with the shape, which is of the order of the turn in a step. Elements
(`discrete.elements`) and rods (`discrete.rods`) exert the internal forces, `items` the external ones.
"""

from abc import ABC, abstractmethod
from collections.abc import Callable
from functools import cached_property
from typing import Any, ClassVar, Self

import numpy as np
from scipy.sparse import csc_matrix, csr_matrix

from fem_reference.discrete.contact import ObstacleContact
from fem_reference.discrete.course import Factor, commands_of, factor_at, loads_of
from fem_reference.discrete.items import DeadLoad, Drag, FollowerLoad, SheetItem
from fem_reference.discrete.rods import Rods
from fem_reference.discrete.shape import SheetShape
from fem_reference.surface import loads, rod
from fem_reference.surface.actuator_forces import HoldingForces, RodOnEdge, exerted
from fem_reference.surface.balance import Surface
from fem_reference.surface.location import interpolate
from fem_reference.surface.mesh import Elements, Plan, divisions
from fem_reference.surface.rod import BoundRods
from fem_reference.surface.supports import Supports
from sheetbench.answers.solution import FieldMesh
from sheetbench.scenes import Scene, outside_model
from sheetbench.scenes.meaning.natural_state import NaturalState
from sheetbench.scenes.objects.relaxation import Branches, BranchStep

UP = np.array([0.0, 0.0, 1.0])


class Discrete(ABC):
    """Sheet of N = `size` coordinates q [m, -] at n plan nodes: positions, then directors from
    `first_director`.

    Unknowns are x; forces in N; at: load factor or time [s]. norm: order of the norm that residuals are
    measured in; linear: strains are linear in the coordinates, and loads act on the flat sheet. any_strain:
    whether the law of strain is meant for large strains. longer_side: the flat sheet's longer side [m].
    own_outline: whether the mesh has its outline in place of the scene's sheet. bodies: the rods, if any;
    commanded: the scene whose chains have the curvatures that the commands' factors multiply."""

    model: ClassVar[str]
    norm: ClassVar[int]
    linear: ClassVar[bool] = False
    label: str
    settings: dict[str, Any]
    any_strain: bool = False
    own_outline: bool = False
    natural: NaturalState | None = None
    plan: Plan
    size: int
    first_director: int
    supports: Supports
    rods: Rods
    unknowns: int

    def __init__(self, scene: Scene, moving: bool = False):
        self.scene, self.moving = scene, moving
        self.label, self.settings = self.model, {}
        self.commanded, self._commands = commands_of(scene, moving)
        material = scene.material
        self.branches = material.branches if moving else Branches((), ())
        self.tau, self.alpha = (material.dashpot_time, material.damping_rate) if moving else (0.0, 0.0)
        self.items: list[SheetItem] = []
        self.weights: list[tuple[np.ndarray, Factor]] = []

    def named(self, elements: Elements, through: str = "", **settings: Any) -> Self:
        """Return the sheet with its label and the settings it was made by, without settings that are None."""
        counts, sheet = divisions(self.scene.sheet, elements), self.scene.sheet
        if sheet.mesh is not None and "graded" in settings:
            settings["graded"] = False
        self.label = f"{self.model} {counts[0]} × {counts[1]}{through}"
        given = {name: value for name, value in settings.items() if value is not None}
        self.settings = {"elements": list(counts), **given}
        return self

    def rebuild(self) -> Callable[[], Self] | None:
        """Return a function that builds the sheet again, to compute derivatives, or None for a sheet
        without."""
        return None

    def bound_rods(self) -> BoundRods:
        """Return the rods on the sheet."""
        rods, n = rod.of_scene(self.commanded, self.plan), self.nodes
        return rod.bound(rods, 9, 2 * n, lambda one: (one.elements, np.hstack([one.nodes, n + one.nodes])))

    def bind(self, bound: BoundRods, places: np.ndarray | None = None) -> None:
        """Create the chains and all loads, once the sheet has its plan and N coordinates."""
        scene, moving = self.scene, self.moving
        self.rods = rods = Rods(scene, bound, self.size, self._commands, places, self.linear)
        self.bodies = [rods] if bound.rods else []
        for part, factor in loads_of(scene, moving):
            nodal, followers = loads.of_scene(part, self.plan)
            dead = self.on_coordinates(nodal)
            for body in self.bodies:
                self.weights.append((body.weight(part), factor))
                dead = dead + body.scatter(self.weights[-1][0])
            self.items += [DeadLoad(dead, factor)] if dead.any() else []
            self.items += [FollowerLoad(load, factor) for load in followers]
        if moving and scene.air:
            self.items.append(Drag(scene.air.coefficient))
        common, bodies = (scene, self.plan, moving, self.model == "solid"), scene.named_obstacles().items()
        self.contacts = [ObstacleContact(*common, *obstacle) for obstacle in bodies if not self.linear]
        self.items += self.contacts

    @property
    def nodes(self) -> int:
        """Number of the plan's nodes."""
        return len(self.plan.nodes)

    @cached_property
    def flat(self) -> np.ndarray:
        """Positions (n, 3) [m] of the nodes of the flat sheet."""
        return np.column_stack([self.plan.nodes, np.zeros(self.nodes)])

    @cached_property
    def longer_side(self) -> float:
        """Longer side of the flat sheet [m]."""
        return float(np.ptp(self.plan.nodes, axis=0).max())

    @cached_property
    def scale(self) -> np.ndarray:
        """Scale (N,) of coordinates: 1 for positions, the longer_side for directors."""
        return np.where(np.arange(self.size) < self.first_director, 1.0, self.longer_side)

    @property
    def symmetric(self) -> bool:
        """Return whether the tangent is symmetric: loads that follow the sheet make it unsymmetric, unless
        they have a potential or the sheet is linear."""
        return self.linear or all(item.conservative for item in self.items)

    @property
    @abstractmethod
    def sheet_mass(self) -> csr_matrix:
        """Return M (N, N) of the sheet, on which `damping_rate` acts, and its payloads."""

    @cached_property
    def mass(self) -> csr_matrix:
        """Return M (N, N) with the chains' mass."""
        return sum((body.mass() for body in self.bodies), self.sheet_mass).tocsr()

    # prescribed displacements and the unknowns

    def instant(self, at: float) -> tuple[float, float | None]:
        """Return the load factor of bent and tilted edges, and the time [s] of moved ones, None at the
        end."""
        return (1.0, at) if self.moving else (at, None)

    def jumps(self, time: float) -> bool:
        """Return whether a prescribed velocity jumps at a time [s]."""
        turned = any(time in motion.time for motion in self.scene.motions().values())
        return turned or self.supports.jumps(time)

    @abstractmethod
    def gap_step(self, shape: SheetShape) -> np.ndarray:
        """Return the linear correction (N,) that satisfies the prescribed displacements and the
        constraints."""

    def on_supports(self, q: np.ndarray, at: float) -> np.ndarray:
        """Return q (N,) corrected to satisfy the prescribed displacements and the constraints."""
        return self.moved(q, self.gap_step(self.shape(q, at)))

    @abstractmethod
    def constrained_rate(self, q: np.ndarray, v: np.ndarray, time: float) -> np.ndarray:
        """Return the rates v (N,) with the prescribed velocities from a time on, projected to the tangent of
        the constraints."""

    @abstractmethod
    def basis(self, q: np.ndarray, at: float = 0.0) -> csc_matrix:
        """Return the matrix Z (N, unknowns), δq = Z x."""

    def moved(self, q: np.ndarray, step: np.ndarray) -> np.ndarray:
        """Return q (N,) after a step Z x (N,), brought back onto the constraints."""
        return q + step

    def centripetal(self, q: np.ndarray, v: np.ndarray) -> np.ndarray:
        """Return the part (N,) of ü that the constraints demand at velocities v, 0 for held coordinates."""
        return np.zeros_like(q)

    def of_supports(self, exerted: np.ndarray) -> np.ndarray:
        """Return the part (N,) of M ü + g that supports and motions exert, zero along free coordinates."""
        return exerted

    # forces

    def shape(
        self, q: np.ndarray, at: float, v: np.ndarray | None = None, branches: BranchStep | None = None
    ) -> SheetShape:
        """Return the sheet at coordinates and rates (N,), at the end of a step of its branches."""
        return SheetShape(self, q, at, v, branches)

    def external(self, shape: SheetShape) -> np.ndarray:
        """Return forces (N,) of all items."""
        return sum((item.force(shape) for item in self.items), np.zeros(self.size))

    def item_support_forces(self, shape: SheetShape) -> dict[str, tuple[np.ndarray, np.ndarray]]:
        """Return the positions (k, 3) [m] and forces (k, 3) [N] by which items support the sheet, by name."""
        held = {name: pair for item in self.items for name, pair in item.support_forces(shape).items()}
        return {name: (at.reshape(-1, 3), force.reshape(-1, 3)) for name, (at, force) in held.items()}

    def wrenches(
        self, shape: SheetShape, residual: np.ndarray, a: np.ndarray | None = None
    ) -> tuple[list[RodOnEdge], dict[str, np.ndarray], np.ndarray]:
        """Return the rods' forces on their edges, the wrenches of the actuators' segments, and the line force
        (n, 3) [N/m]. A wrench is the force and moment (segments, 6) [N, N·m] on the sheet. residual: M ü + g
        (N,); a: ü (N,), 0 by default."""
        edges = list[RodOnEdge]()
        for body in self.bodies:
            pull = body.pull(shape.q, body.stress(shape))
            for weight, factor in self.weights:
                pull = pull - factor_at(factor, shape.at) * weight
            edges += self.on_edges(shape.q, pull if a is None else pull + body.inertial(a))
        held = self.exerted(shape.q, residual)
        return edges, *exerted(self.scene, edges, self.supports.moved, held)

    @property
    @abstractmethod
    def onto_surface(self) -> csr_matrix:
        """Derivatives (6 n, N), constant, of nodes' positions φ, then directors d, by the coordinates."""

    def on_coordinates(self, dead: np.ndarray) -> np.ndarray:
        """Return forces (N,) from dead forces on the mid-surface (n, 3), or on it and directors (2 n, 3)."""
        return np.asarray(self.onto_surface.T @ np.append(dead, np.zeros(6 * self.nodes - dead.size)))

    @abstractmethod
    def of_vectors(self, displacement: np.ndarray, turn: np.ndarray) -> np.ndarray:
        """Return coordinates (N,) from displacements and changes of directors (n, 3) at the plan's nodes."""

    @cached_property
    def both(self) -> np.ndarray:
        """Indices (m, 18) of φ, then d at the nodes of the plan's elements among all nodes (2 n,)."""
        return np.concatenate([self.plan.elements, self.nodes + self.plan.elements], axis=1)

    def on_surface(self, q: np.ndarray) -> np.ndarray:
        """Return position φ and director d (m, 18, 3) at the nodes of the plan's elements."""
        surface = self.surface(q)
        return np.concatenate([surface.position, surface.director])[self.both]

    def surface_change(self, change: np.ndarray) -> np.ndarray:
        """Return the change (m, 18, 3) of φ and d with a change of the coordinates (N,)."""
        return (self.onto_surface @ change).reshape(-1, 3)[self.both]

    def of_surface(self, on: np.ndarray, pull: np.ndarray) -> np.ndarray:
        """Return forces (N,) from forces (k, 18, 3) on φ and d of elements `on`."""
        components = 3 * self.both[on][:, :, None] + np.arange(3)
        nodal = np.bincount(components.ravel(), pull.ravel(), 6 * self.nodes)
        return np.asarray(self.onto_surface.T @ nodal)

    # results

    def displacement(self, q: np.ndarray) -> np.ndarray:
        """Return displacements (k, 3) [m] of the nodes, a view of q."""
        return q[: self.first_director].reshape(-1, 3)

    def middles(self, displacement: np.ndarray) -> np.ndarray:
        """Return mid-surface displacements (n, 3) [m] of the plan's nodes from displacements of all nodes."""
        return displacement

    def sample(self, displacement: np.ndarray, points: np.ndarray) -> np.ndarray:
        """Return mid-surface displacements (p, 3) [m] at plan points (p, 2) [m] from all nodes'."""
        return interpolate(self.plan.mesh, self.plan.elements, self.middles(displacement), points)

    def touched_without_kinks(self, shape: SheetShape) -> bool:
        """Return whether an obstacle touches the sheet's mid-surface of `tangent_planes`."""
        return any(one.bent and one.potential(shape) > 0.0 for one in self.contacts)

    def reactions(self, exerted: np.ndarray, at: float = 1.0) -> dict[str, np.ndarray]:
        """Return forces (3,) [N] of each support, from M ü + g (N,)."""
        return self.supports.reactions(self.displacement(exerted))

    @abstractmethod
    def drawn(self, q: np.ndarray, line_force: np.ndarray | None = None) -> FieldMesh:
        """Return the sheet as a mesh for drawing, with the line force (n, 3) [N/m] of actuators on it."""

    def mesh(self, displacement: np.ndarray) -> FieldMesh:
        """Return the sheet as a mesh for drawing, from displacements of all nodes."""
        q = np.zeros(self.size)
        self.displacement(q)[:] = displacement
        return self.drawn(q)

    def surface(self, q: np.ndarray) -> Surface:
        """Return the deformed mid-surface with its directors."""
        change = (self.onto_surface @ q).reshape(2, -1, 3)
        return Surface(self.plan, self.flat + change[0], UP + change[1], self.own_outline)

    @abstractmethod
    def exerted(self, q: np.ndarray, exerted: np.ndarray) -> HoldingForces:
        """Return force and couple on the nodes from g (N,)."""

    def on_edges(self, q: np.ndarray, pull: np.ndarray) -> list[RodOnEdge]:
        """Return the forces of rods on their edges, from forces (k, a, 3) on their sides' vectors."""
        edges, body = list[RodOnEdge](), self.rods
        for edge_rod, on in zip(body.bound.rods, body.bound.by_rod(np.arange(len(pull))), strict=True):
            edge_pull = np.zeros_like(pull)
            edge_pull[on] = -pull[on]
            nodal, position = self.exerted(q, body.scatter(edge_pull))
            director = np.zeros((len(edge_rod.line), 3))
            director[edge_rod.places] = body.directors(q)[on]
            edges.append(RodOnEdge(edge_rod, nodal[edge_rod.line], position[edge_rod.line], director))
        return edges

    @abstractmethod
    def holding(self, q: np.ndarray, exerted: np.ndarray, at: float) -> list[tuple[np.ndarray, np.ndarray]]:
        """Return pairs of positions and forces (…, 3) that hold the sheet, from g (N,); the nodes' pair is
        first."""

    # validity of a state

    def inverted_element(self, q: np.ndarray) -> str:
        """Return a sentence on an inverted element, "" if there is none."""
        return ""

    @abstractmethod
    def stretch(self, shape: SheetShape) -> float:
        """Return the measure of strain that is the argument of `beyond`."""

    def beyond(self, stretch: float) -> str:
        """Return a clause if a stretch exceeds the range of the law of strain, else ""."""
        return "" if self.any_strain else outside_model(self.scene, stretch)
