"""The discrete shell: residual and tangent over all nodes, five unknowns a node.

State: q = (u, d − e_z) at every node, shape (2, n, 3), and the sampled stresses s of every element. With
R = Bᵀ s − λ f the residual force on (u, d), unknowns are u and two tangent-plane components β of the
director: δd = T β with T ⊥ d. The constraint |d|² = 1 and the prescribed values are linear in the step,

    d · δd = ½ (1 − d · d),     δq = target − q where held,

and its multiplier, −(R_d · d)/(d · d), stiffens T (the curvature of the sphere). All of strain, load and
constraint being polynomials in q, the step is Newton's; `mixed` takes the stress that the last step
extrapolated, D (e + B δq), for the geometric stiffness and the multiplier (see `continuation.trace`).

Rods along edges (see `rod`) are further elements, and their third director m, one at every node of their
edges, is one more director like d. In all there are 2n + q vectors: u, d and the q directors m.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Self

import numpy as np
from scipy.sparse import csr_matrix

from fem_reference.shell.directors import multiplier, projected, tangent_frames, to_unit
from fem_reference.shell.element import Element, add_tangents, forces_of, strain_of, weighed
from fem_reference.shell.state import Forces, State
from fem_reference.surface.bound_rods import BoundRods, block_diagonal, on_surface
from fem_reference.surface.loads import Follower
from fem_reference.surface.rod_elements import Strained
from fem_reference.surface.supports import Supports
from sheetbench.numerics.continuation.structure import Creeping
from sheetbench.numerics.fronts import Fronts
from sheetbench.numerics.sparsity import Pattern, add_blocks, pattern_of

UP = np.array([0.0, 0.0, 1.0])


@dataclass(frozen=True)
class ShellStructure(Creeping[State, Forces]):
    """A shell with its supports, loads and rods, ready for `trace_path`.

    element_nodes: (m, 9); dead: nodal forces (n, 3) [N]; number: of the unknowns (n, 5) of every node, turns
    (n + q, 2) of every director, −1 where held.
    """

    element: Element
    element_nodes: np.ndarray
    supports: Supports
    dead: np.ndarray
    followers: Sequence[Follower]
    rods: BoundRods
    number: np.ndarray
    turns: np.ndarray
    pattern: Pattern

    @classmethod
    def build(
        cls,
        element: Element,
        element_nodes: np.ndarray,
        supports: Supports,
        dead: np.ndarray,
        followers: Sequence[Follower] = (),
        rods: BoundRods | None = None,
    ) -> Self:
        """The structure with its unknowns numbered, those of the rods last."""
        rods = on_surface([], len(dead)) if rods is None else rods
        free = np.concatenate([~supports.position, np.repeat(~supports.director[:, None], 2, axis=1)], axis=1)
        free[supports.tilt.any(axis=1), 3] = False  # the first tangent of such a director is the axis held
        free_aside = np.repeat(~rods.held[:, None], 2, axis=1)
        every = np.concatenate([free.ravel(), free_aside.ravel()])
        numbered = np.where(every, np.cumsum(every) - 1, -1)
        number = numbered[: free.size].reshape(free.shape)
        turns = np.concatenate([number[:, 3:], numbered[free.size :].reshape(-1, 2)])
        m, k = len(element_nodes), len(rods.sites)
        of_element = number[element_nodes]
        of_sheet = [of_element[:, :, :3].reshape(m, 27), of_element[:, :, 3:].reshape(m, 18)]
        on_rod = [
            number[rods.sites[:, :3], :3].reshape(k, 9),
            turns[rods.sites[:, 3:] - len(dead)].reshape(k, 12),
        ]
        sheet, on_edges = element.reference[:, :9, :2], rods.elements.reference[:, :3, :2]
        places = np.concatenate([sheet.mean(axis=1), on_edges.mean(axis=1)])
        unknowns = (np.concatenate(n, axis=1) for n in (of_sheet, on_rod))
        pattern = pattern_of(places, *unknowns, size=int(every.sum()))
        return cls(element, element_nodes, supports, dead, followers, rods, number, turns, pattern)

    @property
    def count(self) -> int:
        """Nodes of the sheet, n."""
        return len(self.dead)

    @property
    def unknowns(self) -> int:
        """How many there are."""
        return self.pattern.size

    def fronts(self) -> Fronts:
        """Where everything goes in the tangent's Cholesky factors."""
        return self.pattern.fronts

    @property
    def symmetric(self) -> bool:
        """Whether the tangent is: follower loads make it unsymmetric, unless they have a potential."""
        return all(load.conservative for load in self.followers)

    @property
    def rest_positions(self) -> np.ndarray:
        """The nodes of the flat sheet (n, 3) [m]."""
        out = np.zeros((self.count, 3))
        out[self.element_nodes] = self.element.reference[:, :9]
        return out

    @property
    def prestrained(self) -> bool:
        return self.element.prestrain is not None

    def rest(self) -> State:
        """Flat, and free of stress where nothing acts on it."""
        return State(np.zeros((2, self.count, 3)), np.zeros_like(self.rods.own))

    def unextrapolated(self, state: State) -> State:
        """The state with its own stresses."""
        return replace(state, stress=None, rod_stress=None)

    def with_stresses(self, state: State, of: State) -> State:
        """A state with the stresses that a step to another has extrapolated."""
        return replace(state, stress=of.stress, rod_stress=of.rod_stress)

    def energies(self, state: State) -> dict[str, float]:
        """Strain energy [J] of the sheet by part."""
        return self.element.energies(self.element.strain(self.gather(state.change)))

    def rod_energy(self, state: State) -> float:
        """That of the rods [J], from their intrinsic shape."""
        return self.rods.elements.energy(self._on_rods(state))

    def potential(self, state: State, load_factor: float) -> tuple[float, float]:
        """Strain energy less the work of conservative loads, and the sum of their magnitudes [J]."""
        on_rods = self._on_rods(state)
        self.element.grow(load_factor)
        stored = sum(self.energies(state).values()) + self.rods.elements.energy(on_rods, load_factor)
        work = float(np.sum(self.dead * state.change[0]) + np.sum(self.rods.elements.weight * on_rods))
        vectors = self.element.reference + self.gather(state.change)
        work += sum(load.work(vectors[load.elements]) for load in self.followers)
        return stored - load_factor * work, stored + abs(load_factor * work)

    def dragged(self, state: State, load_factor: float, drag: float) -> ShellStructure:
        """The structure whose equilibrium at this load factor is the end of a step of creep from a state.

        Its elements are `dragged`, and the rods' stresses (1 + σ) S e − σ S e_n − λ S e₀ those of another
        intrinsic curvature.
        """
        element, rods = self.element, self.rods.elements
        element.grow(load_factor)
        slow = element.dragged(element.strain(self.gather(state.change)), drag)
        shape = load_factor * rods.intrinsic + drag * rods.strain(self._on_rods(state))
        intrinsic = shape / (load_factor * (1.0 + drag)) if self.rods.rods else rods.intrinsic
        slow_rods = replace(rods, stiffness=(1.0 + drag) * rods.stiffness, intrinsic=intrinsic)
        return replace(self, element=slow, rods=replace(self.rods, elements=slow_rods))

    def forces(self, state: State, load_factor: float) -> Forces:
        """Internal less external forces, and what they are measured against."""
        change, n = self.gather(state.change), self.count
        self.element.grow(load_factor)
        vectors, strain = self.element.reference + change, self.element.strain(change)
        stress = self.element.stress(strain)
        residuals = self.scatter(forces_of(vectors, stress))
        external = load_factor * self._external(vectors)
        size = np.abs(external[:n]).sum() + np.abs(residuals.ravel()[self._held_components]).sum()
        size += np.abs(external[n:]).sum() / self.lever
        if (natural := self.element.prestrain) is not None:  # often all that loads it
            pull = np.abs(self.scatter(forces_of(vectors, weighed(self.element.stiffness, natural))))
            size += pull[:n].sum() + pull[n:].sum() / self.lever
        residuals -= external
        if not self.rods.rods:
            rods = self._no_rods
        else:
            elements = self.rods.elements
            rods = elements.strained(self._on_rods(state), load_factor)
            driving = load_factor * elements.driving(rods.gradient)
            size += load_factor * np.abs(elements.weight[:, :3]).sum()
            size += np.abs(driving[:, :3]).sum() + np.abs(driving[:, 3:]).sum() / self.lever
            residuals += self.rods.scatter(rods.pull, self._vectors)
        moduli, directors = self.element.moduli(strain), self.directors(state)
        frames = tangent_frames(directors, self._held_axes)
        short = self._to_constraints(state, directors, load_factor)
        return Forces(vectors, stress, moduli, directors, frames, rods, residuals, float(size), short)

    def imbalance(self, state: State, forces: Forces) -> float:
        """Sum of the free unknowns' residuals [N], directors' moments over the sheet's size."""
        left = self.of_unknowns(forces.residuals[: self.count], forces.couple / self.lever)
        return float(np.abs(left).sum())

    def gap(self, state: State, load_factor: float) -> float:
        """Largest distance from the prescribed values and from |d| = 1, relative to the sheet's size."""
        step = np.abs(self._to_constraints(state, self.directors(state), load_factor))
        return float(max(step[: self.count].max() / self.lever, step[self.count :].max()))

    def system(
        self, state: State, forces: Forces, load_factor: float, mixed: bool = True
    ) -> tuple[csr_matrix, np.ndarray]:
        """Tangent (unknowns, unknowns) and right-hand side of the step to equilibrium and constraints."""
        frames, vectors, moduli, n = forces.frames, forces.vectors, forces.moduli, self.count
        step, residuals = forces.short, forces.residuals
        pressing, stress, rod_stress = residuals, forces.stress, forces.rods.stress
        if mixed and state.stress is not None and state.rod_stress is not None:
            stress, rod_stress = state.stress, state.rod_stress
            pressing = pressing + self.scatter(forces_of(vectors, stress - forces.stress))
            if self.rods.rods:
                more = self.rods.elements.force(forces.rods.gradient, rod_stress - forces.rods.stress)
                pressing += self.rods.scatter(more, self._vectors)

        along = np.repeat(multiplier(forces.directors, pressing[n:])[:, None], 2, axis=1)
        data, nodes = self.pattern.zeros(self.of_unknowns(np.zeros((n, 3)), along)), self.element_nodes
        add_tangents(data, self.pattern.slots[0], self.element, vectors, moduli, stress, nodes, frames)
        of_step = self.gather(step)
        pull = forces_of(vectors, weighed(moduli, strain_of(vectors, of_step))) + forces_of(of_step, stress)
        for load in self.followers:
            on = load.elements
            tangent = -load_factor * load.tangent(vectors[on])
            pull[on] += np.einsum("eicjd,ejd->eic", tangent, of_step[on])
            add_blocks(data, self.pattern.slots[0][on], projected(tangent, frames[nodes[on]]))
        total = residuals + self.scatter(pull)
        if self.rods.rods:
            full = self.rods.elements.tangent(forces.rods.gradient, rod_stress)
            onto = self.onto_rods(frames)
            on_rods = self.rods.elements.product(full, self.rods.gather(step))
            add_blocks(data, self.pattern.slots[1], onto.swapaxes(1, 2) @ full @ onto)
            total += self.rods.scatter(on_rods, self._vectors)
        couple = np.einsum("nc,nck->nk", total[n:], frames)
        return self.pattern.with_data(data), -self.of_unknowns(total[:n], couple)

    def advance(self, state: State, forces: Forces, load_factor: float, step: np.ndarray) -> State:
        """The state after a step (unknowns,), with the stresses it extrapolates."""
        every = np.zeros(3 * self.count + self.turns.size)
        every[self._free] = step
        vectors, turn = forces.short.copy(), every[3 * self.count :].reshape(-1, 2)
        vectors[: self.count] += every[: 3 * self.count].reshape(-1, 3)
        vectors[self.count :] += np.einsum("nck,nk->nc", forces.frames, turn)
        of_step = weighed(forces.moduli, strain_of(forces.vectors, self.gather(vectors)))
        rod_stress = self.rods.elements.extrapolated(forces.rods, self.rods.gather(vectors))
        sheet = 2 * self.count
        change, aside = state.change + vectors[:sheet].reshape(2, -1, 3), state.aside + vectors[sheet:]
        return State(change, aside, forces.stress + of_step, rod_stress)

    def length(self, start: State, end: State) -> float:
        """Largest nodal displacement between two states, relative to the sheet's size."""
        return float(np.abs(end.change[0] - start.change[0]).max() / self.lever)

    def gather(self, nodal: np.ndarray) -> np.ndarray:
        """Vectors (2, n, 3) of nodes, or (2n + q, 3) of everything, to (m, 18, 3) of elements."""
        return nodal.reshape(-1, 3).take(self._both, axis=0)

    @cached_property
    def _both(self) -> np.ndarray:
        """Every element's positions, then directors (m, 18), among those of all nodes (2n,)."""
        return np.concatenate([self.element_nodes, self.count + self.element_nodes], axis=1)

    @cached_property
    def _components(self) -> np.ndarray:
        """Their components (54 m,) among all (6n,)."""
        return (3 * self._both.ravel()[:, None] + np.arange(3)).ravel()

    def frames(self, state: State) -> np.ndarray:
        """T (n + q, 3, 2) ⊥ d, and ⊥ m of the rods."""
        return tangent_frames(self.directors(state), self._held_axes)

    @cached_property
    def _held_axes(self) -> np.ndarray:
        """The axis that is the first tangent of every director (n + q,), −1 for any."""
        axes = np.full(len(self.turns), -1)
        nodes, along = np.nonzero(self.supports.tilt & ~self.supports.director[:, None])
        axes[nodes] = along
        return axes

    @cached_property
    def lever(self) -> float:
        return float(np.ptp(self.element.reference[:, :9, :2], axis=(0, 1)).max())

    @property
    def _vectors(self) -> int:
        return 2 * self.count + len(self.rods.own)

    def _on_rods(self, state: State) -> np.ndarray:
        """The change of the rods' vectors (k, 9, 3)."""
        return self.rods.gather(np.concatenate([*state.change, state.aside]))

    def directors(self, state: State) -> np.ndarray:
        """d of the nodes, then m of the rods, (n + q, 3)."""
        return np.concatenate([state.change[1] + UP, state.aside + self.rods.own])

    def scatter(self, elementwise: np.ndarray) -> np.ndarray:
        """Sums (m, 18, 3) of elements into all vectors (2n + q, 3)."""
        return np.bincount(self._components, elementwise.ravel(), 3 * self._vectors).reshape(-1, 3)

    @cached_property
    def _no_rods(self) -> Strained:
        """Of a sheet without any."""
        return self.rods.elements.strained(np.zeros((0, 9, 3)), 0.0)

    def _external(self, vectors: np.ndarray) -> np.ndarray:
        """Loads (2n + q, 3) in full on elements with vectors (m, 18, 3), but for the rods' weight."""
        external = self._dead if not self.followers else self._dead.copy()
        for load in self.followers:
            external += self.of_follower(vectors, load)
        return external

    def of_follower(self, vectors: np.ndarray, load: Follower) -> np.ndarray:
        """Forces (2n + q, 3) of a follower load in full on elements with vectors (m, 18, 3)."""
        force = np.zeros_like(vectors)
        force[load.elements] = load.force(vectors[load.elements])
        return self.scatter(force)

    @cached_property
    def _dead(self) -> np.ndarray:
        return np.concatenate([self.dead, np.zeros((self._vectors - self.count, 3))])

    @cached_property
    def _held_components(self) -> np.ndarray:
        """Where held components of positions are among those of all vectors."""
        return np.flatnonzero(self.supports.position)

    @cached_property
    def _held_directors(self) -> np.ndarray:
        return np.flatnonzero(self.supports.director)

    def _to_constraints(self, state: State, directors: np.ndarray, load_factor: float) -> np.ndarray:
        """The step (2n + q, 3) to the prescribed values and, along free directors, to |d| = 1."""
        n, change = self.count, self.supports.change(load_factor) - state.change
        step = np.concatenate([np.where(self.supports.position, change[0], 0.0), to_unit(directors)])
        held = self._held_directors
        step[n + held] = change[1][held]
        if self.rods.rods:
            step[2 * n :][self.rods.held] = -state.aside[self.rods.held]
        return step

    def of_unknowns(self, positions: np.ndarray, turns: np.ndarray) -> np.ndarray:
        """Values (n, 3) of displacements and (n + q, 2) of rotations, of the free ones (unknowns,)."""
        values = np.concatenate([positions.ravel(), turns.ravel()])
        out: np.ndarray = values[self._free]
        return out

    @cached_property
    def _free(self) -> np.ndarray:
        """Where the unknowns are among all displacements, then all rotations (unknowns,)."""
        every = np.concatenate([self.number[:, :3].ravel(), self.turns.ravel()])
        out = np.empty(self.unknowns, dtype=np.int64)
        out[every[every >= 0]] = np.flatnonzero(every >= 0)
        return out

    def onto_rods(self, frames: np.ndarray) -> np.ndarray:
        """∂Q/∂(unknowns) of the rods' sides, (k, 27, 21)."""
        directors = self.rods.sites[:, 3:] - self.count
        fixed = np.tile(np.eye(3), (len(directors), 1, 1))
        return block_diagonal([fixed] * 3 + [frames[directors[:, i]] for i in range(6)])
