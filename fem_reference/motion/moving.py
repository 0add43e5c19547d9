"""What the integrator asks of a reference: a discrete sheet whose coordinates have a constant mass.

    M ü + g(q, u̇, t) ⊥ Z(q),     q: all coordinates, prescribed ones among them,     δq = Z(q) x

q are the nodes' vectors: displacements and, of a shell, directors, which are as many coordinates as a vector
has. |d| = 1 and what supports hold are constraints, and x the unknowns of the tangent space that they leave.
Since M does not depend on q there are no gyroscopic forces: they come from the constraint.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, NamedTuple, Protocol

import numpy as np
from scipy.sparse import csc_matrix, csr_matrix

from sheetbench.numerics.direct import DirectSolver
from sheetbench.scenes import FieldMesh


@dataclass(frozen=True)
class Motion:
    """Coordinates, their rates, accelerations and the algorithm's (N,) at a time [s]; exerted: M a + g."""

    time: float
    q: np.ndarray
    v: np.ndarray
    a: np.ndarray
    algorithm: np.ndarray
    exerted: np.ndarray


class Energies(NamedTuple):
    """Energies [J]; potential: of constant dead loads."""

    kinetic: float
    elastic: float
    potential: float


class Moving(Protocol):
    """A reference in motion: N coordinates q [m, -] of n nodes, unknowns x; times in s, forces in N."""

    label: str
    model: str
    settings: dict[str, Any]
    conservative: bool  # whether the law of strain is linear in Green's strain
    mass: csr_matrix
    unknowns: int

    def start(self) -> np.ndarray:
        """q (N,) at t = 0: flat, or as supports alone bend the sheet."""
        ...

    def placed(self, q: np.ndarray, time: float) -> np.ndarray:
        """q (N,) with what is prescribed at a time, on the constraints."""
        ...

    def rate_placed(self, q: np.ndarray, v: np.ndarray, time: float) -> np.ndarray:
        """u̇ (N,) with what is prescribed from a time on, tangential to the constraints."""
        ...

    def centripetal(self, q: np.ndarray, v: np.ndarray) -> np.ndarray:
        """The part (N,) of ü that the constraints demand at these velocities."""
        ...

    def basis(self, q: np.ndarray) -> csc_matrix:
        """Z (N, unknowns)."""
        ...

    def forces(self, q: np.ndarray, v: np.ndarray, time: float) -> np.ndarray:
        """g (N,): internal and viscous less external forces."""
        ...

    def mean_forces(self, start: np.ndarray, end: np.ndarray, h: float, time: float) -> np.ndarray:
        """g (N,) of the means of a step from one q to another: their strains' mean, not that of the mean."""
        ...

    def tangent(
        self, q: np.ndarray, v: np.ndarray, time: float, residual: np.ndarray, by_a: float, by_v: float
    ) -> csr_matrix:
        """Zᵀ (by_a M + by_v C + K) Z, and what the constraints add under a residual (N,)."""
        ...

    def moved(self, q: np.ndarray, step: np.ndarray) -> np.ndarray:
        """q after a step Z x (N,), on the constraints."""
        ...

    def solver(self) -> DirectSolver:
        """What factorises tangents."""
        ...

    def displacement(self, q: np.ndarray) -> np.ndarray:
        """Displacements (n, 3) [m] of the nodes."""
        ...

    def sample(self, displacement: np.ndarray, points: np.ndarray) -> np.ndarray:
        """Mid-surface displacement (p, 3) [m] at plan points (p, 2) [m], of nodal ones (n, 3)."""
        ...

    def energies(self, q: np.ndarray, v: np.ndarray) -> Energies:
        """Energies of a state."""
        ...

    def spent(self, start: Motion, end: Motion) -> np.ndarray:
        """Energy [J] that dampers dissipate in a step, and work [J] of what moves or acts over time, (2,):
        mean forces times changes, which a rate that jumps at its start does not swell."""
        ...

    def reactions(self, exerted: np.ndarray) -> dict[str, np.ndarray]:
        """Forces (3,) [N] of what holds the sheet, of M ü + g (N,)."""
        ...

    def mesh(self, displacement: np.ndarray) -> FieldMesh:
        """The sheet for drawing, of nodal displacements (n, 3)."""
        ...
