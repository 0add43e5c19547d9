"""State of the tracing of an equilibrium path, and reasons for its end."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Generic, NamedTuple

from sheetbench.answers.solution import Iteration, Status
from sheetbench.numerics.continuation.limits import Limits
from sheetbench.numerics.continuation.structure import Forces, Matrix, Solver, State, Structure
from sheetbench.numerics.direct import Factor

Progress = Callable[[Iteration], None]


class Fault(NamedTuple):
    """A reason to reject an equilibrium: its status and a message."""

    status: Status
    message: str


@dataclass
class Path(Generic[State, Forces]):
    """State of the tracing of a structure's path: the last equilibrium, its load factor, and the cost so far.

    inspect: called with the path at every equilibrium; a fault that it returns ends the path. settle: returns
    the stable state, under conservative loads, at a load factor beyond a limit point, from which the path
    continues; raises LoadStepFailed if there is none. limit: present limit of factorisations. alike: change
    of strain below which the tangent counts as unchanged. snaps: load factors of snaps. fault: the reason of
    an early end. notes: warnings. progress: called at every iteration. factor: of the equilibrium's tangent,
    if available.
    """

    structure: Structure[State, Forces]
    solver: Solver
    state: State
    load_factor: float = 0.0
    status: Status = Status.STEP_LIMIT
    factorisations: int = 0
    limits: Limits = field(default_factory=Limits)
    history: list[Iteration] = field(default_factory=list)
    snaps: list[float] = field(default_factory=list)
    fault: Fault | None = None
    notes: list[str] = field(default_factory=list)
    progress: Progress | None = None
    factor: Factor | None = None
    alike: float = 0.0
    inspect: Inspect[State, Forces] = lambda path: None
    settle: Settle[State, Forces] | None = None

    def __post_init__(self) -> None:
        self.limit = self.limits.factorisations

    def begin(self, limits: Limits | None = None) -> None:
        """Return to rest, with the full number of factorisations."""
        self.rest()
        self.limits = limits or self.limits
        self.limit = self.factorisations + self.limits.factorisations
        self.forget()

    def rest(self) -> None:
        """Return to the state at rest."""
        self.put(self.structure.rest(), 0.0)

    def put(self, state: State, load_factor: float, factor: Factor | None = None) -> None:
        """Move to an equilibrium."""
        self.state, self.load_factor, self.factor = state, load_factor, factor

    def forget(self) -> None:
        """Drop snaps and notes."""
        self.snaps.clear()
        self.notes.clear()

    def factored(self, matrix: Matrix) -> Factor:
        """Return the factors of a matrix and count them. Raises SingularMatrixError."""
        self.count()
        return self.solver.factor(matrix, self.count)

    def count(self) -> None:
        """Count a factorisation."""
        self.factorisations += 1

    def tangent(self, state: State, load_factor: float) -> Matrix:
        """Return the true tangent at a state: with its own stresses, none extrapolated."""
        forces = self.structure.forces(state, load_factor)
        return self.structure.linearised(state, forces, load_factor, mixed=False)[0]

    def note(self, load_factor: float, residual: float, step: float) -> None:
        """Record an iteration and report it to `progress`."""
        self.history.append(Iteration(load_factor, residual, step))
        if self.progress is not None:
            self.progress(self.history[-1])


Inspect = Callable[[Path[State, Forces]], Fault | None]  # a reason to end a path at its last equilibrium
Settle = Callable[[Path[State, Forces], float], State]  # a stable state beyond a limit point


class LoadStepFailed(ArithmeticError):
    """A load step without an equilibrium. status: of its end; length: of its first linear step."""

    def __init__(self, status: Status, reason: str, length: float):
        super().__init__(reason)
        self.status, self.length = status, length
