"""What the integrator asks of a reference: a discrete sheet whose coordinates have a constant mass.

    M ü + g(q, u̇, t) ⊥ Z(q),     q: all coordinates, prescribed ones among them,     δq = Z(q) x

q are the nodes' vectors: displacements and, of a shell, directors, which are as many coordinates as a vector
has. |d| = 1 and what supports hold are constraints, and x the unknowns of the tangent space that they leave.
Since M does not depend on q there are no gyroscopic forces: they come from the constraint.

Viscous forces are those of the rate of strain under the elastic moduli, s = D (e + τ ė) with ė = B u̇ and τ
the material's `dashpot_time`, as every spring of a lattice has the damper τ k; `damping_rate` α adds α M u̇,
and the air its drag (`motion.drag`).
Their tangent leaves out how B changes with the shape, which is of the order of the turn in a step.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any, NamedTuple

import numpy as np
from scipy.sparse import csc_matrix, csr_matrix

from fem_reference.motion.drag import Drag
from fem_reference.motion.loads import Factor, factor_at, single_loads
from fem_reference.motion.relaxation import Memory, Strained
from fem_reference.motion.rods import MovingRods, at_rest
from fem_reference.shell.element import Element, weighed
from fem_reference.solid.element import Bricks
from fem_reference.surface.loads import Follower
from sheetbench.errors import BadInput, NoEquilibrium
from sheetbench.numerics.continuation.stability import require_stable
from sheetbench.numerics.direct import DirectSolver
from sheetbench.scenes import FieldMesh, Scene, Status, outside_model
from sheetbench.scenes.motion import NO_START, at_start, kinks, let_go, starts_flat
from sheetbench.scenes.natural_state import sources_of
from sheetbench.scenes.supports import held_axes, named

ROUNDED = 1e-9  # of a velocity, that slopes on both sides of a moment may differ by

Loaded = tuple[np.ndarray, list[Follower]]  # dead nodal forces (n, 3) and follower loads


@dataclass(frozen=True)
class Motion:
    """Coordinates, their rates, accelerations and the algorithm's (N,) at a time [s]; exerted: M a + g;
    memory: of the material's branches."""

    time: float
    q: np.ndarray
    v: np.ndarray
    a: np.ndarray
    algorithm: np.ndarray
    exerted: np.ndarray
    memory: np.ndarray = field(default_factory=lambda: np.zeros(0))


class Energies(NamedTuple):
    """Energies [J]; potential: of constant dead loads."""

    kinetic: float
    elastic: float
    potential: float


class Moving(ABC):
    """A reference in motion: N coordinates q [m, -] of n plan nodes, unknowns x; times in s, forces in N.

    conservative: whether the law of strain is linear in Green's strain; any_strain: whether it is meant for
    large strains. sheet_mass: what `damping_rate` acts
    on, without the mass of the chains, `rods`.
    """

    label: str
    model: str
    settings: dict[str, Any]
    conservative: bool
    any_strain: bool = False
    mass: csr_matrix
    sheet_mass: csr_matrix
    rods: MovingRods
    nodes: int
    unknowns: int

    def __init__(self, scene: Scene):
        self.memory = Memory(scene.material.branches)
        supports = tuple(support.model_copy(update={"motion": None}) for support in scene.supports)
        if self.memory and any(one.of.history is not None for one in sources_of(scene)):
            raise BadInput(
                f"{scene.natural_by}: with a history it takes no Maxwell branches; leave either out"
            )
        self.still = at_rest(scene.replace(loads=(), gravity=None, supports=supports))
        self._scene = scene
        self.kinks = np.array(kinks(scene))
        self._air = scene.air
        self._edge_motions = scene.motions().values()
        self.tau, self.alpha = scene.material.dashpot_time, scene.material.damping_rate
        self.dead: list[tuple[np.ndarray, Factor]] = []
        self.followers: list[tuple[Follower, Factor]] = []
        self._motions = [
            (name, held_axes(s), s.motion.course)
            for name, s in named(scene.supports).items()
            if s.motion is not None
        ]

    @property
    def longest(self) -> float:
        """The sheet's longer side [m]."""
        return max(self._scene.sheet.lengths)

    def carry(self, rods: MovingRods) -> None:
        """Take up the chains, once the sheet has its mass."""
        self.rods, self.sheet_mass = rods, self.mass
        if rods:
            self.mass = (self.mass + rods.mass()).tocsr()

    def load(self, scene: Scene, loaded: Callable[[Scene], Loaded]) -> None:
        """Take up a scene's loads but for those let go at the start; loaded: what a scene with one has."""
        for alone, factor in single_loads(let_go(scene)):
            nodal, followers = loaded(alone)
            dead = self.on_coordinates(nodal) + self.rods.weight(alone)
            self.dead += [(dead, factor)] if dead.any() else []
            self.followers += [(follower, factor) for follower in followers]

    def shift(self, edges: dict[str, tuple[np.ndarray, np.ndarray]], time: float, rate: bool) -> np.ndarray:
        """Displacement (n, 3) [m] of supports that move, or its rate; edges: nodes and axes of each."""
        out = np.zeros((self.nodes, 3))
        for edge, axes, over_time in self._motions:
            value = over_time.slope(time) if rate else over_time.at(time)
            out[np.ix_(edges[edge][0], np.array(axes))] = value[list(axes)]
        return out

    def jumps(self, time: float) -> bool:
        """Whether what is prescribed changes its velocity at once."""
        slopes = [(course.slope(time), course.slope(time, before=True)) for _, _, course in self._motions]
        turned = any(time in motion.time for motion in self._edge_motions)
        return turned or any(np.abs(a - b).max() > ROUNDED * np.abs([a, b]).max() for a, b in slopes)

    def start(self) -> np.ndarray:
        """q (N,) at t = 0: flat, or the equilibrium to start from (`sheetbench.scenes.motion`). Raises
        NoEquilibrium where there is no stable one."""
        if starts_flat(self._scene):
            return self.placed(np.zeros(self.mass.shape[0]), 0.0)
        q, status, notes = self.equilibrium(at_start(self._scene))
        try:
            require_stable(self.model, status, notes)
        except NoEquilibrium as error:
            raise NoEquilibrium(f"{NO_START}: {error}") from None
        return self.placed(q, 0.0)

    @abstractmethod
    def equilibrium(self, scene: Scene) -> tuple[np.ndarray, Status, Sequence[str]]:
        """q (N,) under the full load of a scene, of this one's sheet; how the path there ended, and notes."""

    @abstractmethod
    def placed(self, q: np.ndarray, time: float) -> np.ndarray:
        """q (N,) with what is prescribed at a time, on the constraints."""

    @abstractmethod
    def rate_placed(self, q: np.ndarray, v: np.ndarray, time: float) -> np.ndarray:
        """u̇ (N,) with what is prescribed from a time on, tangential to the constraints."""

    @abstractmethod
    def basis(self, q: np.ndarray) -> csc_matrix:
        """Z (N, unknowns)."""

    @abstractmethod
    def tangent(
        self, q: np.ndarray, v: np.ndarray, time: float, residual: np.ndarray, by_a: float, by_v: float
    ) -> csr_matrix:
        """Zᵀ (by_a M + by_v C + K) Z, and what the constraints add under a residual (N,)."""

    @abstractmethod
    def solver(self) -> DirectSolver:
        """What factorises tangents."""

    @abstractmethod
    def displacement(self, q: np.ndarray) -> np.ndarray:
        """Displacements (n, 3) [m] of the nodes."""

    @abstractmethod
    def sample(self, displacement: np.ndarray, points: np.ndarray) -> np.ndarray:
        """Mid-surface displacement (p, 3) [m] at plan points (p, 2) [m], of nodal ones (n, 3)."""

    @abstractmethod
    def reactions(self, exerted: np.ndarray) -> dict[str, np.ndarray]:
        """Forces (3,) [N] of what holds the sheet, of M ü + g (N,)."""

    @abstractmethod
    def mesh(self, displacement: np.ndarray) -> FieldMesh:
        """The sheet for drawing, of nodal displacements (n, 3)."""

    @abstractmethod
    def on_coordinates(self, dead: np.ndarray) -> np.ndarray:
        """Forces (N,) of dead ones on the mid-surface (n, 3)."""

    @abstractmethod
    def strains(self, q: np.ndarray) -> Strained:
        """Strains, and the elastic stresses that go with them, as `memory` takes them."""

    @abstractmethod
    def internal(self, q: np.ndarray, v: np.ndarray) -> np.ndarray:
        """Elastic and viscous forces (N,)."""

    @abstractmethod
    def following(self, q: np.ndarray, load: Follower) -> np.ndarray:
        """Forces (N,) of a follower load."""

    def inside_out(self, q: np.ndarray) -> str:
        """A sentence on the element that has turned inside out, "" for none."""
        return ""

    @abstractmethod
    def stretch(self, q: np.ndarray) -> float:
        """How far the sheet is strained, as `beyond` takes it."""

    def beyond(self, stretch: float) -> str:
        """A clause where the law of strain does not hold that far, else ""."""
        return "" if self.any_strain else outside_model(self._scene, stretch)

    @abstractmethod
    def elastic(self, q: np.ndarray) -> float:
        """Strain energy [J]."""

    @abstractmethod
    def stiffness_of(self, q: np.ndarray, step: np.ndarray, other: np.ndarray) -> float:
        """Δeᵀ D Δe' [J] of the strains of a step (N,) from q and of another one."""

    def grow(self, time: float) -> None:
        """Set the sheet's natural state to that at a time, where it has one."""
        return None

    @property
    def grows(self) -> bool:
        """Whether the natural state changes over time."""
        return False

    @abstractmethod
    def on_surface(self, v: np.ndarray) -> np.ndarray:
        """Velocities (m, 9, 3) of the mid-surface at the nodes of the plan's elements, of rates (N,)."""

    def drag(self, v: np.ndarray, by_v: float = 0.0) -> list[tuple[Follower, Factor]]:
        """The drag of the air at rates v (N,), if there is air, as a load beside `followers`."""
        return [(Drag(self._air.coefficient, self.on_surface(v), by_v), None)] if self._air else []

    def of_supports(self, exerted: np.ndarray) -> np.ndarray:
        """What supports and motions exert (N,) of M ü + g, which has no part along what is free."""
        return exerted

    def centripetal(self, q: np.ndarray, v: np.ndarray) -> np.ndarray:
        """The part (N,) of ü that the constraints demand at these velocities: none of coordinates held."""
        return np.zeros_like(q)

    def moved(self, q: np.ndarray, step: np.ndarray) -> np.ndarray:
        """q after a step Z x (N,), on the constraints."""
        return q + step

    def mean_internal(self, start: np.ndarray, end: np.ndarray, h: float) -> np.ndarray:
        """Elastic and viscous forces (N,) of the mean strains of a step and their mean rate."""
        return self.internal(0.5 * (start + end), (end - start) / h)

    def forces(self, q: np.ndarray, v: np.ndarray, time: float) -> np.ndarray:
        """g (N,): internal and viscous less external forces."""
        self.memory.now = time
        self.grow(time)
        return self._loaded(self.internal(q, v) + self.rods.forces(q, v, time), q, v, time)

    def mean_forces(self, start: np.ndarray, end: np.ndarray, h: float, time: float) -> np.ndarray:
        """g (N,) of the means of a step from one q to another: their strains' mean, not that of the mean."""
        q, v = 0.5 * (start + end), (end - start) / h
        self.grow(time)
        on_rods = self.rods.mean_forces(start, end, h, time)
        return self._loaded(self.mean_internal(start, end, h) + on_rods, q, v, time)

    def _loaded(self, out: np.ndarray, q: np.ndarray, v: np.ndarray, time: float) -> np.ndarray:
        """Internal forces (N,) less loads, and what resists in proportion to the mass."""
        for force, factor in self.dead:
            out = out - factor_at(factor, time) * force
        for follower, factor in [*self.followers, *self.drag(v)]:
            out = out - factor_at(factor, time) * self.following(q, follower)
        return out + self.alpha * (self.sheet_mass @ v) if self.alpha else out

    def energies(self, q: np.ndarray, v: np.ndarray, time: float) -> Energies:
        """Energies of a state."""
        self.memory.now = time
        self.grow(time)
        potential = -sum(float(force @ q) for force, factor in self.dead if factor is None)
        elastic = self.elastic(q) + self.rods.energy(q, time)
        stored = self.memory.stored(self.strains(q)) if self.memory else 0.0
        return Energies(0.5 * float(v @ (self.mass @ v)), elastic + stored, potential)

    def spent(self, start: Motion, end: Motion, late: float) -> np.ndarray:
        """Energy [J] that dampers dissipate in a step, and work [J] of what moves or acts over time, (2,):
        forces times changes, of dampers those that the step balances. late: the end's share in them."""
        h, step, middle = end.time - start.time, end.q - start.q, 0.5 * (start.q + end.q)
        rate = (1.0 - late) * start.v + late * end.v
        damped = self.tau * self.stiffness_of(middle, step, rate) if self.tau else 0.0
        damped += self.alpha * float(step @ (self.sheet_mass @ rate))
        damped += self.rods.dissipated(middle, step, rate)
        damped -= sum(float(self.following(middle, load) @ step) for load, _ in self.drag(step / h))
        self.memory.since(start.time, start.memory)
        self.memory.now = end.time
        self.grow(end.time)
        relaxed = self.memory.dissipated(self.strains(end.q)) if self.memory else 0.0
        exerted, half_way = 0.5 * (start.exerted + end.exerted), 0.5 * (start.time + end.time)
        work = float(self.of_supports(exerted) @ step)
        for q in (start.q, end.q):  # of commands, which bend the chains' shape at rest
            work += 0.5 * (self.rods.energy(q, end.time) - self.rods.energy(q, start.time))
        for sign, time in ((1.0, end.time), (-1.0, start.time)) if self.grows else ():
            self.grow(time)
            work += 0.5 * sign * (self.elastic(start.q) + self.elastic(end.q))
        for force, factor in self.dead:
            if factor is not None:
                work += factor_at(factor, half_way) * float(force @ step)
        for follower, factor in self.followers:
            work += factor_at(factor, half_way) * float(self.following(middle, follower) @ step)
        return np.array([damped + relaxed, work])


class MovingElements(Moving):
    """A reference whose elements' strains are quadratic in the coordinates."""

    element: Element | Bricks

    def grow(self, time: float) -> None:
        self.element.grow(time=time)

    @property
    def grows(self) -> bool:
        return self.element.grows

    @abstractmethod
    def gather(self, q: np.ndarray) -> np.ndarray:
        """Changes of the elements' vectors (m, a, 3) of coordinates (N,)."""

    @abstractmethod
    def scatter(self, pull: np.ndarray) -> np.ndarray:
        """Sums (N,) of what pulls at the elements' vectors (m, a, 3)."""

    def strains(self, q: np.ndarray) -> Strained:
        strain = self.element.strain(self.gather(q))
        return strain, self.element.stress(strain)

    def internal(self, q: np.ndarray, v: np.ndarray) -> np.ndarray:
        change = self.gather(q)
        return self.scatter(self.element.forces(change, self.stress(*self.strained(change, v))))

    def mean_internal(self, start: np.ndarray, end: np.ndarray, h: float) -> np.ndarray:
        before, after = self.gather(start), self.gather(end)
        first, last = self.element.strain(before), self.element.strain(after)
        stress = self.stress(0.5 * (first + last), (last - first) / h)
        return self.scatter(self.element.forces(0.5 * (before + after), stress))

    def elastic(self, q: np.ndarray) -> float:
        return sum(self.element.energies(self.element.strain(self.gather(q))).values())

    def stiffness_of(self, q: np.ndarray, step: np.ndarray, other: np.ndarray) -> float:
        at = self.gather(q)
        (strain, change), (_, other_change) = self.strained(at, step), self.strained(at, other)
        return float(np.sum(change * weighed(self.element.moduli(strain), other_change)))

    def strained(self, change: np.ndarray, v: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Strains (m, k) at changes (m, a, 3) of the elements' vectors, and their rates at rates (N,)."""
        return self.element.strain(change), self.element.step(change, self.gather(v))

    def stress(self, strain: np.ndarray, rate: np.ndarray) -> np.ndarray:
        """s + τ D ė (m, k) and what the branches add."""
        elastic = self.element.stress(strain)
        stress = elastic + self.memory.added(elastic) if self.memory else elastic
        return stress + self.tau * weighed(self.element.moduli(strain), rate) if self.tau else stress
