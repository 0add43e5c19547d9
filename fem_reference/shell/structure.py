"""The discrete shell: residual and tangent over all nodes, five unknowns a node.

State: q = (u, d − e_z) at every node, shape (2, n, 3), and the sampled stresses s of every element. With
R = Bᵀ s − λ f the residual force on (u, d), unknowns are u and two tangent-plane components β of the
director: δd = T β with T ⊥ d. The constraint |d|² = 1 and the prescribed values are linear in the step,

    d · δd = ½ (1 − d · d),     δq = target − q where held,

and its multiplier, −(R_d · d)/(d · d), stiffens T (the curvature of the sphere). All of strain, load and
constraint being polynomials in q, the step is Newton's; `mixed` takes the stress that the last step
extrapolated, D (e + B δq), for the geometric stiffness and the multiplier (see `equilibrium`).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.sparse import csr_matrix

from fem_reference.shell.element import BENDING, MEMBRANE, SHEAR, STRAINS, Element, geometric
from fem_reference.solving.sparsity import Pattern
from fem_reference.surface.loads import Follower
from fem_reference.surface.supports import Supports


@dataclass(frozen=True)
class State:
    """change: q (2, n, 3); stress: extrapolated s (m, 54), the element's own where None."""

    change: np.ndarray
    stress: np.ndarray | None = None


@dataclass(frozen=True)
class Forces:
    """At a state: B (m, 54, 18, 3), s (m, 54), residual R (2, n, 3), size of the forces that balance [N]."""

    gradient: np.ndarray
    stress: np.ndarray
    residual: np.ndarray
    size: float


class ShellStructure:
    """A shell with its supports and loads, ready for `equilibrium.trace`."""

    def __init__(
        self,
        element: Element,
        element_nodes: np.ndarray,
        supports: Supports,
        dead: np.ndarray,
        followers: list[Follower],
    ):
        """element_nodes: (m, 9); dead: nodal forces (n, 3) [N]."""
        self.element, self.element_nodes, self.supports = element, element_nodes, supports
        self.dead, self.followers = dead, followers
        self.count = len(dead)
        free = np.concatenate([~supports.position, np.repeat(~supports.director[:, None], 2, axis=1)], axis=1)
        free[supports.tilt.any(axis=1), 3] = False  # the first tangent of such a director is the axis held
        self.number = np.where(free, np.cumsum(free.ravel()).reshape(free.shape) - 1, -1)  # (n, 5)
        self.unknowns = int(free.sum())
        of_element = self.number[element_nodes]  # (m, 9, 5)
        parts = [of_element[:, :, :3].reshape(-1, 27), of_element[:, :, 3:].reshape(-1, 18)]
        self.pattern = Pattern(np.concatenate(parts, axis=1), self.unknowns)

    @property
    def symmetric(self) -> bool:
        """Whether the tangent is: follower loads make it unsymmetric."""
        return not self.followers

    def rest(self) -> State:
        """Flat and free of stress."""
        return State(np.zeros((2, self.count, 3)))

    def energies(self, state: State) -> dict[str, float]:
        """Strain energy [J] by part."""
        strain = self.element.strain(self._gather(state.change))
        density = strain * self.element.stress(strain)
        parts = {"membrane": MEMBRANE, "bending": BENDING, "shear": SHEAR}
        return {name: 0.5 * float(density[:, part].sum()) for name, part in parts.items()}

    def forces(self, state: State, load_factor: float) -> Forces:
        """Internal less external forces, and what they are measured against."""
        change = self._gather(state.change)
        gradient = self.element.gradient(change)
        stress = self.element.stress(self.element.strain(change))
        internal = self._scatter(_forces_of(gradient, stress))
        external = load_factor * self._external(change)
        size = np.abs(external[0]).sum() + np.abs(internal[0][self.supports.position]).sum()
        size += np.abs(external[1]).sum() / self._lever
        return Forces(gradient, stress, internal - external, float(size))

    def imbalance(self, state: State, forces: Forces) -> float:
        """Sum of the free unknowns' residuals [N], directors' moments over the sheet's size."""
        residual = forces.residual
        moment = np.einsum("nc,nck->nk", residual[1], self._frames(state.change)) / self._lever
        return float(np.abs(np.concatenate([residual[0], moment], axis=1)[self.number >= 0]).sum())

    def gap(self, state: State, load_factor: float) -> float:
        """Largest distance from the prescribed values and from |d| = 1, relative to the sheet's size."""
        position, director = self._to_constraints(state.change, load_factor)
        return float(max(np.abs(position).max() / self._lever, np.abs(director).max()))

    def system(
        self, state: State, forces: Forces, load_factor: float, mixed: bool = True
    ) -> tuple[csr_matrix, np.ndarray]:
        """Tangent (unknowns, unknowns) and right-hand side of the step to equilibrium and constraints."""
        stress = forces.stress if state.stress is None or not mixed else state.stress
        frames = self._frames(state.change)
        vectors = self.element.reference + self._gather(state.change)
        reduced = self._reduce(forces.gradient, frames)  # (m, 54, 45)
        stiffness = reduced.swapaxes(1, 2) @ (self.element.stiffness @ reduced)
        form = geometric(stress)
        self._add_geometric(stiffness, form, frames)
        step = self._to_constraints(state.change, load_factor)
        of_step = self._gather(step)
        pull = (
            _forces_of(forces.gradient, self.element.stress(_strain_of(forces.gradient, of_step)))
            + form @ of_step
        )
        pressing = forces.residual
        if stress is not forces.stress:
            pressing = pressing + self._scatter(_forces_of(forces.gradient, stress - forces.stress))
        for load in self.followers:
            tangent = -load_factor * load.tangent(vectors[load.elements])
            pull[load.elements] += np.einsum("eicjd,ejd->eic", tangent, of_step[load.elements])
            stiffness[load.elements] += self._project(tangent, frames[self.element_nodes[load.elements]])
        matrix = self.pattern.matrix(stiffness, self._multiplier(state.change, pressing[1]))
        pull = forces.residual + self._scatter(pull)
        rows = np.concatenate([pull[0], np.einsum("nc,nck->nk", pull[1], frames)], axis=1)
        return matrix, -rows[self.number >= 0]

    def advance(self, state: State, forces: Forces, load_factor: float, step: np.ndarray) -> State:
        """The state after a step (unknowns,), with the stress it extrapolates."""
        change = self._to_constraints(state.change, load_factor)
        full = np.zeros(self.number.shape)
        full[self.number >= 0] = step
        change[0] += full[:, :3]
        change[1] += np.einsum("nck,nk->nc", self._frames(state.change), full[:, 3:])
        strain = _strain_of(forces.gradient, self._gather(change))
        return State(state.change + change, forces.stress + self.element.stress(strain))

    def length(self, start: State, end: State) -> float:
        """Largest nodal displacement between two states, relative to the sheet's size."""
        return float(np.abs(end.change[0] - start.change[0]).max() / self._lever)

    @property
    def _lever(self) -> float:
        return float(np.ptp(self.element.reference[:, :9, :2], axis=(0, 1)).max())

    def _gather(self, nodal: np.ndarray) -> np.ndarray:
        """(2, n, 3) of nodes to (m, 18, 3) of elements."""
        return np.concatenate([nodal[0][self.element_nodes], nodal[1][self.element_nodes]], axis=1)

    def _scatter(self, elementwise: np.ndarray) -> np.ndarray:
        """Sums (m, 18, 3) of elements into (2, n, 3) of nodes."""
        where = (self.element_nodes.ravel()[:, None] * 3 + np.arange(3)).ravel()
        parts = (elementwise[:, :9], elementwise[:, 9:])
        return np.array([np.bincount(where, p.ravel(), 3 * self.count).reshape(-1, 3) for p in parts])

    def _external(self, change: np.ndarray) -> np.ndarray:
        external = np.array([self.dead, np.zeros_like(self.dead)])
        for load in self.followers:
            force = np.zeros_like(change)
            force[load.elements] = load.force((self.element.reference + change)[load.elements])
            external += self._scatter(force)
        return external

    def _director(self, change: np.ndarray) -> np.ndarray:
        return change[1] + np.array([0.0, 0.0, 1.0])

    def _frames(self, change: np.ndarray) -> np.ndarray:
        """Orthonormal T (n, 3, 2) with T ⊥ d."""
        director = self._director(change)
        director = director / np.linalg.norm(director, axis=1, keepdims=True)
        axis = np.eye(3)[np.argmin(np.abs(director), axis=1)]
        first = np.cross(axis, director)
        first /= np.linalg.norm(first, axis=1, keepdims=True)
        node, held = np.nonzero(self.supports.tilt & ~self.supports.director[:, None])
        first[node] = np.eye(3)[held]
        return np.stack([first, np.cross(director, first)], axis=-1)

    def _to_constraints(self, change: np.ndarray, load_factor: float) -> np.ndarray:
        """The step (2, n, 3) to the prescribed values and, along free directors, to |d| = 1."""
        target = self.supports.change(load_factor) - change
        director = self._director(change)
        square = np.einsum("nc,nc->n", director, director)
        along = (0.5 * (1.0 - square) / square)[:, None] * director
        turn = np.where(self.supports.director[:, None], target[1], along)
        return np.array([np.where(self.supports.position, target[0], 0.0), turn])

    def _multiplier(self, change: np.ndarray, couple: np.ndarray) -> np.ndarray:
        """−(R_d · d)/(d · d) on the two rotations of every free director, 0 elsewhere: (unknowns,)."""
        director = self._director(change)
        pressing = -np.einsum("nc,nc->n", couple, director) / np.einsum("nc,nc->n", director, director)
        rows = np.zeros(self.number.shape)
        rows[:, 3:] = pressing[:, None]
        return rows[self.number >= 0]

    def _reduce(self, gradient: np.ndarray, frames: np.ndarray) -> np.ndarray:
        """B on the unknowns of an element: (m, 54, 45), nine positions then nine pairs of rotations."""
        m = len(gradient)
        turning = gradient[:, :, 9:].swapaxes(1, 2) @ frames[self.element_nodes]  # (m, 9, 54, 2)
        return np.concatenate(
            [gradient[:, :, :9].reshape(m, STRAINS, 27), turning.swapaxes(1, 2).reshape(m, STRAINS, 18)],
            axis=2,
        )

    def _add_geometric(self, stiffness: np.ndarray, form: np.ndarray, frames: np.ndarray) -> None:
        """Adds Σ s_k H_k ⊗ I on the unknowns to (m, 45, 45); H has no director–director part."""
        m = len(stiffness)
        positions = stiffness[:, :27, :27].reshape(m, 9, 3, 9, 3)
        for axis in range(3):
            positions[:, :, axis, :, axis] += form[:, :9, :9]
        stiffness[:, :27, :27] = positions.reshape(m, 27, 27)
        mixed = np.einsum("eij,ejck->eicjk", form[:, :9, 9:], frames[self.element_nodes]).reshape(m, 27, 18)
        stiffness[:, :27, 27:] += mixed
        stiffness[:, 27:, :27] += mixed.swapaxes(1, 2)

    def _project(self, tangent: np.ndarray, frames: np.ndarray) -> np.ndarray:
        """Full (k, 18, 3, 18, 3) to the unknowns (k, 45, 45); frames: (k, 9, 3, 2)."""
        k = len(tangent)
        right = np.concatenate(
            [
                tangent[:, :, :, :9].reshape(k, 18, 3, 27),
                np.einsum("eicjd,ejdb->eicjb", tangent[:, :, :, 9:], frames).reshape(k, 18, 3, 18),
            ],
            axis=3,
        )
        lower = np.einsum("eicb,eica->eiab", right[:, 9:], frames).reshape(k, 18, 45)
        return np.concatenate([right[:, :9].reshape(k, 27, 45), lower], axis=1)


def _forces_of(gradient: np.ndarray, stress: np.ndarray) -> np.ndarray:
    """Bᵀ s: (m, 18, 3)."""
    m = len(stress)
    return (stress[:, None, :] @ gradient.reshape(m, STRAINS, 54)).reshape(m, 18, 3)


def _strain_of(gradient: np.ndarray, step: np.ndarray) -> np.ndarray:
    """B δq: (m, 54)."""
    m = len(step)
    return (gradient.reshape(m, STRAINS, 54) @ step.reshape(m, 54, 1))[:, :, 0]
