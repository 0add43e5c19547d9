"""What an actuator is to the sheet: what it exerts on its edge, and, if it is a body, how it moves with it.

A prescribed motion is no more than an `Actuator`: it puts masses where they have to be, and what holds them
there is found from the sheet. A `Body` has a state of its own. It brings rows of displacement, (rows, 3) [m],
which only it understands, and binds masses of the edge to them: the displacement of bound mass i is
binding[i] @ rows. The sheet's equations never see more; equal and opposite forces follow, because one
transpose of `binding` carries the masses' forces to the body. Its forces derive from a Lagrangian: multiplier
rows, if it has constraints, enter like any other row, with the constraint's residual as their force.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np


@dataclass(frozen=True)
class Drive:
    """How far commands are: a share of their last value (statics), or, with a time [s], their value then."""

    load_factor: float = 1.0
    time: float | None = None


@dataclass(frozen=True)
class Acting:
    """What acts between an actuator and the sheet: where its masses are (m, 3) [m], what holds them (m, 3)
    and its rows (rows, 3) [N], and its rows' displacement y (rows, 3) [m]."""

    positions: np.ndarray
    on_masses: np.ndarray
    on_rows: np.ndarray
    y: np.ndarray


class Actuator(Protocol):
    """One actuator model on one edge.

    names: of the scene's actuators that it stands for, one or several; edge: where; masses: (m,) whose
    displacement it gives.
    """

    names: tuple[str, ...]
    edge: str
    masses: np.ndarray

    def reactions(self, acting: Acting) -> dict[str, np.ndarray]:
        """Force (3,) [N] of what holds the actuator, by its name among a solution's reactions; empty where
        nothing holds it."""
        ...

    def held_moment(self, acting: Acting, drive: Drive) -> np.ndarray:
        """Moment (3,) [N·m] about the origin of what holds the actuator, a corner's among it."""
        ...

    def wrenches(self, acting: Acting) -> np.ndarray:
        """Force and moment (names, segments, 6) [N, N·m] on the sheet, and on corners that hold it."""
        ...


class Body(Actuator, Protocol):
    """An actuator that moves by laws of its own.

    rows: number of its own rows; free: (rows, 3) bool, those that can move; multipliers: number of
    constraints; pairs: (rows, rows) bool, rows that appear together in tangent, damping or mass.
    binding: (m, rows) of its masses; mass: (rows, rows) [kg], for each of the three axes; carried: force [N]
    whose rounding the residual cannot fall below; rest: value at rest (k, 3) [m] of what its first rows
    change, points and then directors, which turn as arms do; axis: the points (p, 3) among them, where its
    segments end; corners: its ends (0, 1) at which a corner of the sheet holds it.
    """

    rows: int
    free: np.ndarray
    multipliers: int
    pairs: np.ndarray
    binding: np.ndarray
    mass: np.ndarray
    carried: float
    rest: np.ndarray
    axis: np.ndarray
    corners: tuple[int, ...]

    def weight(self, acceleration: np.ndarray) -> np.ndarray:
        """Dead force (rows, 3) [N] of a uniform acceleration on the rows."""
        ...

    def force(self, y: np.ndarray, drive: Drive) -> tuple[float, np.ndarray]:
        """Energy [J] and gradient of the Lagrangian (rows, 3) [N]."""
        ...

    def average_force(self, start: np.ndarray, end: np.ndarray, drive: Drive) -> np.ndarray:
        """Force (rows, 3) whose product with (end − start) is the change of energy at a fixed command."""
        ...

    def tangent(self, y: np.ndarray, drive: Drive) -> np.ndarray:
        """Second derivatives of the Lagrangian, (rows, 3, rows, 3) [N/m]."""
        ...

    def constraint_gradient(self, y: np.ndarray) -> np.ndarray:
        """Derivatives (multipliers, rows, 3) of the multiplier rows' forces."""
        ...

    def command_force(self, y: np.ndarray, drive: Drive) -> np.ndarray:
        """Derivative (rows, 3) [N] of the force by the load factor, at the drive's load factor."""
        ...

    def command_power(self, y: np.ndarray, drive: Drive, later: Drive) -> float:
        """Work [J] done on the actuator when its command goes from one drive to the next at fixed rows."""
        ...

    def damping_force(self, y: np.ndarray, v: np.ndarray) -> tuple[float, np.ndarray]:
        """Power taken [W] and damping force (rows, 3) [N]."""
        ...

    def damping_tangent(self, y: np.ndarray) -> np.ndarray:
        """Derivative of the damping force by the velocity, (rows, 3, rows, 3) [N·s/m]."""
        ...

    def place_corner(self, end: int, layers: np.ndarray, moved: np.ndarray) -> np.ndarray:
        """Displacement (rows, 3) [m] that follows a corner's layers at the heights (l,), moved by (l, 3)."""
        ...

    def corner_force(self, end: int, exerted: np.ndarray) -> np.ndarray:
        """Force (3,) [N] that holds the end at a corner, from what is exerted on the rows."""
        ...
