"""A discrete sheet: coordinates with a constant mass, forces that depend on them, what is prescribed.

    M ü + g(q, u̇, t) ⊥ Z(q),     g = internal − external forces,     δq = Z(q) x

q are the nodes' vectors: displacements and, of a shell, directors, which are as many coordinates as a vector
has. |d| = 1 and what supports hold are constraints, and x the unknowns of the tangent space that they leave.
Since M does not depend on q there are no gyroscopic forces: they come from the constraint. Statics are the
sheet at rest with the load factor in place of the time (`discrete.static`), modes those of its tangent.

Viscous forces are those of the rate of strain under the elastic moduli, s = D (e + τ ė) with ė = B u̇ and τ
the material's `dashpot_time`, as every spring of a lattice has the damper τ k; `damping_rate` α adds α M u̇.
Their tangent leaves out how B changes with the shape, which is of the order of the turn in a step.
Internal forces are those of the elements (`discrete.elements`) and of the rods (`discrete.rods`), external
ones those of `items`.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable
from functools import cached_property
from typing import Any, ClassVar, Self

import numpy as np
from scipy.sparse import csc_matrix, csr_matrix

from fem_reference.discrete.contact import Touching
from fem_reference.discrete.course import Factor, commands_of, factor_at, loads_of
from fem_reference.discrete.items import Dead, Drag, Following, SheetItem
from fem_reference.discrete.rods import Rods
from fem_reference.discrete.shape import SheetShape
from fem_reference.surface import loads, rod
from fem_reference.surface.actuator_forces import HoldingForces, OnEdge, exerted
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
    """N = `size` coordinates q [m, -] of n plan nodes, positions first, those of directors from
    `first_director` on; unknowns x; forces in N; at: load factor or time [s].

    norm: order of the norm that residuals are measured in; linear: strains are linear in the coordinates, and
    loads act on the flat sheet. any_strain: whether the law of strain is meant for large strains. lever: the
    flat sheet's longer side [m]. own: whether the mesh has an outline of its own, in place of the scene's
    sheet. bodies: the rods, if there are any; commanded: the scene whose chains have the curvatures that
    commands are times of.
    """

    model: ClassVar[str]
    norm: ClassVar[int]
    linear: ClassVar[bool] = False
    label: str
    settings: dict[str, Any]
    any_strain: bool = False
    own: bool = False
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
        """The sheet with its label, and with the settings it was made by, but for those that are nothing."""
        counts, sheet = divisions(self.scene.sheet, elements), self.scene.sheet
        if sheet.mesh is not None and "graded" in settings:
            settings["graded"] = False
        self.label = f"{self.model} {counts[0]} × {counts[1]}{through}"
        own = {name: value for name, value in settings.items() if value is not None}
        self.settings = {"elements": list(counts), **own}
        return self

    def again(self) -> Callable[[], Self] | None:
        """What makes the sheet anew, None of one without derivatives."""
        return None

    def bound_rods(self) -> BoundRods:
        """The rods on the sheet."""
        rods, n = rod.of_scene(self.commanded, self.plan), self.nodes
        return rod.bound(rods, 9, 2 * n, lambda one: (one.elements, np.hstack([one.nodes, n + one.nodes])))

    def bind(self, bound: BoundRods, places: np.ndarray | None = None) -> None:
        """Take up the chains and all loads, once the sheet has its plan and N coordinates."""
        scene, moving = self.scene, self.moving
        self.rods = rods = Rods(scene, bound, self.size, self._commands, places, self.linear)
        self.bodies = [rods] if bound.rods else []
        for alone, factor in loads_of(scene, moving):
            nodal, followers = loads.of_scene(alone, self.plan)
            dead = self.on_coordinates(nodal)
            for body in self.bodies:
                self.weights.append((body.weight(alone), factor))
                dead = dead + body.scatter(self.weights[-1][0])
            self.items += [Dead(dead, factor)] if dead.any() else []
            self.items += [Following(load, factor) for load in followers]
        if moving and scene.air:
            self.items.append(Drag(scene.air.coefficient))
        given, bodies = (scene, self.plan, moving, self.model == "solid"), scene.named_obstacles().items()
        self.contacts = [Touching(*given, *one) for one in bodies if not self.linear]
        self.items += self.contacts

    @property
    def nodes(self) -> int:
        return len(self.plan.nodes)

    @cached_property
    def flat(self) -> np.ndarray:
        """Places of the nodes at rest (n, 3) [m]."""
        return np.column_stack([self.plan.nodes, np.zeros(self.nodes)])

    @cached_property
    def lever(self) -> float:
        return float(np.ptp(self.plan.nodes, axis=0).max())

    @cached_property
    def scale(self) -> np.ndarray:
        """1 of positions (N,), of directors the lever."""
        return np.where(np.arange(self.size) < self.first_director, 1.0, self.lever)

    @property
    def symmetric(self) -> bool:
        """Whether the tangent is: loads that follow the sheet make it unsymmetric, unless they have a
        potential or the sheet is linear."""
        return self.linear or all(item.conservative for item in self.items)

    @property
    @abstractmethod
    def sheet_mass(self) -> csr_matrix:
        """M (N, N) of the sheet, which `damping_rate` acts on, and its payloads."""

    @cached_property
    def mass(self) -> csr_matrix:
        """M (N, N), the chains' mass in it."""
        return sum((body.mass() for body in self.bodies), self.sheet_mass).tocsr()

    # what is prescribed, and the unknowns

    def instant(self, at: float) -> tuple[float, float | None]:
        """The share of what bends and tilts edges, and the time [s] of what moves them, None for the last."""
        return (1.0, at) if self.moving else (at, None)

    def jumps(self, time: float) -> bool:
        """Whether what is prescribed changes its velocity at once."""
        turned = any(time in motion.time for motion in self.scene.motions().values())
        return turned or self.supports.jumps(time)

    @abstractmethod
    def short(self, shape: SheetShape) -> np.ndarray:
        """The step (N,) to what is prescribed and onto the constraints, linear in both."""

    def placed(self, q: np.ndarray, at: float) -> np.ndarray:
        """q (N,) with what is prescribed, on the constraints."""
        return self.moved(q, self.short(self.shape(q, at)))

    @abstractmethod
    def rate_placed(self, q: np.ndarray, v: np.ndarray, time: float) -> np.ndarray:
        """u̇ (N,) with what is prescribed from a time on, tangential to the constraints."""

    @abstractmethod
    def basis(self, q: np.ndarray, at: float = 0.0) -> csc_matrix:
        """Z (N, unknowns)."""

    def moved(self, q: np.ndarray, step: np.ndarray) -> np.ndarray:
        """q after a step Z x (N,), on the constraints."""
        return q + step

    def centripetal(self, q: np.ndarray, v: np.ndarray) -> np.ndarray:
        """The part (N,) of ü that the constraints demand at these velocities: none of coordinates held."""
        return np.zeros_like(q)

    def of_supports(self, exerted: np.ndarray) -> np.ndarray:
        """What supports and motions exert (N,) of M ü + g, which has no part along what is free."""
        return exerted

    # forces

    def shape(
        self, q: np.ndarray, at: float, v: np.ndarray | None = None, branches: BranchStep | None = None
    ) -> SheetShape:
        """The sheet at coordinates and rates (N,), at the end of a step of its branches."""
        return SheetShape(self, q, at, v, branches)

    def external(self, shape: SheetShape) -> np.ndarray:
        """Forces (N,) of all items."""
        return sum((item.force(shape) for item in self.items), np.zeros(self.size))

    def held_by_items(self, shape: SheetShape) -> dict[str, tuple[np.ndarray, np.ndarray]]:
        """Where (k, 3) [m], and with which forces (k, 3) [N], items hold the sheet, by their names."""
        held = {name: both for item in self.items for name, both in item.holds(shape).items()}
        return {name: (at.reshape(-1, 3), force.reshape(-1, 3)) for name, (at, force) in held.items()}

    def wrenches(
        self, shape: SheetShape, residual: np.ndarray, a: np.ndarray | None = None
    ) -> tuple[list[OnEdge], dict[str, np.ndarray], np.ndarray]:
        """What the rods exert on their edges; the force and moment (segments, 6) [N, N·m] of every actuator's
        segments on the sheet; the line force (n, 3) [N/m]. residual: M ü + g (N,); a: ü (N,), 0 unless given.
        """
        edges = list[OnEdge]()
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
        """Derivatives (6 n, N) of the nodes' positions φ, then their directors d, by the coordinates, which
        they are linear in."""

    def on_coordinates(self, dead: np.ndarray) -> np.ndarray:
        """Forces (N,) of dead ones on the mid-surface (n, 3), or on that and its directors (2 n, 3)."""
        return np.asarray(self.onto_surface.T @ np.append(dead, np.zeros(6 * self.nodes - dead.size)))

    @abstractmethod
    def of_vectors(self, displacement: np.ndarray, turn: np.ndarray) -> np.ndarray:
        """Coordinates (N,) of displacements and changes of the directors of the plan's nodes, (n, 3)."""

    @cached_property
    def both(self) -> np.ndarray:
        """φ, then d at the nodes of the plan's elements (m, 18), among those of all nodes (2 n,)."""
        return np.concatenate([self.plan.elements, self.nodes + self.plan.elements], axis=1)

    def on_surface(self, q: np.ndarray) -> np.ndarray:
        """Position φ and director d at the nodes of the plan's elements, (m, 18, 3)."""
        surface = self.surface(q)
        return np.concatenate([surface.position, surface.director])[self.both]

    def surface_change(self, change: np.ndarray) -> np.ndarray:
        """Their change (m, 18, 3) with the coordinates (N,)."""
        return (self.onto_surface @ change).reshape(-1, 3)[self.both]

    def of_surface(self, on: np.ndarray, pull: np.ndarray) -> np.ndarray:
        """Forces (N,) of those on φ and d of elements `on`, (k, 18, 3)."""
        components = 3 * self.both[on][:, :, None] + np.arange(3)
        nodal = np.bincount(components.ravel(), pull.ravel(), 6 * self.nodes)
        return np.asarray(self.onto_surface.T @ nodal)

    # what is shown

    def displacement(self, q: np.ndarray) -> np.ndarray:
        """Displacements (k, 3) [m] of the nodes, a view."""
        return q[: self.first_director].reshape(-1, 3)

    def middles(self, displacement: np.ndarray) -> np.ndarray:
        """Those (n, 3) [m] of the plan's nodes on the mid-surface."""
        return displacement

    def sample(self, displacement: np.ndarray, points: np.ndarray) -> np.ndarray:
        """Mid-surface displacement (p, 3) [m] at plan points (p, 2) [m], of nodal ones as `displacement`."""
        return interpolate(self.plan.mesh, self.plan.elements, self.middles(displacement), points)

    def reactions(self, exerted: np.ndarray, at: float = 1.0) -> dict[str, np.ndarray]:
        """Forces (3,) [N] of what holds the sheet, of M ü + g (N,)."""
        return self.supports.reactions(self.displacement(exerted))

    @abstractmethod
    def drawn(self, q: np.ndarray, line_force: np.ndarray | None = None) -> FieldMesh:
        """The sheet for drawing, and the line force (n, 3) [N/m] of actuators on it."""

    def mesh(self, displacement: np.ndarray) -> FieldMesh:
        """The sheet for drawing, of nodal displacements as `displacement`."""
        q = np.zeros(self.size)
        self.displacement(q)[:] = displacement
        return self.drawn(q)

    def surface(self, q: np.ndarray) -> Surface:
        """The sheet as it lies."""
        change = (self.onto_surface @ q).reshape(2, -1, 3)
        return Surface(self.plan, self.flat + change[0], UP + change[1], self.own)

    @abstractmethod
    def exerted(self, q: np.ndarray, exerted: np.ndarray) -> HoldingForces:
        """Force and couple on the nodes of g (N,)."""

    def on_edges(self, q: np.ndarray, pull: np.ndarray) -> list[OnEdge]:
        """What the rods exert, which pull at their sides' vectors (k, a, 3)."""
        found, body = list[OnEdge](), self.rods
        for one, on in zip(body.bound.rods, body.bound.by_rod(np.arange(len(pull))), strict=True):
            own = np.zeros_like(pull)
            own[on] = -pull[on]
            nodal, position = self.exerted(q, body.scatter(own))
            director = np.zeros((len(one.line), 3))
            director[one.places] = body.directors(q)[on]
            found.append(OnEdge(one, nodal[one.line], position[one.line], director))
        return found

    @abstractmethod
    def holding(self, q: np.ndarray, exerted: np.ndarray, at: float) -> list[tuple[np.ndarray, np.ndarray]]:
        """Where, and with which forces of g (N,), the sheet is held, pairs (…, 3), its nodes first."""

    # when a state means nothing

    def inside_out(self, q: np.ndarray) -> str:
        """A sentence on the element that has turned inside out, "" for none."""
        return ""

    @abstractmethod
    def stretch(self, shape: SheetShape) -> float:
        """How far the sheet is strained, as `beyond` takes it."""

    def beyond(self, stretch: float) -> str:
        """A clause where the law of strain does not hold that far, else ""."""
        return "" if self.any_strain else outside_model(self.scene, stretch)
