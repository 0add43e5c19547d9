"""What the path tracer asks of a structure, whose states, forces and matrices are its own."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple, Protocol, TypeVar

import numpy as np

from sheetbench.numerics.direct import SOLVED, Count, Factor

State = TypeVar("State")
Forces = TypeVar("Forces", bound=Any)  # `size`: of those that balance [N], by which residuals are measured
Matrix = Any  # what `Solver.factor` takes


class Correction(NamedTuple):
    """A step (n,) with the factors and the right-hand side (n,) that it is of, and the state after it."""

    factor: Factor
    step: np.ndarray
    rows: np.ndarray
    state: Any


class Solver(Protocol):
    """What gives factors of a structure's matrices."""

    def factor(self, matrix: Matrix, more: Count = ...) -> Factor:
        """Return the factors; more: called once a further factorisation that they take. Raises
        SingularMatrixError."""

    def iterated(self, matrix: Matrix, near: Factor, rows: np.ndarray) -> np.ndarray | None:
        """Return the solution by iterations with the factors of a matrix close by; None where factors of its
        own cost less."""


class Structure(Protocol[State, Forces]):
    """What `trace_path` needs. A structure that inherits this leaves out what has a default here."""

    prestrained: bool = False  # whether a natural strain loads it, which may stress it where it does not move
    linear: bool = False  # whether its tangent is the same everywhere, and so the first correction exact
    contacts: Sequence[Any] = ()  # penalties (`stiffening`), with which the rest here is of interest
    size: float = 1.0  # [m]
    symmetric: bool  # whether the tangent is
    multipliers: int = 0  # constraints among the unknowns: negative eigenvalues of every tangent

    def loading(self) -> float:
        """Sum of the full loads on the structure at rest [N]."""
        return 0.0

    def placed(self, state: State, load_factor: float) -> Any:
        """A state at a load factor as its contacts take it."""

    def restarted(self, state: State) -> tuple[State, float]:
        """A state at full load without forces that are of other penalties, and the size of its energy [J]."""
        return state, 0.0

    def rest(self) -> State:
        """The state that the path sets out from."""

    def forces(self, state: State, load_factor: float) -> Forces:
        """Internal less external forces."""

    def imbalance(self, state: State, forces: Forces) -> float:
        """Of the free unknowns [N]."""

    def imbalance_floor(self, state: State) -> float:
        """What rounding leaves of the imbalance at a state [N]."""
        return 0.0

    def gap(self, state: State, load_factor: float) -> float:
        """Distance from what is prescribed, relative to the structure's size."""

    def rows(self, state: State, forces: Forces, load_factor: float) -> np.ndarray | None:
        """Right-hand side of a step to equilibrium, where it does not need the tangent."""
        return None

    def linearised(
        self, state: State, forces: Forces, load_factor: float, mixed: bool = True
    ) -> tuple[Matrix, np.ndarray]:
        """Tangent and right-hand side of a step; mixed: with the stress that the last step extrapolated."""

    def sparse(self, matrix: Matrix) -> Any:
        """Return a tangent as a SciPy matrix."""
        return matrix

    def advance(self, state: State, forces: Forces, load_factor: float, step: np.ndarray) -> State:
        """The state after a step."""

    def solved(
        self, state: State, forces: Forces, load_factor: float, factor: Factor, rows: np.ndarray
    ) -> Correction:
        """The correction of factors and a right-hand side."""
        step = factor.solve(rows, SOLVED)
        return Correction(factor, step, rows, self.advance(state, forces, load_factor, step))

    def correct(self, state: State, forces: Forces, load_factor: float, count: Count) -> Correction | None:
        """Return the correction of the tangent's own factors (counted), with what the last step extrapolated,
        made at once; None where it is not."""
        return None

    def with_stresses(self, state: State, of: State) -> State:
        """A state with the stresses that a step to another has extrapolated."""

    def length(self, start: State, end: State) -> float:
        """Between two states, relative to the structure's size."""

    def has_meaning(self, state: State) -> bool:
        """Whether the model's law holds at its strains."""
        return True


class Creeping(Structure[State, Forces], Protocol[State, Forces]):
    """What `relax` needs beside: a structure that can creep under dead loads."""

    def unextrapolated(self, state: State) -> State:
        """The state with its own stresses."""

    def potential(self, state: State, load_factor: float) -> tuple[float, float]:
        """Strain energy less the loads' work, and the sum of their magnitudes [J]."""

    def dragged(self, state: State, load_factor: float, drag: float) -> Creeping[State, Forces]:
        """The structure whose equilibrium at this load factor is the end of a step of creep from a state."""

    unknowns: int
