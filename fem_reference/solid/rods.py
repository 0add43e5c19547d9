"""The discrete solid with elastic rods on its edges (see `rod`): columns follow the rod's director.

The rod is bound to the mid-line, φ being a column's middle node; d, m and a third director t along the edge,
three components each at every node, are unknowns beside the solid's. Of a column, as of the face of a clamp,
only the thickness along d is free: with w = x_l − φ of every level l, at every node

    w · m,    w · t,    t · d,    t · m,    ½ (d · d − 1),    ½ (m · m − 1),    ½ (t · t − 1)

vanish, as firmly as the rod's own d · m. All strains stay quadratic forms of the unknowns. State, forces and
steps are the solid's, extended. SI units.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from scipy.sparse import csr_matrix

from fem_reference.solid.element import Bricks
from fem_reference.solid.mesh import Columns
from fem_reference.solid.structure import Forces, SolidStructure, State
from fem_reference.solid.supports import ColumnSupports
from fem_reference.solving.sparsity import Union
from fem_reference.surface import actuator_forces
from fem_reference.surface.loads import Follower
from fem_reference.surface.rod import SQUARE, Rod
from sheetbench.scenes import EdgeMotion, Scene


@dataclass(frozen=True)
class RodState(State):
    """The solid's state; aside: change of a rod's d, m and t (p, 3, 3); rod_stress: extrapolated (k, s)."""

    aside: tuple[np.ndarray, ...] = ()
    rod_stress: tuple[np.ndarray, ...] | None = None


@dataclass(frozen=True)
class RodForces(Forces):
    """The solid's forces, the rods' included in its residual; of every rod B, s, its own pull on the columns
    and directors (k, 3 levels + 9, 3) and the residual (p, 3, 3) on the directors."""

    rod_gradient: tuple[np.ndarray, ...] = ()
    rod_stress: tuple[np.ndarray, ...] = ()
    rod_pull: tuple[np.ndarray, ...] = ()
    aside: tuple[np.ndarray, ...] = ()


class RoddedSolid(SolidStructure):
    """A solid with rods, its supports and loads, ready for `equilibrium.trace`."""

    def __init__(
        self,
        columns: Columns,
        bricks: Bricks,
        supports: ColumnSupports,
        dead: np.ndarray,
        followers: list[Follower],
        rods: list[Rod],
    ):
        super().__init__(columns, bricks, supports, dead, followers)
        self.rods, self.bound = rods, [on_columns(one, columns) for one in rods]
        self.solid_unknowns = self.unknowns
        self.aside_number = []
        for one in rods:
            free = np.ones((len(one.line), 3, 3), dtype=bool)
            if one.base is not None:
                free[one.base] = False
            number = np.where(free, self.unknowns + np.cumsum(free.ravel()).reshape(free.shape) - 1, -1)
            self.unknowns += int(free.sum())
            self.aside_number.append(number)
        self._union = Union(self.unknowns)

    def rest(self) -> RodState:
        """Flat and free of stress."""
        return RodState(
            super().rest().displacement, aside=tuple(np.zeros((len(r.line), 3, 3)) for r in self.rods)
        )

    def energies(self, state: State) -> dict[str, float]:
        """Strain energy [J] by part; "rod" is that of all rods."""
        total = 0.0
        for one, aside in zip(self.bound, of_rods(state).aside, strict=True):
            strain = one.strain(self._on_rod(one, state.displacement, aside)) - one.intrinsic
            total += 0.5 * float(np.sum(one.stiffness * strain**2))
        return {**super().energies(state), "rod": total}

    def forces(self, state: State, load_factor: float) -> RodForces:
        """Internal less external forces, and what they are measured against."""
        solid = super().forces(state, load_factor)
        residual, size = solid.residual.copy(), solid.size
        gradients, stresses, pulls, asides = [], [], [], []
        for one, aside in zip(self.bound, of_rods(state).aside, strict=True):
            change = self._on_rod(one, state.displacement, aside)
            gradient = one.gradient(change)
            stress = one.stress(one.strain(change), load_factor)
            pull = np.einsum("es,esic->eic", stress, gradient) - load_factor * one.weight
            driving = np.einsum("es,esic->eic", one.stiffness * one.intrinsic, gradient)
            size += load_factor * float(
                np.linalg.norm(one.weight) + np.linalg.norm(driving[:, -9:-6]) / self._lever
            )
            np.add.at(residual, one.nodes, self._columns_of(pull))
            on_aside = np.zeros((len(one.line), 3, 3))
            np.add.at(on_aside, one.places, pull[:, -9:].reshape(-1, 3, 3, 3).swapaxes(1, 2))
            gradients.append(gradient)
            stresses.append(stress)
            pulls.append(pull)
            asides.append(on_aside)
        of_rod = (tuple(part) for part in (gradients, stresses, pulls, asides))
        return RodForces(
            solid.gradient, solid.strain, solid.stress, residual, float(size), solid.bases, *of_rod
        )

    def imbalance(self, state: State, forces: Forces) -> float:
        """Norm of the residual of the free unknowns [N], of the directors over the sheet's size."""
        square = super().imbalance(state, forces) ** 2
        for residual, number in zip(with_rods(forces).aside, self.aside_number, strict=True):
            square += float(np.sum((residual[number >= 0] / self._lever) ** 2))
        return float(np.sqrt(square))

    def system(
        self, state: State, forces: Forces, load_factor: float, mixed: bool = True
    ) -> tuple[csr_matrix, np.ndarray]:
        """Tangent (unknowns, unknowns) and right-hand side of the step to equilibrium and supports."""
        solid, solid_rows = super().system(state, forces, load_factor, mixed)
        rows = np.concatenate([solid_rows, np.zeros(self.unknowns - self.solid_unknowns)])
        step = self._to_supports(state.displacement, load_factor, forces.bases)
        entries, now, found = [], of_rods(state), with_rods(forces)
        for i, one in enumerate(self.bound):
            gradient, stress = found.rod_gradient[i], found.rod_stress[i]
            if mixed and now.rod_stress is not None:
                stress = now.rod_stress[i]
            k, strains, nodes = gradient.shape[:3]
            flat = gradient.reshape(k, strains, 3 * nodes)
            full = flat.swapaxes(1, 2) @ (one.stiffness[:, :, None] * flat)
            form = np.einsum("es,sij->eij", stress, one.forms)
            by_axis = full.reshape(k, nodes, 3, nodes, 3)
            for axis in range(3):
                by_axis[:, :, axis, :, axis] += form
            onto = self._projection(one, forces.bases)
            held = self._on_rod(one, step, np.zeros((len(one.line), 3, 3))).reshape(k, -1, 1)
            pull = (full @ held)[:, :, 0]
            own = found.rod_pull[i][:, -9:].reshape(k, 27)  # the solid's rows have the rest already
            pull[:, -27:] += own
            number = self._numbers(one, i)
            local = (pull[:, None] @ onto)[:, 0]
            np.subtract.at(rows, number[number >= 0], local[number >= 0])
            entries.append((number, onto.swapaxes(1, 2) @ full @ onto))
        return self._union.matrix(solid, entries), rows

    def advance(self, state: State, forces: Forces, load_factor: float, step: np.ndarray) -> RodState:
        """The state after a step (unknowns,), with the stresses it extrapolates."""
        solid = super().advance(state, forces, load_factor, step[: self.solid_unknowns])
        found, now = with_rods(forces), of_rods(state)
        asides, stresses = [], []
        for i, (one, number) in enumerate(zip(self.bound, self.aside_number, strict=True)):
            turn = np.where(number >= 0, step[number], 0.0)
            on_rod = self._on_rod(one, solid.displacement - state.displacement, turn)
            strain = np.einsum("esic,eic->es", found.rod_gradient[i], on_rod)
            asides.append(now.aside[i] + turn)
            stresses.append(found.rod_stress[i] + one.stiffness * strain)
        return RodState(solid.displacement, solid.stress, solid.pressure, tuple(asides), tuple(stresses))

    def wrenches(self, scene: Scene, state: State, forces: Forces) -> dict[str, np.ndarray]:
        """Name of an actuator → force and moment (segments, 6) [N, N·m] of its segments on the sheet."""
        found = {}
        now = self.columns.positions + state.displacement
        middle = now[:, self.columns.layers]
        of_rod = zip(self.rods, self.bound, with_rods(forces).rod_pull, of_rods(state).aside, strict=True)
        for plain, one, pull, aside in of_rod:
            on_columns = np.zeros_like(state.displacement)
            np.subtract.at(on_columns, one.nodes, self._columns_of(pull))
            if one.base is not None:  # what holds the base reaches the sheet through the rod
                node = one.line[one.base]
                on_columns[node] += forces.residual[node]
            nodal = self._about_middle(state, on_columns)[one.line]
            share = actuator_forces.by_segment(plain, nodal, middle[one.line], aside[:, 0] + [0.0, 0.0, 1.0])
            found.update({name: share / len(one.names) for name in one.names})
        motions = [n for n, a in scene.named_actuators().items() if isinstance(a, EdgeMotion)]
        for name, moved in zip(motions, self.supports.moved, strict=True):
            nodal = moved.part[:, None] * self._about_middle(state, forces.residual)[moved.nodes]
            on = middle[moved.nodes]
            arm = on - 0.5 * (on.min(axis=0) + on.max(axis=0))
            moment = np.cross(arm, nodal[:, :3]) + nodal[:, 3:]
            found[name] = np.concatenate([nodal[:, :3].sum(axis=0), moment.sum(axis=0)])[None]
        return {name: found[name] for name in scene.named_actuators()}

    def _about_middle(self, state: State, nodal: np.ndarray) -> np.ndarray:
        """Force and moment about the middle node (n, 6) of nodal forces (n, levels, 3)."""
        now = self.columns.positions + state.displacement
        arm = now - now[:, [self.columns.layers]]
        return np.concatenate([nodal.sum(axis=1), np.cross(arm, nodal).sum(axis=1)], axis=1)

    def _on_rod(self, one: Rod, displacement: np.ndarray, aside: np.ndarray) -> np.ndarray:
        """(n, levels, 3) of the solid, (p, 3, 3) of directors as (k, 3 levels + 9, 3) of a rod's sides."""
        columns = displacement[one.nodes].reshape(len(one.nodes), -1, 3)
        directors = aside[one.places].swapaxes(1, 2).reshape(len(one.nodes), 9, 3)
        return np.concatenate([columns, directors], axis=1)

    def _columns_of(self, of_sides: np.ndarray) -> np.ndarray:
        """The columns' part (k, 3, levels, 3) of (k, 3 levels + 9, 3)."""
        return of_sides[:, :-9].reshape(len(of_sides), 3, -1, 3)

    def _numbers(self, one: Rod, i: int) -> np.ndarray:
        """Unknowns (k, 9 levels + 27) of a rod's sides."""
        k = len(one.nodes)
        parts = (self.number[one.nodes], self.aside_number[i][one.places].swapaxes(1, 2))
        return np.concatenate([part.reshape(k, -1) for part in parts], axis=1)

    def _projection(self, one: Rod, bases: np.ndarray) -> np.ndarray:
        """Z of the columns of a rod's sides, the identity on directors: (k, 9 levels + 27, …)."""
        size = bases.shape[1]
        out = np.tile(np.eye(3 * size + 27), (len(one.nodes), 1, 1))
        for place in range(3):
            block = slice(place * size, (place + 1) * size)
            out[:, block, block] = bases[one.nodes[:, place]]
        return out


def of_rods(state: State) -> RodState:
    """The state, which is one with rods."""
    assert isinstance(state, RodState)
    return state


def with_rods(forces: Forces) -> RodForces:
    """The forces, which are ones with rods."""
    assert isinstance(forces, RodForces)
    return forces


def on_columns(one: Rod, columns: Columns) -> Rod:
    """The rod in terms of Q = (x of a side's three columns; d, m, t at three nodes), (k, 3 levels + 9, 3)."""
    levels, middle, k = columns.levels, columns.layers, len(one.nodes)
    every = np.eye(3 * levels + 9)
    middles, (d, m, t) = every[middle : 3 * levels : levels], every[3 * levels :].reshape(3, 3, -1)
    onto = np.concatenate([middles, d, m])  # (φ, d, m) of Q
    firm = one.stiffness[:, SQUARE]
    forms, stiffness = [np.einsum("ia,sij,jb->sab", onto, one.forms, onto)], [one.stiffness]
    for a, b in ((t, d), (t, m), (d, d), (m, m), (t, t)):
        forms.append(_products(a, b) * (0.5 if a is b else 1.0))
        stiffness.append(firm)
    for level in (level for level in range(levels) if level != middle):
        off = every[level : 3 * levels : levels] - middles
        forms += [_products(off, m), _products(off, t)]
        stiffness += 2 * [firm / columns.thickness**2]
    flat = columns.positions[one.nodes].reshape(k, -1, 3)
    along = np.cross(one.reference[:, 3:6], one.reference[:, 6:])
    total = np.concatenate(stiffness, axis=1)
    return replace(
        one,
        reference=np.concatenate([flat, one.reference[:, 3:], along], axis=1),
        forms=np.concatenate(forms),
        stiffness=total,
        intrinsic=np.pad(one.intrinsic, ((0, 0), (0, total.shape[1] - one.intrinsic.shape[1]))),
        weight=np.einsum("ia,eic->eac", onto, one.weight),
    )


def _products(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """H with ½ Qᵀ H Q = (a Q) · (b Q), of the rows of a and b."""
    return np.einsum("ni,nj->nij", a, b) + np.einsum("ni,nj->nij", b, a)
