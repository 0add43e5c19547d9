"""The equations of motion of a scene on a lattice, for every integrator:

    M u̇̇ + f_damp(u, u̇) + f_int(u, t) + J(u)ᵀ λ = f_ext(u, t),   Φ(u) = 0,   u = T q + g(t).

u holds the masses' displacements, then the actuators' rows with their multipliers λ (`lumped.actuators`);
T and g come from supports and bindings, with Tᵀ M g = const: whole columns move with a support's `motion`.
M is diagonal on the lattice and constant throughout. Units: m, s, N, kg, J.
"""

from collections.abc import Callable, Sequence
from copy import copy
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Self

import numpy as np
import scipy.sparse as sp
from scipy.sparse.linalg import splu

from lumped.actuators import Drive
from lumped.dynamics.damping import Damping, MovingForces, add_forces
from lumped.dynamics.maxwell import Maxwell
from lumped.dynamics.prescribed_motion import PrescribedMotion
from lumped.items import Deformed
from lumped.masses import masses
from lumped.payloads import pairs_of, rotary_masses
from lumped.springs.packing import pack, scratch
from lumped.statics.problem import Problem
from sheetbench.numerics.options import typed
from sheetbench.numerics.sparse_products import csr_arrays, product
from sheetbench.scenes import Scene
from sheetbench.scenes.meaning.motion import kinks


@dataclass(frozen=True)
class State:
    """State of a system in motion.

    Parameters
    ----------
    time : float
        Time [s].
    u, v, a : ndarray of shape (size, 3)
        Displacement [m], velocity [m/s] and acceleration [m/s²] without the prescribed one; multiplier rows
        of u hold λ.
    memory : ndarray, optional
        Memory of the material's branches (`lumped.dynamics.maxwell`).
    """

    time: float
    u: np.ndarray
    v: np.ndarray
    a: np.ndarray
    memory: np.ndarray | None = None


class System:
    """Forces, mass and constraints of a scene in motion.

    Forces are computed in arrays that the system keeps (`forces`), so it is for one thread at a time; results
    do not depend on the order of calls.

    Parameters
    ----------
    scene : Scene
        Scene of the motion.
    problem : Problem
        Lattice of the scene under its supports and loads.
    mass : ndarray of shape (n,), optional
        Lumped masses [kg]; by default their shares of the sheet and the payloads.

    Attributes
    ----------
    shared_mass : bool
        Whether neighbours on the lattice share mass, of bodies with moments of inertia.
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
        self.natural = problem.assembly.natural
        branches = scene.material.branches
        self.maxwell = Maxwell(self.assembly.springs, branches) if branches.times else None
        # whether the compiled loops over `packing` compute the springs' forces
        self.packed = self.maxwell is None and self.natural is None and self.assembly.conservative
        self.packing = pack(lattice, self.assembly.springs if self.packed else (), self.damping.dampers)
        room, damping = scratch(self.packing), self.damping
        self.forces = typed(MovingForces(self.packing, room, damping.rate, damping.drag))
        mass_blocks = np.zeros((self.assembly.pattern.blocks, 3, 3))
        diagonal = self.assembly.pattern.diagonal[: lattice.mass_count]
        mass_blocks[diagonal] = self.lattice_mass[:, None, None] * np.eye(3)
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
        self.mass_rows = csr_arrays(self.mass)
        # multipliers carry the rounding of inertia forces
        self.placed = np.ones((size, 3), dtype=bool) if self.coupling is None else ~self.coupling.algebraic
        self.algebraic = abs(self.transform).T @ ~self.placed.ravel() > 0.0
        self.moving_part = sp.csr_array(self.transform[:, np.flatnonzero(~self.algebraic)])
        self.reduced_mass = sp.csc_array(self.moving_part.T @ self.mass @ self.moving_part)
        self.solve_mass = _mass_solver(self.reduced_mass)
        self.growing = self.natural if self.natural is not None and self.natural.moves else None
        self.prescribed = PrescribedMotion(scene, problem)

    @property
    def nonconservative(self) -> bool:
        """Return whether there is no potential: loads follow the sheet or change over time, or a natural
        state changes."""
        return not self.problem.loads.potential or self.growing is not None

    @property
    def resists(self) -> bool:
        """Return whether there is dissipation other than by branches."""
        return self.damping.present or any(item.resists for item in self.items)

    @property
    def constrained(self) -> bool:
        """Return whether there are multipliers."""
        return bool(self.algebraic.any())

    def drive(self, time: float) -> Drive:
        """Return the actuators' commands at a time."""
        return Drive(1.0, time)

    def internal(
        self, u: np.ndarray, v: np.ndarray, time: float, elastic: bool = True, damped: bool = True
    ) -> tuple[float, float, np.ndarray]:
        """Return elastic energy [J], power taken by the dampers [W] and the internal force (size, 3) [N],
        elastic, damping or both, of springs with branches, actuators with multipliers, and items."""
        energy, force, at = 0.0, np.zeros_like(u), (u, self.drive(time))
        packed = elastic and self.packed
        if elastic and self.maxwell is not None:
            energy = self.maxwell.add_force(u, force)
        elif elastic and not packed:
            energy, force = self.assembly.at(time=time).force(u)
        stored, power = add_forces(self.forces, u, v, packed, damped, force)
        energy += stored
        if self.coupling is not None:
            energy += self.coupling.add_force(*at, force) if elastic else 0.0
            power += self.coupling.add_damping_force(u, v, force) if damped else 0.0
        for item in self.items:
            energy += item.add_force(at, force) if elastic else 0.0
            power += item.add_resistance(at, v, force) if damped else 0.0
        return energy, power, force

    @cached_property
    def kinks(self) -> np.ndarray:
        """Times [s] at which a load, command or motion changes its slope, sorted."""
        return np.array(kinks(self.scene))

    def damping_force(self, u: np.ndarray, v: np.ndarray, time: float) -> tuple[float, np.ndarray]:
        """Return the power taken [W] and the damping force (size, 3) [N]."""
        _, power, force = self.internal(u, v, time, elastic=False)
        return power, force

    def power(self, state: State) -> float:
        """Return the power [W] that goes into dampers and branches."""
        power, _ = self.damping_force(state.u, state.v, state.time)
        if self.maxwell is not None and state.memory is not None:
            force = np.zeros_like(state.u)
            self.maxwell.add_branch_force(state.u, state.memory, force)
            power += float(np.sum(force * state.v))
        return power

    def loads(self, times: Sequence[float]) -> np.ndarray:
        """Return the loads that do not follow the sheet at times [s], (k, n, 3) [N], (1, n, 3) if
        constant."""
        loads = self.problem.loads
        return np.array([loads.dead_at(time) for time in (times if self.nonconservative else times[:1])])

    def external(self, u: np.ndarray, time: float) -> np.ndarray:
        """Return the external force (size, 3) [N]."""
        return self.problem.loads.force(u, time)

    def unbalanced(self, u: np.ndarray, v: np.ndarray, time: float) -> np.ndarray:
        """Return f_ext − f_int − f_damp − Jᵀλ; on multiplier rows −Φ."""
        return self.external(u, time) - self.internal(u, v, time)[2]

    def average_elastic(self, start: State, end: np.ndarray, time: float) -> np.ndarray:
        """Return the internal force whose work from `start` to the displacement `end` is the energy stored
        and, by branches, dissipated; commands and natural state as at `time`."""
        force = self.assembly.at(time=time).average_force(start.u, end)
        if self.maxwell is not None and start.memory is not None:
            self.maxwell.add_mean_force(start.memory, 0.5 * (start.u + end), end, force)
        if self.coupling is not None:
            self.coupling.add_average_force(start.u, end, self.drive(time), force)
        since, drive = self.ends(start, time)
        for item in self.items:
            item.add_force((end, drive), force, since)
        return force

    def ends(self, start: State, middle: float) -> tuple[Deformed, Drive]:
        """Return displacement and commands at a step's start, and the commands at its end."""
        return (start.u, self.drive(start.time)), self.drive(2.0 * middle - start.time)

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
        """Return the blocks of mass × M + damping × C + stiffness × K at a state; constraints count once. The
        change of C with the shape is left out: it is unsymmetric, of the order of the turn in a step. ends:
        start and end of a step, for which items have the derivative of the mean force by its end."""
        elastic = stiffness if self.maxwell is None else stiffness * self.maxwell.gain
        both = elastic + damping * self.damping.time  # proportional dampers are parallel to the springs
        share, stresses = elastic / both if both else 0.0, None
        if self.maxwell is not None and both:
            stresses = tuple(self.maxwell.stresses(u, share, stiffness / both))
        inertia = mass * self.lattice_mass + damping * self.damping.rate
        blocks = self.assembly.at(time=time).tangent(u, stresses, share, both, inertia)
        self.problem.loads.add_tangent(u, stiffness, blocks, time)
        if self.shared_mass:
            blocks[self._bodies[0]] += mass * self._bodies[1]
        if self.coupling is not None:
            slots = self.assembly.coupling_slots
            self.coupling.add_tangent(u, self.drive(time), slots, blocks, stiffness, damping)
            np.add.at(blocks, slots, mass * self._chain_mass)
        self.damping.add_velocity_tangent(u, v, damping, blocks)
        for item in self.items:
            if ends is None:
                item.add_tangent((u, self.drive(time)), stiffness, blocks)
            else:
                since, drive = self.ends(ends[0], time)
                item.add_tangent((ends[1], drive), 1.0, blocks, since=since)
            item.add_resistance_tangent((u, self.drive(time)), v, damping, blocks)
        return blocks

    def for_step(self, state: State, ahead: float = 0.0) -> Self:
        """Return the equations with the branches of a step of second order, `ahead` [s] after a state."""
        if self.maxwell is None or state.memory is None:
            return self
        return self.with_branches(self.maxwell.step(state.memory, ahead))

    def with_branches(self, maxwell: Maxwell) -> Self:
        """Return the equations with the branches in a step or stage."""
        other = copy(self)
        other.maxwell = maxwell
        return other

    def relaxed(self, before: State, after: State) -> tuple[State, float]:
        """Return the state at the end of a step of second order with its memory, and the energy [J] that the
        branches dissipated in it."""
        if self.maxwell is None or before.memory is None:
            return after, 0.0
        memory = self.maxwell.step(before.memory, after.time - before.time).after(after.u)
        return replace(after, memory=memory), self.maxwell.branches.dissipated(before.memory, memory)

    def reduce(self, force: np.ndarray) -> np.ndarray:
        """Return the force on the free unknowns that have mass."""
        return self.moving_part.T @ force.ravel()

    def expand(self, unknowns: np.ndarray) -> np.ndarray:
        """Return the displacement (size, 3) of the free unknowns that have mass; multiplier rows are zero."""
        return (self.moving_part @ unknowns).reshape(-1, 3)

    def momentum(self, v: np.ndarray) -> np.ndarray:
        """Return M v, (size, 3)."""
        return product(self.mass_rows, v.ravel()).reshape(-1, 3)

    def accelerate(self, force: np.ndarray) -> np.ndarray:
        """Return T M⁻¹ Tᵀ f, (size, 3) [m/s²]."""
        return self.expand(self.solve_mass(self.reduce(force)))

    def balance(self, state: State) -> tuple[dict[str, float], np.ndarray]:
        """Return kinetic, elastic and potential energy [J], the potential of constant dead loads alone, and
        the force M a + f_int + f_damp − f_ext, (size, 3) [N], of supports and actuators on their masses."""
        elastic, _, force = self.for_step(state).internal(state.u, state.v, state.time)
        if self.maxwell is not None and state.memory is not None:
            elastic += self.maxwell.branches.stored(state.memory)
        kinetic = 0.5 * float(np.vdot(state.v, self.momentum(state.v)))
        potential = -float(np.sum(self.problem.loads.dead * state.u))
        energies = {"kinetic": kinetic, "elastic": elastic, "potential": potential}
        return energies, self.momentum(state.a) + force - self.external(state.u, state.time)

    def exerted(self, state: State) -> np.ndarray:
        """Return the force of supports and actuators on their masses, (size, 3) [N]."""
        return self.balance(state)[1]


def _mass_solver(mass: sp.csc_array) -> Callable[[np.ndarray], np.ndarray]:
    diagonal = mass.diagonal()
    if mass.nnz == len(diagonal):
        return lambda b: b / diagonal
    factors = splu(mass)
    return lambda b: factors.solve(b)
