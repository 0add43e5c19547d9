"""Interface of the path tracer to a structure with its own states, forces and matrices."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple, Protocol, TypeVar

import numpy as np

from sheetbench.numerics.direct import SOLVED, Count, Factor

State = TypeVar("State")
Forces = TypeVar("Forces", bound=Any)  # with `size`, of the forces in balance [N], the scale of residuals
Matrix = Any  # argument of `Solver.factor`


class Correction(NamedTuple):
    """A step (n,), its factors and its right-hand side (n,), and the state after it."""

    factor: Factor
    step: np.ndarray
    rows: np.ndarray
    state: Any


class Solver(Protocol):
    """Factorisation of a structure's matrices."""

    def factor(self, matrix: Matrix, more: Count = ...) -> Factor:
        """Return the factors of a matrix. Raises SingularMatrixError. more: called for each further
        factorisation."""

    def iterated(self, matrix: Matrix, near: Factor, rows: np.ndarray) -> np.ndarray | None:
        """Return the solution by iterations with a nearby matrix's factors, None if new ones cost less."""


class Structure(Protocol[State, Forces]):
    """Interface of `trace_path`. A structure that inherits it may omit members with a default."""

    prestrained: bool = False  # whether a natural strain loads it, perhaps without displacement
    linear: bool = False  # whether its tangent is constant, so that the first correction is exact
    contacts: Sequence[Any] = ()  # penalties (`stiffening`)
    size: float = 1.0  # [m]
    symmetric: bool  # whether the tangent is
    multipliers: int = 0  # number of constraints: negative eigenvalues of every tangent

    def loading(self) -> float:
        """Return the magnitude [N] of the full load on the structure at rest."""
        return 0.0

    def configuration(self, state: State, load_factor: float) -> Any:
        """Return the argument of the penalties' method `near` for a state at a load factor."""

    def restarted(self, state: State, before: State, beyond: float) -> tuple[State, float]:
        """Return a start at full load for other penalties, and the size of its energy [J]: the state
        extrapolated beyond `state` by `beyond` times its distance from `before`."""
        return state, 0.0

    def rest(self) -> State:
        """Return the state at the start of a path."""

    def forces(self, state: State, load_factor: float) -> Forces:
        """Return internal less external forces."""

    def imbalance(self, state: State, forces: Forces) -> float:
        """Return the imbalance of the free unknowns [N]."""

    def imbalance_floor(self, state: State) -> float:
        """Return the part of the imbalance at a state that is rounding [N]."""
        return 0.0

    def gap(self, state: State, load_factor: float) -> float:
        """Return the distance from prescribed displacements, relative to the structure's size."""

    def rows(self, state: State, forces: Forces, load_factor: float) -> np.ndarray | None:
        """Return the right-hand side of a step to equilibrium, None if it depends on the tangent."""
        return None

    def linearised(
        self, state: State, forces: Forces, load_factor: float, mixed: bool = True
    ) -> tuple[Matrix, np.ndarray]:
        """Return tangent and right-hand side of a step; mixed: with the last step's extrapolated stress."""

    def sparse(self, matrix: Matrix) -> Any:
        """Return a tangent as a SciPy matrix."""
        return matrix

    def advance(self, state: State, forces: Forces, load_factor: float, step: np.ndarray) -> State:
        """Return the state after a step."""

    def solved(
        self, state: State, forces: Forces, load_factor: float, factor: Factor, rows: np.ndarray
    ) -> Correction:
        """Return the correction with given factors and right-hand side."""
        step = factor.solve(rows, SOLVED)
        return Correction(factor, step, rows, self.advance(state, forces, load_factor, step))

    def correct(self, state: State, forces: Forces, load_factor: float, count: Count) -> Correction | None:
        """Return the correction with the factors of the tangent by one call, or None without this call. The
        factorisation is counted. The tangent has the last step's extrapolated stress."""
        return None

    def with_stresses(self, state: State, of: State) -> State:
        """Return a state with the stresses that a step to another state has extrapolated."""

    def length(self, start: State, end: State) -> float:
        """Return the distance of two states, relative to the structure's size."""

    def has_meaning(self, state: State) -> bool:
        """Return whether the model's law is valid at the strains of a state."""
        return True


class Creeping(Structure[State, Forces], Protocol[State, Forces]):
    """Interface of `relax`: a structure that can creep under dead loads."""

    def unextrapolated(self, state: State) -> State:
        """Return a state with its own stresses."""

    def potential(self, state: State, load_factor: float) -> tuple[float, float]:
        """Return the strain energy less the loads' work, and the sum of their magnitudes [J]."""

    def creep_step(self, state: State, load_factor: float, drag: float) -> Creeping[State, Forces]:
        """Return the structure whose equilibrium at a load factor is the end of a creep step from a state."""

    unknowns: int
