"""The equations of motion of a scene on a lattice, for every integrator:

    M u̇̇ + f_damp(u, u̇) + f_int(u, t) + J(u)ᵀ λ = f_ext(u, t),   Φ(u) = 0,   u = T q + g(t).

u holds the masses' displacements, then the actuators' rows with their multipliers λ (`lumped.actuators`);
T and g come from supports and bindings, with Tᵀ M g = const: whole columns move with a support's `motion`.
M is diagonal on the lattice and constant throughout. Units: m, s, N, kg, J.
"""

from __future__ import annotations

from collections.abc import Callable
from copy import copy
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache

import numpy as np
import scipy.sparse as sp
from scipy.sparse.linalg import splu

from lumped.actuators import Drive
from lumped.carried import pairs_of, rotary_masses
from lumped.dynamics.damping import Damping
from lumped.dynamics.maxwell import Maxwell
from lumped.masses import masses
from lumped.springs.all_forces import add_forces
from lumped.springs.packing import pack, scratch
from lumped.statics.problem import Problem
from sheetbench.errors import BadInput
from sheetbench.scenes import Scene, held_axes, holds_director
from sheetbench.scenes.motion import kinks
from sheetbench.scenes.supports import named
from sheetbench.scenes.tables import PiecewiseCurve

ROUNDED = 1e-9  # of a velocity, that slopes on both sides of a moment may differ by, and of energies
NATURAL_STEP = 1e-3  # of a natural state, for the difference of energies


@dataclass(frozen=True)
class State:
    """Time [s], displacement, velocity and acceleration (size, 3), the last one beside that of what is
    prescribed; multiplier rows of u hold λ. memory: of
    the material's branches, where it has some (`lumped.dynamics.maxwell`)."""

    time: float
    u: np.ndarray
    v: np.ndarray
    a: np.ndarray
    memory: np.ndarray | None = None


class System:
    """Forces, mass and constraints of a scene in motion. mass: of every lumped mass, (n,) [kg], instead of
    its share of the sheet's and the payloads'.

    shared_mass: whether neighbours on the lattice share some, of bodies with moments of inertia. Forces are
    computed in arrays that it keeps (`scratch`), so a system is for one thread at a time; what it answers
    does not depend on the order of calls.
    """

    def __init__(self, scene: Scene, problem: Problem, mass: np.ndarray | None = None):
        self.scene, self.problem, self.assembly = scene, problem, problem.assembly
        self.coupling = problem.assembly.coupling
        self.items = problem.items
        self.pushed = any(item.moves for item in self.items)
        self.transform = problem.constraints.transform
        size, lattice = self.assembly.pattern.size, self.assembly.lattice
        shared = masses(scene, lattice, self.assembly.inertia, self.assembly.cells)
        self.lattice_mass = shared if mass is None else mass
        self.damping = Damping(scene, self.assembly, self.lattice_mass)
        self.natural = problem.assembly.natural  # whose springs' rest data change: they are not packed
        springs = self.assembly.springs if self.natural is None else ()
        self.packing = pack(lattice, springs, self.damping.dampers)
        self.scratch = scratch(self.packing)
        mass_blocks = np.zeros((self.assembly.pattern.blocks, 3, 3))
        own = self.assembly.pattern.diagonal[: lattice.mass_count]
        mass_blocks[own] = self.lattice_mass[:, None, None] * np.eye(3)
        bodies = rotary_masses(scene, lattice)
        self._bodies = self.assembly.pattern.slots(*pairs_of(bodies)), bodies.data
        self.shared_mass = bool(len(bodies.data))
        mass_blocks[self._bodies[0]] += bodies.data
        if self.coupling is not None:
            self._chain_mass = self.coupling.mass_blocks()[:, None, None] * np.eye(3)
            np.add.at(mass_blocks, self.assembly.coupling_slots, self._chain_mass)
        pattern = self.assembly.pattern
        self.mass = sp.csr_array(sp.bsr_array((mass_blocks, pattern.indices, pattern.indptr)))
        self.mass.eliminate_zeros()
        algebraic = np.zeros((size, 3), dtype=bool) if self.coupling is None else self.coupling.algebraic
        self.algebraic = abs(self.transform).T @ algebraic.ravel() > 0.0
        self.moving_part = sp.csr_array(self.transform[:, np.flatnonzero(~self.algebraic)])
        # every unknown is a component of u itself; bound and dependent components have several
        entries = self.moving_part.tocoo()
        single = np.bincount(entries.row, minlength=3 * size)[entries.row] == 1
        identity = single & (entries.data == 1.0)
        self._own = np.empty(self.moving_part.shape[1], dtype=int)
        self._own[entries.col[identity]] = entries.row[identity]
        self.reduced_mass = sp.csc_array(self.moving_part.T @ self.mass @ self.moving_part)
        self.solve_mass = _mass_solver(self.reduced_mass)
        branches = scene.material.branches
        self.maxwell = Maxwell(self.assembly.springs, branches) if branches.times else None
        if self.maxwell is not None and self.natural is not None and self.natural.state.moves:
            raise BadInput(
                f"{scene.natural_by}: with a history it takes no Maxwell branches; leave either out"
            )
        if self.maxwell is not None and self.assembly.precision == "single":
            raise BadInput("precision = 'single': takes no Maxwell branches; leave it out")
        others = self.maxwell is not None or self.natural is not None
        self._elastic_separate = others or self.assembly.precision == "single"
        # integrators ask for the same two moments several times a step
        self.place, self.place_rate = lru_cache(16)(self._place), lru_cache(16)(self._place_rate)
        self.motions = self._support_motions()
        self.moving = bool(self.motions or (self.coupling is not None and self.coupling.moved.any()))
        self._still = problem.constraints.turned(1.0)

    @property
    def working(self) -> bool:
        """Whether some loads have no potential: they follow the sheet, or change over time, as a natural
        state may."""
        return not self.problem.loads.potential or (self.natural is not None and self.natural.state.moves)

    @property
    def resists(self) -> bool:
        """Whether anything takes energy, but for branches."""
        return self.damping.present or any(item.resists for item in self.items)

    @property
    def constrained(self) -> bool:
        """Whether there are multipliers."""
        return bool(self.algebraic.any())

    @property
    def driven(self) -> np.ndarray:
        """Components (size, 3) bool that g(t) moves."""
        driven = np.zeros(self._still.shape, dtype=bool)
        for moved, axis, _ in self.motions:
            driven[moved, axis] = True
        if self.coupling is not None:
            driven[: self.coupling.masses][self.coupling.moved] = True
        return driven

    def drive(self, time: float) -> Drive:
        """The actuators' commands at a time."""
        return Drive(1.0, time)

    def _place(self, time: float) -> np.ndarray:
        """g(t), what supports and prescribed motions put in place, (size, 3) [m]; not to be written to."""
        if not self.moving:
            return self._still
        g = self._still.copy()
        for moved, axis, course in self.motions:
            g[moved, axis] = self._still[moved, axis] + course.at(time)[axis]
        if self.coupling is not None:
            g += self.coupling.driven(self.drive(time))
        return g

    def _place_rate(self, time: float, before: bool = False) -> np.ndarray:
        """Velocity of g from this moment on, or until then, (size, 3) [m/s]."""
        g = np.zeros_like(self._still)
        if not self.moving:
            return g
        for moved, axis, course in self.motions:
            g[moved, axis] = course.slope(time, before)[axis]
        if self.coupling is not None:
            g += self.coupling.driven_velocity(time)
        return g

    def place_acceleration(self, time: float) -> np.ndarray:
        """Acceleration of g from this moment on, of what supports move, (size, 3) [m/s²]."""
        g = np.zeros_like(self._still)
        for moved, axis, course in self.motions:
            g[moved, axis] = course.bend(time)[axis]
        return g

    def _support_motions(self) -> list[tuple[np.ndarray, int, PiecewiseCurve]]:
        """Masses, axis and displacement (3,) [m] of what supports move, an axis at a time."""
        found = []
        for name, support in named(self.scene.supports).items():
            if support.motion is not None:
                course = support.motion.course
                row = self.problem.constraints.holders[name][0].ravel()
                for axis in held_axes(support):
                    free = ~self.problem.constraints.fixed[row, axis]
                    found.append((row if holds_director(support) else row[free], axis, course))
        return found

    def internal(self, u: np.ndarray, v: np.ndarray, time: float) -> tuple[float, float, np.ndarray]:
        """Elastic energy, power taken by the dampers, and both their forces, actuators with their multipliers
        included."""
        energy, force = self.elastic(u, time) if self._elastic_separate else (0.0, np.zeros_like(u))
        stored, power = add_forces(
            u, v, not self._elastic_separate, self.packing.damped, self.packing, self.scratch, force
        )
        power += self.damping.add_other_forces(u, v, force)
        if self.coupling is not None and not self._elastic_separate:
            energy += self.coupling.add_force(u, self.drive(time), force)
        for item in self.items:
            energy += 0.0 if self._elastic_separate else item.add_force(u, self.drive(time), force)
            power += item.add_resistance(u, v, self.drive(time), force)
        return energy + stored, power, force

    @cached_property
    def kinks(self) -> np.ndarray:
        """Times at which something changes its course, sorted [s]."""
        return np.array(kinks(self.scene))

    def elastic(self, u: np.ndarray, time: float) -> tuple[float, np.ndarray]:
        """Elastic energy and internal force, actuators with their multipliers and branches included."""
        self.assembly.grow(time=time)
        force = np.zeros_like(u)
        if self.maxwell is not None:
            energy = self.maxwell.add_force(u, force)
        elif self._elastic_separate:
            energy, force = self.assembly.force(u)
        else:
            energy, _ = add_forces(u, u, True, False, self.packing, self.scratch, force)
        if self.coupling is not None:
            energy += self.coupling.add_force(u, self.drive(time), force)
        for item in self.items:
            energy += item.add_force(u, self.drive(time), force)
        return energy, force

    def damping_force(self, u: np.ndarray, v: np.ndarray, time: float) -> tuple[float, np.ndarray]:
        """Power taken and damping force."""
        force, power = np.zeros_like(u), 0.0
        if self.packing.damped:
            _, power = add_forces(u, v, False, True, self.packing, self.scratch, force)
        for item in self.items:
            power += item.add_resistance(u, v, self.drive(time), force)
        return power + self.damping.add_other_forces(u, v, force), force

    def power(self, state: State) -> float:
        """Power [W] that goes into dampers and branches."""
        power, _ = self.damping_force(state.u, state.v, state.time)
        if self.maxwell is not None and state.memory is not None:
            force = np.zeros_like(state.u)
            self.maxwell.add_branch_force(state.u, state.memory, force)
            power += float(np.sum(force * state.v))
        return power

    def external(self, u: np.ndarray, time: float) -> np.ndarray:
        """External force."""
        return self.problem.loads.force(u, time)

    def unbalanced(self, u: np.ndarray, v: np.ndarray, time: float) -> np.ndarray:
        """f_ext − f_int − f_damp − Jᵀλ; on multiplier rows −Φ."""
        return self.external(u, time) - self.internal(u, v, time)[2]

    def average_elastic(self, start: State, end: np.ndarray, time: float) -> np.ndarray:
        """Internal force whose work from `start` to the displacement `end` is the energy stored or, by
        branches, taken; commands and natural state as at `time`."""
        self.assembly.grow(time=time)
        force = self.assembly.average_force(start.u, end)
        if self.maxwell is not None and start.memory is not None:
            self.maxwell.add_mean_force(start.memory, 0.5 * (start.u + end), end, force)
        if self.coupling is not None:
            self.coupling.add_average_force(start.u, end, self.drive(time), force)
        for item in self.items:
            item.add_average_force(start.u, end, self._ends(start, time), force)
        return force

    def _ends(self, start: State, middle: float) -> tuple[Drive, Drive]:
        """The commands at both ends of a step."""
        return self.drive(start.time), self.drive(2.0 * middle - start.time)

    def matrix(
        self,
        u: np.ndarray,
        v: np.ndarray,
        time: float,
        mass: float,
        damping: float,
        stiffness: float,
        ends: tuple[State, np.ndarray] | None = None,
    ) -> np.ndarray:
        """Blocks of mass × M + damping × C + stiffness × K at a state; the constraints count once. ends: of a
        step of which the items have the average force's derivative by its end."""
        self.assembly.grow(time=time)
        own = stiffness if self.maxwell is None else stiffness * self.maxwell.gain
        both = own + damping * self.damping.time  # dampers in proportion stand where the springs do
        share, stresses = own / both if both else 0.0, None
        if self.maxwell is not None and both:
            each = self.maxwell.stresses(u, share, stiffness / both)
            stresses = self.assembly.all_families.arranged(each)
        inertia = mass * self.lattice_mass + damping * self.damping.rate
        blocks = self.assembly.tangent(u, stresses, share, both, inertia)
        self.problem.loads.add_tangent(u, stiffness, blocks, time)
        if self.shared_mass:
            blocks[self._bodies[0]] += mass * self._bodies[1]
        if not self.problem.conservative or self.coupling is not None:
            others = np.zeros_like(blocks)
            if not self.problem.conservative:
                self.damping.add_displacement_tangent(u, v, others)
            if self.coupling is not None:
                slots = self.assembly.coupling_slots
                self.coupling.add_tangent(u, self.drive(time), slots, others)
                np.add.at(blocks, slots, mass * self._chain_mass)
            blocks += stiffness * others
        self.damping.add_velocity_tangent(u, v, damping, blocks)
        for item in self.items:
            if ends is None:
                item.add_tangent(u, self.drive(time), stiffness, blocks)
            else:
                item.add_average_tangent(ends[0].u, ends[1], self._ends(ends[0], time), blocks)
            item.add_resistance_tangent(u, v, self.drive(time), damping, blocks)
        return blocks

    def within(self, state: State, ahead: float = 0.0) -> System:
        """Return the equations in a step of second order from a state, `ahead` [s] of it, as the branches
        have it."""
        if self.maxwell is None or state.memory is None:
            return self
        return self.with_branches(self.maxwell.step(state.memory, ahead))

    def with_branches(self, maxwell: Maxwell) -> System:
        """Return the equations with the branches in a step or stage."""
        other = copy(self)
        other.maxwell = maxwell
        return other

    def relaxed(self, before: State, after: State) -> tuple[State, float]:
        """The state at the end of a step of second order with its memory, and the energy [J] that the
        branches took in it."""
        if self.maxwell is None or before.memory is None:
            return after, 0.0
        self.assembly.grow(time=after.time)
        memory = self.maxwell.step(before.memory, after.time - before.time).after(after.u)
        return replace(after, memory=memory), self.maxwell.branches.dissipated(before.memory, memory)

    def reduce(self, force: np.ndarray) -> np.ndarray:
        """Force on the free unknowns that have mass."""
        reduced: np.ndarray = self.moving_part.T @ force.ravel()
        return reduced

    def expand(self, unknowns: np.ndarray) -> np.ndarray:
        """Displacement (size, 3) of the free unknowns that have mass; multiplier rows zero."""
        return (self.moving_part @ unknowns).reshape(-1, 3)

    def contract(self, displacement: np.ndarray) -> np.ndarray:
        """The free unknowns with mass of an admissible displacement (size, 3)."""
        return displacement.ravel()[self._own]

    def accelerate(self, force: np.ndarray) -> np.ndarray:
        """T M⁻¹ Tᵀ f, (size, 3) [m/s²]."""
        return self.expand(self.solve_mass(self.reduce(force)))

    def pushed_between(self, start: State, end: np.ndarray, middle: float) -> float:
        """Work [J] of what items are fixed to in a step of the conserving midpoint rule."""
        done, ends = 0.0, self._ends(start, middle)
        rate = (end - start.u) / (2.0 * (middle - start.time))
        for item in self.items:
            force = np.zeros_like(end)
            item.add_average_force(start.u, end, ends, force)
            item.add_resistance(0.5 * (start.u + end), rate, self.drive(middle), force)
            done -= item.work(force.sum(axis=0), start.time, 2.0 * middle - start.time)
        return done

    def pushing(self, state: State) -> float:
        """Power [W] of what items are fixed to, as it moves."""
        return sum(
            item.power(item.exerted(state.u, self.drive(state.time), state.v).sum(axis=0), state.time)
            for item in self.items
        )

    def balance(self, state: State) -> tuple[dict[str, float], np.ndarray]:
        """Kinetic, elastic and potential energy [J], of which only constant dead loads have the last; and
        M a + f_int + f_damp − f_ext, (size, 3): what supports and actuators exert on their masses."""
        elastic, _, force = self.within(state).internal(state.u, state.v, state.time)
        if self.maxwell is not None and state.memory is not None:
            elastic += self.maxwell.branches.stored(state.memory)
        v = state.v.ravel()
        energies = {
            "kinetic": 0.5 * float(v @ (self.mass @ v)),
            "elastic": elastic,
            "potential": -float(np.sum(self.problem.loads.dead * state.u)),
        }
        inertia: np.ndarray = (self.mass @ state.a.ravel()).reshape(-1, 3)
        return energies, inertia + force - self.external(state.u, state.time)

    def exerted(self, state: State) -> np.ndarray:
        """What supports and actuators exert on their masses, (size, 3)."""
        return self.balance(state)[1]

    def jumps(self, time: float) -> bool:
        """Whether what is prescribed changes its velocity at once."""
        if not self.moving:
            return False
        after = self.place_rate(time)
        jump = np.abs(after - self.place_rate(time, before=True)).max()
        return bool(jump > ROUNDED * np.abs(after).max())

    def kinetic_of(self, rate: np.ndarray) -> float:
        """Kinetic energy [J] of what is prescribed, at its velocities (size, 3) [m/s]."""
        return 0.5 * float(rate.ravel() @ (self.mass @ rate.ravel()))

    def kinetic_of_placed(self, state: State) -> float:
        """Kinetic energy [J] of what is prescribed, whose gain is work done on the masses: all but that of
        the free unknowns, which is apart since Tᵀ M ġ = 0."""
        momentum = self.mass @ state.v.ravel()
        free = self.moving_part.T @ momentum
        return 0.5 * float(state.v.ravel() @ momentum - free @ self.solve_mass(free))

    def work(self, before: State, after: State) -> float:
        """Work of moving supports, commands and loads without a potential in a step, by the trapezoidal rule
        [J]."""
        done = 0.0
        if self.moving:
            moved = self.place(after.time) - self.place(before.time)
            done += 0.5 * float(np.sum((self.exerted(before) + self.exerted(after)) * moved))
            done += self.kinetic_of_placed(after) - self.kinetic_of_placed(before)
        if self.working:
            mean = 0.5 * (self.external(before.u, before.time) + self.external(after.u, after.time))
            done += float(np.sum((mean - self.problem.loads.dead) * (after.u - before.u)))
        for item in self.items if self.pushed else ():
            ends = (item.exerted(s.u, self.drive(s.time), s.v).sum(axis=0) for s in (before, after))
            done += item.work(0.5 * sum(ends, np.zeros(3)), before.time, after.time)
        if self.coupling is not None:
            then, now = self.drive(before.time), self.drive(after.time)
            for u in (before.u, after.u):
                done += 0.5 * self.coupling.command_work(u, then, now)
        for u in (before.u, after.u) if self.natural is not None else ():
            done += 0.5 * self.natural_work(u, before.time, after.time)
        return done

    @property
    def least_energy(self) -> float:
        """Energy [J] below which all is rounding: of a natural state, in whose shape there is none."""
        if self.natural is None:
            return 0.0
        self.assembly.grow()
        return ROUNDED * self.assembly.force(np.zeros_like(self._still))[0]

    def natural_work(self, u: np.ndarray, then: float, now: float) -> float:
        """Work [J] of a natural state that changes while the sheet stays at u (n, 3) [m]."""
        if self.natural is None or not self.natural.state.moves:
            return 0.0
        energies = []
        for time in (then, now):
            self.assembly.grow(time=time)
            energies.append(self.assembly.force(u)[0])
        return energies[1] - energies[0]

    def natural_power(self, u: np.ndarray, time: float, before: bool = False) -> float:
        """Return its power [W] from a moment on, or until then: of a difference that is exact but for third
        powers of the change."""
        if self.natural is None or not self.natural.state.moves:
            return 0.0
        at, rate = self.natural.state.factors(time), self.natural.state.rates(time, before)
        if not rate.any():
            return 0.0
        step = NATURAL_STEP / np.abs(rate).max()
        energies = []
        for sign in (1.0, -1.0):
            self.natural.set(at + sign * step * rate)
            energies.append(self.assembly.force(u)[0])
        return (energies[0] - energies[1]) / (2.0 * step)


def _mass_solver(mass: sp.csc_array) -> Callable[[np.ndarray], np.ndarray]:
    diagonal = mass.diagonal()
    if mass.nnz == len(diagonal):
        return lambda b: b / diagonal
    factors = splu(mass)
    return lambda b: factors.solve(b)
