"""The discrete solid: residual and tangent over all nodes, three unknowns a node.

State: displacement u (n, levels, 3) and the sampled stresses s of every brick. R = Bᵀ s − λ f; with
K = Bᵀ D B + Σ s_k H_k ⊗ I the step is Newton's, and `mixed` takes the stress that the last step extrapolated,
s + D B δu, for the geometric part (`continuation.trace`: the strain is quadratic in u, as in the shell), and
the extrapolated pressure in D: near ν = ½ the current one is a large error until volumes fit.
Held components q, u = Z q (see `supports`), go to their targets in the first step.

Loads act on the sheet as a surface, its mean position x̄ and director D (see `mesh`), with the shell's
work: a dead force or the pressure on x̄ is a body force uniform through the thickness, an edge moment
on D a traction linear in ζ. To first order in the strain the power of pressure and moment is the shell's.
Rods along edges (see `rods`) are further elements with directors of their own.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from scipy.sparse import csr_matrix

from fem_reference.solid.element import Bricks, tangent
from fem_reference.solid.mesh import Columns
from fem_reference.solid.rods import DIRECTORS
from fem_reference.solid.supports import ColumnSupports, components, into_forces, vectors
from fem_reference.surface.bound_rods import BoundRods, block_diagonal
from fem_reference.surface.carried import Carried
from fem_reference.surface.loads import Follower
from fem_reference.surface.rod_elements import Strained
from sheetbench.numerics.continuation.structure import Structure
from sheetbench.numerics.sparsity import Pattern


@dataclass(frozen=True)
class State:
    """displacement (n, levels, 3) [m]; aside: change of the rods' own vectors (q, 3); extrapolated: stress
    (m · layers, k), pressure and rod_stress (k, s), the elements' own where None."""

    displacement: np.ndarray
    aside: np.ndarray = field(default_factory=lambda: np.zeros((0, 3)))
    stress: np.ndarray | None = None
    pressure: np.ndarray | None = None
    rod_stress: np.ndarray | None = None


@dataclass(frozen=True)
class Forces:
    """At a state: B (…, k, 27, 3), e and s (…, k) of the bricks, the rods', residual R (n, levels, 3) [N]
    and that on the rods' own vectors, aside (q, 3).

    size: what R is measured against [N]; bases: Z of the columns.
    """

    gradient: np.ndarray
    strain: np.ndarray
    stress: np.ndarray
    rods: Strained
    residual: np.ndarray
    aside: np.ndarray
    size: float
    bases: np.ndarray


class SolidStructure(Structure[State, Forces]):
    """A solid sheet with its supports, loads and rods, ready for `trace_path`."""

    def __init__(
        self,
        columns: Columns,
        bricks: Bricks,
        supports: ColumnSupports,
        dead: np.ndarray,
        followers: Sequence[Follower],
        rods: BoundRods,
    ):
        """bricks: layer by layer, over the plan's elements; dead: forces on the mean surface (n, 3) [N]."""
        self.columns, self.bricks, self.supports = columns, bricks, supports
        self.followers, self.rods = followers, rods
        self.dead = columns.averages[0][:, None] * dead[:, None, :]
        self.free = ~supports.held
        every = np.concatenate([self.free.ravel(), np.repeat(~rods.held, 3)])
        self.number = np.where(every, np.cumsum(every) - 1, -1).reshape(-1, 3)  # of all vectors
        kinds = (self.number[sites] for sites in (columns.stacks, rods.sites))
        self.pattern = Pattern(*(n.reshape(len(n), 3 * n.shape[1]) for n in kinds), size=int(every.sum()))
        self.lever = float(np.ptp(columns.plan.nodes, axis=0).max())
        self._turned = supports.turned[columns.plan.elements].any(axis=1)

    @property
    def unknowns(self) -> int:
        """How many there are."""
        return self.pattern.size

    @property
    def symmetric(self) -> bool:
        """Whether the tangent is: follower loads make it unsymmetric, unless they have a potential."""
        return all(load.conservative for load in self.followers)

    @property
    def prestrained(self) -> bool:
        return self.bricks.prestrain is not None

    def rest(self) -> State:
        """Flat, and free of stress where nothing acts on it."""
        return State(np.zeros_like(self.columns.positions), np.zeros_like(self.rods.own))

    def with_stresses(self, state: State, of: State) -> State:
        """A state with the stresses that a step to another has extrapolated."""
        return replace(state, stress=of.stress, pressure=of.pressure, rod_stress=of.rod_stress)

    def energies(self, state: State) -> dict[str, float]:
        """Strain energy [J] of the sheet by part of the law."""
        return self.bricks.energies(self.bricks.strain(self.of_bricks(state.displacement)))

    def rod_energy(self, state: State) -> float:
        """That of the rods [J], from their intrinsic shape."""
        return self.rods.elements.energy(self._on_rods(state))

    def forces(self, state: State, load_factor: float) -> Forces:
        """Internal less external forces, and what they are measured against."""
        change = self.of_bricks(state.displacement)
        self.bricks.grow(load_factor)
        gradient, strain = self.bricks.gradient(change), self.bricks.strain(change)
        stress = self.bricks.stress(strain)
        internal = self.scatter(np.einsum("ekic,ek->eic", gradient, stress))
        external = load_factor * self._external(state.displacement)
        bases = self.supports.bases(load_factor)
        size = np.linalg.norm(external) + np.linalg.norm(internal[self.supports.held])

        if (natural := self.bricks.prestrain) is not None:  # often all that loads it
            pull = np.einsum("ekic,ek->eic", gradient, self.bricks.stress(natural))
            size += np.linalg.norm(self.scatter(pull))
        elements = self.rods.elements
        rods = elements.strained(self._on_rods(state), load_factor)
        driving = elements.driving(rods.gradient)[:, -DIRECTORS : -DIRECTORS + 3]  # on d
        size += load_factor * (np.linalg.norm(elements.weight) + np.linalg.norm(driving) / self.lever)
        pull, aside = self._split(self.rods.scatter(rods.pull, len(self.number)))
        residual = internal - external + pull
        return Forces(gradient, strain, stress, rods, residual, aside, float(size), bases)

    def imbalance(self, state: State, forces: Forces) -> float:
        """Norm of the residual of the free unknowns [N], of the rods' directors over the sheet's size."""
        on_sheet = into_forces(forces.bases, forces.residual)[self.free]
        return float(
            np.hypot(np.linalg.norm(on_sheet), np.linalg.norm(forces.aside[~self.rods.held]) / self.lever)
        )

    def gap(self, state: State, load_factor: float) -> float:
        """Largest distance from the prescribed values, relative to the sheet's size."""
        step = self._to_supports(state.displacement, load_factor, self.supports.bases(load_factor))
        return float(np.abs(step).max() / self.lever)

    def system(
        self, state: State, forces: Forces, load_factor: float, mixed: bool = True
    ) -> tuple[csr_matrix, np.ndarray]:
        """Tangent (unknowns, unknowns) and right-hand side of the step to equilibrium and supports."""
        last = state if mixed else State(state.displacement)
        stress = forces.stress if last.stress is None else last.stress
        moduli = self.bricks.moduli(forces.strain, last.pressure)
        stiffness = self.stack(tangent(forces.gradient, moduli, stress))
        if self.followers:
            vectors = self.surface(self.columns.positions + state.displacement)
            for load in self.followers:
                stiffness[load.elements] -= load_factor * self.of_surface(
                    load.tangent(vectors[load.elements])
                )
        step = self._to_supports(state.displacement, load_factor, forces.bases)
        of_step = step.reshape(-1, 3)[self.columns.stacks].reshape(len(stiffness), -1, 1)
        pull = forces.residual + self._scatter_stacks(stiffness @ of_step)
        stiffness = self.turn(stiffness, forces.bases)

        rod_stress = forces.rods.stress if last.rod_stress is None else last.rod_stress
        full = self.rods.elements.tangent(forces.rods.gradient, rod_stress)
        onto = self.onto_rods(forces.bases)
        moved = self.rods.gather(np.concatenate([step.reshape(-1, 3), np.zeros_like(self.rods.own)]))
        on_rods = self.rods.elements.product(full, moved)
        on_columns, on_aside = self._split(self.rods.scatter(on_rods, len(self.number)))
        matrix = self.pattern.matrix(stiffness, onto.swapaxes(1, 2) @ full @ onto)
        on_sheet = into_forces(forces.bases, pull + on_columns)[self.free]
        return matrix, -np.concatenate([on_sheet, (forces.aside + on_aside)[~self.rods.held].ravel()])

    def advance(self, state: State, forces: Forces, load_factor: float, step: np.ndarray) -> State:
        """The state after a step (unknowns,), with the stress it extrapolates."""
        free, aside = self._split(np.where(self.number >= 0, step[self.number], 0.0))
        change = self._to_supports(state.displacement, load_factor, forces.bases)
        change = change + vectors(forces.bases, free)
        strain = np.einsum("ekic,eic->ek", forces.gradient, self.of_bricks(change))
        of_step = np.einsum("ekl,el->ek", self.bricks.moduli(forces.strain, state.pressure), strain)
        pressure = self.bricks.pressure(forces.strain, strain)
        on_rods = self.rods.gather(np.concatenate([change.reshape(-1, 3), aside]))
        rod_stress = self.rods.elements.extrapolated(forces.rods, on_rods)
        return State(
            state.displacement + change, state.aside + aside, forces.stress + of_step, pressure, rod_stress
        )

    def mass(self, payloads: Carried) -> csr_matrix:
        """Consistent mass of the free unknowns [kg]."""
        return self.pattern.matrix(self.inertia(payloads))

    def inertia(self, payloads: Carried) -> np.ndarray:
        """∫ ρ N N dV of the stacks, with what payloads add to columns' means and directors, (m, 3 s, 3 s)."""
        blocks = self.stack(np.einsum("eij,cd->eicjd", self.bricks.products(), np.eye(3)))
        blocks[payloads.elements] += self.of_surface(payloads.on_surface())
        return blocks

    def length(self, start: State, end: State) -> float:
        """Largest nodal displacement between two states, relative to the sheet's size."""
        return float(np.abs(end.displacement - start.displacement).max() / self.lever)

    def inside_out(self, state: State) -> bool:
        """Whether a brick has turned inside out at a Gauss point."""
        return bool(np.any(self.bricks.volume_ratio(self.of_bricks(state.displacement)) <= 0.0))

    def _split(self, all_vectors: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """All vectors (N, 3) as those of the columns (n, levels, 3) and the rods' own (q, 3)."""
        cut = self.columns.positions.size // 3
        return all_vectors[:cut].reshape(self.columns.positions.shape), all_vectors[cut:]

    def _on_rods(self, state: State) -> np.ndarray:
        """The change of the rods' vectors (k, 3 levels + 9, 3)."""
        return self.rods.gather(np.concatenate([state.displacement.reshape(-1, 3), state.aside]))

    def onto_rods(self, bases: np.ndarray) -> np.ndarray:
        """Z of the columns of the rods' sides, the identity on directors, (k, 9 levels + 27, …)."""
        nodes = self.rods.sites[:, : -DIRECTORS : self.columns.levels] // self.columns.levels
        directors = np.tile(np.eye(3 * DIRECTORS), (len(nodes), 1, 1))
        return block_diagonal([*(bases[nodes[:, i]] for i in range(3)), directors])

    def stack(self, of_bricks: np.ndarray) -> np.ndarray:
        """Matrices (layers · m, 27, 3, 27, 3) of bricks summed over their stacks, (m, 3 s, 3 s)."""
        m, s = self.columns.stacks.shape
        out = np.zeros((m, s, 3, s, 3))
        for place, bricks in zip(self.columns.places, np.split(of_bricks, self.columns.layers), strict=True):
            out[:, place[:, None], :, place[None, :], :] += bricks.transpose(1, 3, 0, 2, 4)
        return out.reshape(m, 3 * s, 3 * s)

    def turn(self, stacks: np.ndarray, bases: np.ndarray) -> np.ndarray:
        """Zᵀ K Z of the stacks (m, 3 s, 3 s), in their place."""
        turned = self._turned
        if not np.any(turned):
            return stacks
        k, size = stacks[turned].shape[:2]
        z = bases[self.columns.plan.elements[turned]]  # (k, 9, 3 levels, 3 levels)
        half = stacks[turned]
        for _ in range(2):
            rows = half.reshape(*z.shape[:3], size)
            half = (z.swapaxes(2, 3) @ rows).reshape(k, size, size).swapaxes(1, 2)
        stacks[turned] = half
        return stacks

    def _to_supports(self, displacement: np.ndarray, load_factor: float, bases: np.ndarray) -> np.ndarray:
        """The step (n, levels, 3) to the prescribed values."""
        gap = components(bases, self.supports.target(load_factor) - displacement)
        return vectors(bases, np.where(self.free, 0.0, gap))

    def _external(self, displacement: np.ndarray) -> np.ndarray:
        external = self.dead.copy()
        for load in self.followers:
            external += self.of_follower(displacement, load)
        return external

    def of_follower(self, displacement: np.ndarray, load: Follower) -> np.ndarray:
        """Nodal forces (n, levels, 3) of a follower load on the displaced columns."""
        out, on = np.zeros_like(self.dead), self.columns.plan.elements[load.elements]
        places = self.surface(self.columns.positions + displacement)
        force = load.force(places[load.elements]).reshape(len(on), 2, 9, 3)
        np.add.at(out, on, np.einsum("epic,pl->eilc", force, self.columns.averages))
        return out

    def mid_surface(self, displacement: np.ndarray | float) -> np.ndarray:
        """Mean places (m, 9, 3) [m] of the columns at the nodes of the plan's elements."""
        return self.surface(self.columns.positions + displacement)[:, :9]

    def surface(self, positions: np.ndarray) -> np.ndarray:
        """Mean and director at the nodes of the plan's elements, (m, 18, 3)."""
        averages = np.einsum("pl,nlc->pnc", self.columns.averages, positions)[:, self.columns.plan.elements]
        return np.concatenate([averages[0], averages[1]], axis=1)

    def of_surface(self, tangent: np.ndarray) -> np.ndarray:
        """Derivatives of surface forces (k, 18, 3, 18, 3) as matrices of stacks (k, 3 s, 3 s)."""
        k, size = len(tangent), 3 * self.columns.stacks.shape[1]
        parts = tangent.reshape(k, 2, 9, 3, 2, 9, 3)
        averages = self.columns.averages
        return np.einsum("epicrjd,pl,rm->eilcjmd", parts, averages, averages, optimize=True).reshape(
            k, size, size
        )

    def of_bricks(self, nodal: np.ndarray) -> np.ndarray:
        """Nodal vectors (n, levels, 3) at the nodes of the bricks, (layers · m, 27, 3)."""
        stacks = nodal.reshape(-1, 3)[self.columns.stacks]
        return np.concatenate([stacks[:, place] for place in self.columns.places])

    def scatter(self, of_bricks: np.ndarray) -> np.ndarray:
        """Vectors (layers · m, 27, 3) of bricks summed over the nodes, (n, levels, 3)."""
        m, s = self.columns.stacks.shape
        stacks = np.zeros((m, s, 3))
        for place, bricks in zip(self.columns.places, np.split(of_bricks, self.columns.layers), strict=True):
            stacks[:, place] += bricks
        return self._scatter_stacks(stacks)

    def _scatter_stacks(self, stacks: np.ndarray) -> np.ndarray:
        where = (3 * self.columns.stacks[:, :, None] + np.arange(3)).ravel()
        return np.bincount(where, stacks.ravel(), self.dead.size).reshape(self.dead.shape)
