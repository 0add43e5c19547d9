"""What the solvers ask of a structure, whose states and forces are its own."""

from __future__ import annotations

from typing import Protocol, TypeVar

import numpy as np
from scipy.sparse import csr_matrix


class Balance(Protocol):
    """Forces at a state. size: of those that balance [N], which residuals are measured against."""

    @property
    def size(self) -> float: ...


State = TypeVar("State")
Forces = TypeVar("Forces", bound=Balance)


class Structure(Protocol[State, Forces]):
    """What `trace_path` needs; states and forces are the structure's own."""

    @property
    def symmetric(self) -> bool:
        """Whether the tangent is."""

    def rest(self) -> State:
        """The state that the path sets out from."""

    def forces(self, state: State, load_factor: float) -> Forces:
        """Internal less external forces."""

    def imbalance(self, state: State, forces: Forces) -> float:
        """Of the free unknowns [N]."""

    def gap(self, state: State, load_factor: float) -> float:
        """Distance from what is prescribed, relative to the structure's size."""

    def system(
        self, state: State, forces: Forces, load_factor: float, mixed: bool = True
    ) -> tuple[csr_matrix, np.ndarray]:
        """Tangent and right-hand side of a step; mixed: with the stress that the last step extrapolated."""

    def advance(self, state: State, forces: Forces, load_factor: float, step: np.ndarray) -> State:
        """The state after a step."""

    def length(self, start: State, end: State) -> float:
        """Between two states, relative to the structure's size."""


class Creeping(Structure[State, Forces], Protocol[State, Forces]):
    """What `relax` needs beside: a structure that can creep under dead loads."""

    def unextrapolated(self, state: State) -> State:
        """The state with its own stresses."""

    def potential(self, state: State, load_factor: float) -> tuple[float, float]:
        """Strain energy less the loads' work, and the sum of their magnitudes [J]."""

    def dragged(self, state: State, load_factor: float, drag: float) -> Creeping[State, Forces]:
        """The structure whose equilibrium at this load factor is the end of a step of creep from a state."""

    @property
    def unknowns(self) -> int:
        """How many there are."""
