"""Statics of a discrete sheet for the path tracer: at rest, with the load factor in place of the time.

A step of Newton's method goes to equilibrium and to the prescribed displacements,

    Zᵀ K Z x = −Zᵀ (R + K δ),    q + δ + Z x,

R = Bᵀ s − λ f is the residual on all coordinates, δ the step to prescribed values and constraints; strain,
load and constraint are polynomials in q. `mixed` takes the stresses that the last step extrapolated, s + D B
δq, for the geometric stiffness and the constraints' own (see `continuation.trace`), and of bricks the
extrapolated pressure: near ν = ½ the current pressure has a large error until volumes fit.
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
    """Coordinates q (N,) with extrapolated stresses, or without, where the stresses of q itself count. stress
    (m, k) of the elements; pressure, where the law has one of its own; on_rods (k, s) of the rods."""

    q: np.ndarray
    stress: np.ndarray | None = None
    pressure: np.ndarray | None = None
    on_rods: OnRods = ()


@dataclass(frozen=True)
class Forces:
    """Forces of a state: shape, stresses (k, s) of the rods, residual (N,). size: of the balancing forces
    [N]; gap_step: the step (N,) to the prescribed displacements."""

    shape: SheetShape
    on_rods: OnRods
    residual: np.ndarray
    size: float
    gap_step: np.ndarray


class Static(Creeping[StaticState, Forces]):
    """Sheet of elements, ready for `trace_path`."""

    def __init__(self, sheet: DiscreteElements):
        self.sheet, self.prestrained = sheet, sheet.natural is not None
        self.contacts, self.linear = sheet.contacts, sheet.linear
        self.symmetric, self.unknowns = sheet.symmetric, sheet.unknowns
        self.size = max(sheet.scene.sheet.lengths)
        self._last: SheetShape | None = None

    def shape(self, state: StaticState, load_factor: float) -> SheetShape:
        """Return the sheet at a state; a repeated call returns the shape already formed."""
        if (last := self._last) is None or last.q is not state.q or last.at != load_factor:
            self._last = last = self.sheet.shape(state.q, load_factor)
        return last

    def rest(self) -> StaticState:
        """Return the flat state, free of stress where nothing acts on it."""
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

    def creep_step(self, state: StaticState, load_factor: float, drag: float) -> Static:
        return Static(self.sheet.creep_step(self.shape(state, load_factor), drag))

    def forces(self, state: StaticState, load_factor: float) -> Forces:
        sheet, shape = self.sheet, self.shape(state, load_factor)
        external = sheet.external(shape)
        residual = sheet.scatter(sheet.element.forces(shape.operator, shape.elastic))
        on_held = sheet.displacement(residual).ravel()[sheet.held]
        size = sheet.norm_of(external, sheet.scale) + sheet.norm_of(on_held)
        if sheet.natural is not None:  # often all that loads it
            pull = sheet.element.forces(shape.operator, sheet.element.stress(sheet.natural.at(load_factor)))
            size += sheet.norm_of(sheet.scatter(pull), sheet.scale)
        residual -= external
        on_rods = tuple(body.stress(shape) for body in sheet.bodies)
        for body, stress in zip(sheet.bodies, on_rods, strict=True):
            residual += body.scatter(body.pull(shape.q, stress))
            size += sheet.norm_of((body.driving(shape) / sheet.scale_of(body)).ravel())
        return Forces(shape, on_rods, residual, size, sheet.gap_step(shape))

    def imbalance(self, state: StaticState, forces: Forces) -> float:
        reduced = self.sheet.reduce(forces.shape, forces.residual / self.sheet.scale)
        return float(np.linalg.norm(reduced, self.sheet.norm))

    def gap(self, state: StaticState, load_factor: float) -> float:
        """Return the largest distance from prescribed displacements over the sheet's size."""
        step = self.sheet.gap_step(self.shape(state, load_factor)) * self.sheet.scale
        return float(np.abs(step).max() / self.sheet.longer_side)

    def linearised(
        self, state: StaticState, forces: Forces, load_factor: float, mixed: bool = True
    ) -> tuple[csr_matrix, np.ndarray]:
        sheet, shape, residual = self.sheet, forces.shape, forces.residual
        stress, on_rods, pressure = shape.elastic, forces.on_rods, None
        if mixed and state.stress is not None:
            stress, on_rods, pressure = state.stress, state.on_rods, state.pressure
            # the constraints' stiffness uses the residual of the extrapolated stresses
            residual = residual + sheet.scatter(sheet.element.forces(shape.operator, stress - shape.elastic))
            for body, extrapolated, current in zip(sheet.bodies, on_rods, forces.on_rods, strict=True):
                residual += body.scatter(body.pull(shape.q, extrapolated - current))
        moduli, move = sheet.moduli(shape, pressure), forces.gap_step if forces.gap_step.any() else None
        matrix, product = sheet.system(shape, moduli, stress, on_rods, residual, move=move)
        return matrix, -sheet.reduce(shape, forces.residual + product)

    def advance(
        self, state: StaticState, forces: Forces, load_factor: float, step: np.ndarray
    ) -> StaticState:
        sheet, shape = self.sheet, forces.shape
        move = sheet.expand(shape, step) + forces.gap_step
        by = sheet.element.step(shape.operator, sheet.gather(move))
        rods = zip(sheet.bodies, forces.on_rods, strict=True)
        on_rods = tuple(body.extrapolated(shape, stress_before, move) for body, stress_before in rods)
        stress = shape.elastic + weighed(sheet.moduli(shape, state.pressure), by)
        return StaticState(state.q + move, stress, sheet.pressure(shape, by), on_rods)

    def loading(self) -> float:
        flat = self.sheet.shape(np.zeros(self.sheet.size), 1.0)
        return float(np.abs(self.sheet.displacement(self.sheet.external(flat))).sum())

    def configuration(self, state: StaticState, load_factor: float) -> SheetShape:
        return self.sheet.shape(state.q, load_factor)

    def restarted(self, state: StaticState, before: StaticState, beyond: float) -> tuple[StaticState, float]:
        moved = replace(state, q=state.q + beyond * (state.q - before.q))
        return moved, self.potential(moved, 1.0)[1]

    def length(self, start: StaticState, end: StaticState) -> float:
        moved = self.sheet.displacement(end.q) - self.sheet.displacement(start.q)
        return float(np.abs(moved).max() / self.sheet.longer_side)
