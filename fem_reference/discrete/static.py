"""Statics of a discrete sheet: at rest, with its load factor in place of the time, as the path tracer has it.

With R = Bᵀ s − λ f the residual on all coordinates, a step goes to equilibrium and onto what is prescribed,

    Zᵀ K Z x = −Zᵀ (R + K δ),    q + δ + Z x,

with δ the step to prescribed values and constraints. All of strain, load and constraint being polynomials in
q, it is Newton's; `mixed` takes the stresses that the last step extrapolated, s + D B δq, for the geometric
stiffness and the constraints' own (see `continuation.trace`), and of bricks the extrapolated pressure: near
ν = ½ the current one is a large error until volumes fit.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from scipy.sparse import csr_matrix

from fem_reference.discrete.elements import DiscreteElements
from fem_reference.discrete.shape import SheetShape
from fem_reference.shell.element import weighed
from sheetbench.numerics.continuation.structure import Creeping

OnRods = tuple[np.ndarray, ...]


@dataclass(frozen=True)
class StaticState:
    """q (N,); extrapolated: stress (m, k) of the elements, their pressure, where the law has one of its own,
    and stresses (k, s) of the rods; the sheet's own where None."""

    q: np.ndarray
    stress: np.ndarray | None = None
    pressure: np.ndarray | None = None
    on_rods: OnRods = ()


@dataclass(frozen=True)
class Forces:
    """At a state: its shape, stresses (k, s) of the rods, residual (N,), size of the forces that balance [N],
    and the step (N,) to what is prescribed."""

    shape: SheetShape
    on_rods: OnRods
    residual: np.ndarray
    size: float
    short: np.ndarray


class Static(Creeping[StaticState, Forces]):
    """A sheet of elements, ready for `trace_path`."""

    def __init__(self, sheet: DiscreteElements):
        self.sheet, self.prestrained = sheet, sheet.natural is not None
        self.contacts, self.linear = sheet.contacts, sheet.linear
        self.symmetric, self.unknowns = sheet.symmetric, sheet.unknowns
        self.size = max(sheet.scene.sheet.lengths)
        self._last: SheetShape | None = None

    def shape(self, state: StaticState, load_factor: float) -> SheetShape:
        """The sheet at a state, one and the same for all who look at that in turn."""
        if (last := self._last) is None or last.q is not state.q or last.at != load_factor:
            self._last = last = self.sheet.shape(state.q, load_factor)
        return last

    def rest(self) -> StaticState:
        """Flat, and free of stress where nothing acts on it."""
        return StaticState(np.zeros(self.sheet.size))

    def unextrapolated(self, state: StaticState) -> StaticState:
        return StaticState(state.q)

    def with_stresses(self, state: StaticState, of: StaticState) -> StaticState:
        return replace(of, q=state.q)

    def potential(self, state: StaticState, load_factor: float) -> tuple[float, float]:
        sheet, shape = self.sheet, self.shape(state, load_factor)
        stored = sheet.elastic(shape) + sum(body.energy(state.q, load_factor) for body in sheet.bodies)
        of_items = sum(item.potential(shape) for item in sheet.items)
        return stored + of_items, stored + abs(of_items)

    def dragged(self, state: StaticState, load_factor: float, drag: float) -> Static:
        return Static(self.sheet.dragged(self.shape(state, load_factor), drag))

    def forces(self, state: StaticState, load_factor: float) -> Forces:
        sheet, shape = self.sheet, self.shape(state, load_factor)
        external = sheet.external(shape)
        residual = sheet.scatter(sheet.element.forces(shape.operator, shape.elastic))
        on_held = sheet.displacement(residual).ravel()[sheet.held]
        size = sheet.measured(external, sheet.scale) + sheet.measured(on_held)
        if sheet.natural is not None:  # often all that loads it
            pull = sheet.element.forces(shape.operator, sheet.element.stress(sheet.natural.at(load_factor)))
            size += sheet.measured(sheet.scatter(pull), sheet.scale)
        residual -= external
        on_rods = tuple(body.stress(shape) for body in sheet.bodies)
        for body, stress in zip(sheet.bodies, on_rods, strict=True):
            residual += body.scatter(body.pull(shape.q, stress))
            size += sheet.measured((body.driving(shape) / sheet.scale_of(body)).ravel())
        return Forces(shape, on_rods, residual, size, sheet.short(shape))

    def imbalance(self, state: StaticState, forces: Forces) -> float:
        left = self.sheet.reduce(forces.shape, forces.residual / self.sheet.scale)
        return float(np.linalg.norm(left, self.sheet.norm))

    def gap(self, state: StaticState, load_factor: float) -> float:
        """Largest distance from what is prescribed, relative to the sheet's size, or change of a director."""
        step = self.sheet.short(self.shape(state, load_factor)) * self.sheet.scale
        return float(np.abs(step).max() / self.sheet.lever)

    def linearised(
        self, state: StaticState, forces: Forces, load_factor: float, mixed: bool = True
    ) -> tuple[csr_matrix, np.ndarray]:
        sheet, shape, residual = self.sheet, forces.shape, forces.residual
        stress, on_rods, pressure = shape.elastic, forces.on_rods, None
        if mixed and state.stress is not None:
            stress, on_rods, pressure = state.stress, state.on_rods, state.pressure
            # of constraints: under the residual that these stresses leave
            residual = residual + sheet.scatter(sheet.element.forces(shape.operator, stress - shape.elastic))
            for body, own, now in zip(sheet.bodies, on_rods, forces.on_rods, strict=True):
                residual += body.scatter(body.pull(shape.q, own - now))
        moduli, move = sheet.moduli(shape, pressure), forces.short if forces.short.any() else None
        matrix, product = sheet.system(shape, moduli, stress, on_rods, residual, move=move)
        return matrix, -sheet.reduce(shape, forces.residual + product)

    def advance(
        self, state: StaticState, forces: Forces, load_factor: float, step: np.ndarray
    ) -> StaticState:
        sheet, shape = self.sheet, forces.shape
        move = sheet.expand(shape, step) + forces.short
        by = sheet.element.step(shape.operator, sheet.gather(move))
        rods = zip(sheet.bodies, forces.on_rods, strict=True)
        on_rods = tuple(body.extrapolated(shape, own, move) for body, own in rods)
        stress = shape.elastic + weighed(sheet.moduli(shape, state.pressure), by)
        return StaticState(state.q + move, stress, sheet.pressure(shape, by), on_rods)

    def loading(self) -> float:
        flat = self.sheet.shape(np.zeros(self.sheet.size), 1.0)
        return float(np.abs(self.sheet.displacement(self.sheet.external(flat))).sum())

    def placed(self, state: StaticState, load_factor: float) -> SheetShape:
        return self.sheet.shape(state.q, load_factor)

    def restarted(self, state: StaticState) -> tuple[StaticState, float]:
        return state, self.potential(state, 1.0)[1]

    def length(self, start: StaticState, end: StaticState) -> float:
        moved = self.sheet.displacement(end.q) - self.sheet.displacement(start.q)
        return float(np.abs(moved).max() / self.sheet.lever)
