"""The discrete shell with elastic rods on its edges (see `rod`): more forces, and a third director a node.

Besides the shell's unknowns there are two rotations of the rod's director m at every node of its edge, with
the constraint |m| = 1 treated as the shell treats |d| = 1. State, forces and steps are the shell's, extended.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.sparse import csr_matrix

from fem_reference.shell.element import Element
from fem_reference.shell.structure import Forces, ShellStructure, State
from fem_reference.solving.sparsity import Union
from fem_reference.surface.loads import Follower
from fem_reference.surface.rod import Rod
from fem_reference.surface.supports import Supports


@dataclass(frozen=True)
class RodState(State):
    """The shell's state; aside: change of every rod's m (p, 3); rod_stress: extrapolated (k, 15), or None."""

    aside: tuple[np.ndarray, ...] = ()
    rod_stress: tuple[np.ndarray, ...] | None = None


@dataclass(frozen=True)
class RodForces(Forces):
    """The shell's forces, the rods' included in its residual; of every rod B, s, its own pull on the nodes
    (k, 9, 3) and the residual (p, 3) on m."""

    rod_gradient: tuple[np.ndarray, ...] = ()
    rod_stress: tuple[np.ndarray, ...] = ()
    rod_pull: tuple[np.ndarray, ...] = ()
    aside: tuple[np.ndarray, ...] = ()


class RoddedShell(ShellStructure):
    """A shell with rods, its supports and loads, ready for `equilibrium.trace`."""

    def __init__(
        self,
        element: Element,
        element_nodes: np.ndarray,
        supports: Supports,
        dead: np.ndarray,
        followers: list[Follower],
        rods: list[Rod],
    ):
        super().__init__(element, element_nodes, hold_bases(supports, rods), dead, followers)
        self.rods = rods
        self.rest_positions = np.zeros((self.count, 3))  # (n, 3) [m]
        self.rest_positions[element_nodes] = element.reference[:, :9]
        self.shell_unknowns = self.unknowns
        self.aside_number = []
        for rod in rods:
            free = np.ones((len(rod.line), 2), dtype=bool)
            if rod.base is not None:
                free[rod.base] = False
            number = np.where(free, self.unknowns + np.cumsum(free.ravel()).reshape(free.shape) - 1, -1)
            self.unknowns += int(free.sum())
            self.aside_number.append(number)
        self._union = Union(self.unknowns)

    def rest(self) -> RodState:
        """Flat and free of stress."""
        return RodState(super().rest().change, None, tuple(np.zeros((len(rod.line), 3)) for rod in self.rods))

    def energies(self, state: State) -> dict[str, float]:
        """Strain energy [J] by part; "rod" is that of all rods, measured from their straight shape."""
        total = 0.0
        for rod, aside in zip(self.rods, of_rods(state).aside, strict=True):
            strain = rod.strain(self._on_rod(rod, state.change, aside)) - rod.intrinsic
            total += 0.5 * float(np.sum(rod.stiffness * strain**2))
        return {**super().energies(state), "rod": total}

    def forces(self, state: State, load_factor: float) -> RodForces:
        """Internal less external forces, and what they are measured against."""
        shell = super().forces(state, load_factor)
        residual, size = shell.residual.copy(), shell.size
        gradients, stresses, pulls, asides = [], [], [], []
        for rod, aside in zip(self.rods, of_rods(state).aside, strict=True):
            change = self._on_rod(rod, state.change, aside)
            gradient = rod.gradient(change)
            stress = rod.stress(rod.strain(change), load_factor)
            pull = np.einsum("es,esic->eic", stress, gradient) - load_factor * rod.weight
            driving = np.einsum("es,esic->eic", rod.stiffness * rod.intrinsic, gradient) * load_factor
            size += load_factor * np.abs(rod.weight[:, :3]).sum()
            size += np.abs(driving[:, :3]).sum() + np.abs(driving[:, 3:]).sum() / self._lever
            np.add.at(residual[0], rod.nodes, pull[:, :3])
            np.add.at(residual[1], rod.nodes, pull[:, 3:6])
            gradients.append(gradient)
            stresses.append(stress)
            pulls.append(pull)
            asides.append(self._scatter_aside(rod, pull))
        return RodForces(
            shell.gradient,
            shell.stress,
            residual,
            float(size),
            *(tuple(part) for part in (gradients, stresses, pulls, asides)),
        )

    def imbalance(self, state: State, forces: Forces) -> float:
        """Sum of the free unknowns' residuals [N], directors' moments over the sheet's size."""
        total = super().imbalance(state, forces)
        for frame, number, residual in zip(
            self._aside_frames(state), self.aside_number, with_rods(forces).aside, strict=True
        ):
            moment = np.einsum("nc,nck->nk", residual, frame) / self._lever
            total += float(np.abs(moment[number >= 0]).sum())
        return total

    def gap(self, state: State, load_factor: float) -> float:
        """Largest distance from prescribed values and unit directors, relative to the sheet's size."""
        steps = self._aside_to_unit(state)
        return max([super().gap(state, load_factor), *(float(np.abs(step).max()) for step in steps)])

    def system(
        self, state: State, forces: Forces, load_factor: float, mixed: bool = True
    ) -> tuple[csr_matrix, np.ndarray]:
        """Tangent (unknowns, unknowns) and right-hand side of the step to equilibrium and constraints."""
        shell, shell_rows = super().system(state, forces, load_factor, mixed)
        rows = np.concatenate([shell_rows, np.zeros(self.unknowns - self.shell_unknowns)])
        step, frames = self._to_constraints(state.change, load_factor), self._frames(state.change)
        entries, now, found = [], of_rods(state), with_rods(forces)
        for i, (rod, aside_frame, aside_step) in enumerate(
            zip(self.rods, self._aside_frames(state), self._aside_to_unit(state), strict=True)
        ):
            gradient, stress = found.rod_gradient[i], found.rod_stress[i]
            if mixed and now.rod_stress is not None:
                stress = now.rod_stress[i]
            full = np.einsum("esic,es,esjd->eicjd", gradient, rod.stiffness, gradient, optimize=True)
            form = np.einsum("es,sij->eij", stress, rod.forms)
            for axis in range(3):
                full[:, :, axis, :, axis] += form
            onto = self._projection(rod, frames, aside_frame)
            number = self._numbers(rod, i)
            pull = np.einsum("eicjd,ejd->eic", full, self._on_rod(rod, step, aside_step))
            pull[:, 6:] += found.rod_pull[i][:, 6:]  # the shell's rows have the rest already
            np.subtract.at(rows, number[number >= 0], np.einsum("eic,eicu->eu", pull, onto)[number >= 0])
            reduced = np.einsum("eicu,eicjd,ejdv->euv", onto, full, onto, optimize=True)
            extra = np.einsum("es,esic->eic", stress - found.rod_stress[i], gradient)
            self._add_multipliers(reduced, i, state, extra, found.rod_pull[i])
            entries.append((number, reduced))
        return self._union.matrix(shell, entries), rows

    def advance(self, state: State, forces: Forces, load_factor: float, step: np.ndarray) -> RodState:
        """The state after a step (unknowns,), with the stresses it extrapolates."""
        shell = super().advance(state, forces, load_factor, step[: self.shell_unknowns])
        found, now = with_rods(forces), of_rods(state)
        asides, stresses = [], []
        for i, (rod, frame, to_unit) in enumerate(
            zip(self.rods, self._aside_frames(state), self._aside_to_unit(state), strict=True)
        ):
            number = self.aside_number[i]
            turn = np.where(number >= 0, step[number], 0.0)
            change = to_unit + np.einsum("nck,nk->nc", frame, turn)
            asides.append(now.aside[i] + change)
            on_rod = self._on_rod(rod, shell.change - state.change, change)
            strain = np.einsum("esic,eic->es", found.rod_gradient[i], on_rod)
            stresses.append(found.rod_stress[i] + rod.stiffness * strain)
        return RodState(shell.change, shell.stress, tuple(asides), tuple(stresses))

    def _on_rod(self, rod: Rod, change: np.ndarray, aside: np.ndarray) -> np.ndarray:
        """(2, n, 3) of the shell's nodes and (p, 3) of the rod's as (k, 9, 3) of its sides."""
        return np.concatenate([change[0][rod.nodes], change[1][rod.nodes], aside[rod.places]], axis=1)

    def _scatter_aside(self, rod: Rod, of_sides: np.ndarray) -> np.ndarray:
        out = np.zeros((len(rod.line), 3))
        np.add.at(out, rod.places, of_sides[:, 6:])
        return out

    def _aside(self, state: State) -> list[np.ndarray]:
        """m (p, 3) of every rod."""
        return [
            rod.reference[0, 6] + change for rod, change in zip(self.rods, of_rods(state).aside, strict=True)
        ]

    def _aside_frames(self, state: State) -> list[np.ndarray]:
        """Orthonormal T (p, 3, 2) with T ⊥ m."""
        out = []
        for aside in self._aside(state):
            unit = aside / np.linalg.norm(aside, axis=1, keepdims=True)
            axis = np.eye(3)[np.argmin(np.abs(unit), axis=1)]
            first = np.cross(axis, unit)
            first /= np.linalg.norm(first, axis=1, keepdims=True)
            out.append(np.stack([first, np.cross(unit, first)], axis=-1))
        return out

    def _aside_to_unit(self, state: State) -> list[np.ndarray]:
        """The step (p, 3) to |m| = 1, and to rest where a base holds it."""
        out = []
        for rod, aside in zip(self.rods, self._aside(state), strict=True):
            square = np.einsum("nc,nc->n", aside, aside)
            step = (0.5 * (1.0 - square) / square)[:, None] * aside
            if rod.base is not None:
                step[rod.base] = rod.reference[0, 6] - aside[rod.base]
            out.append(step)
        return out

    def _numbers(self, rod: Rod, i: int) -> np.ndarray:
        """Unknowns (k, 21) of a rod's sides: positions, rotations of d, rotations of m."""
        k = len(rod.nodes)
        of_shell = self.number[rod.nodes]
        parts = (of_shell[:, :, :3], of_shell[:, :, 3:], self.aside_number[i][rod.places])
        return np.concatenate([part.reshape(k, -1) for part in parts], axis=1)

    def _projection(self, rod: Rod, frames: np.ndarray, aside_frame: np.ndarray) -> np.ndarray:
        """∂Q/∂(unknowns) of a rod's sides, (k, 9, 3, 21)."""
        out = np.zeros((len(rod.nodes), 9, 3, 21))
        for node in range(3):
            out[:, node, :, 3 * node : 3 * node + 3] = np.eye(3)
            out[:, 3 + node, :, 9 + 2 * node : 11 + 2 * node] = frames[rod.nodes[:, node]]
            out[:, 6 + node, :, 15 + 2 * node : 17 + 2 * node] = aside_frame[rod.places[:, node]]
        return out

    def _add_multipliers(
        self, reduced: np.ndarray, i: int, state: State, extra: np.ndarray, pull: np.ndarray
    ) -> None:
        """The sphere's curvature: all of it for m; for d what the extrapolated stress adds (k, 9, 3)."""
        rod = self.rods[i]
        director = self._director(state.change)[rod.nodes]
        aside = self._aside(state)[i][rod.places]
        for first, vector, couple in (
            (9, director, extra[:, 3:6]),
            (15, aside, extra[:, 6:] + pull[:, 6:]),
        ):
            pressing = -np.sum(couple * vector, axis=2) / np.sum(vector**2, axis=2)
            for node in range(3):
                for turn in range(2):
                    place = first + 2 * node + turn
                    reduced[:, place, place] += pressing[:, node]


def of_rods(state: State) -> RodState:
    """The state, which is one with rods."""
    assert isinstance(state, RodState)
    return state


def with_rods(forces: Forces) -> RodForces:
    """The forces, which are ones with rods."""
    assert isinstance(forces, RodForces)
    return forces


def hold_bases(supports: Supports, rods: Sequence[Rod]) -> Supports:
    """The supports with what the rods' bases hold: position and director of a node."""
    position, director, edges = supports.position.copy(), supports.director.copy(), dict(supports.edges)
    for rod in rods:
        if rod.base is not None:
            node = rod.line[rod.base]
            position[node] = director[node] = True
            edges[rod.held_as] = (np.array([node]), np.arange(3))
    return replace(supports, position=position, director=director, edges=edges)
