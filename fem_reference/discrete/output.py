"""Output of a discrete sheet of coordinates q: displacements, reactions, its surface, the forces on it."""

from __future__ import annotations

from abc import ABC, abstractmethod

import numpy as np

from fem_reference.surface.actuator_forces import HoldingForces, OnEdge
from fem_reference.surface.balance import Surface
from fem_reference.surface.location import interpolate
from fem_reference.surface.mesh import Plan
from sheetbench.answers.solution import FieldMesh


class Output(ABC):
    """Output of a sheet on a plan with N coordinates q. size: N."""

    plan: Plan
    size: int

    @abstractmethod
    def displacement(self, q: np.ndarray) -> np.ndarray:
        """Displacements (k, 3) [m] of the nodes, a view."""

    def middles(self, displacement: np.ndarray) -> np.ndarray:
        """Those (n, 3) [m] of the plan's nodes on the mid-surface."""
        return displacement

    def sample(self, displacement: np.ndarray, points: np.ndarray) -> np.ndarray:
        """Mid-surface displacement (p, 3) [m] at plan points (p, 2) [m], of nodal ones as `displacement`."""
        return interpolate(self.plan.mesh, self.plan.elements, self.middles(displacement), points)

    @abstractmethod
    def reactions(self, exerted: np.ndarray, at: float = 1.0) -> dict[str, np.ndarray]:
        """Forces (3,) [N] of what holds the sheet, of M ü + g (N,)."""

    @abstractmethod
    def drawn(self, q: np.ndarray, line_force: np.ndarray | None = None) -> FieldMesh:
        """The sheet for drawing, and the line force (n, 3) [N/m] of actuators on it."""

    def mesh(self, displacement: np.ndarray) -> FieldMesh:
        """The sheet for drawing, of nodal displacements as `displacement`."""
        q = np.zeros(self.size)
        self.displacement(q)[:] = displacement
        return self.drawn(q)

    @abstractmethod
    def surface(self, q: np.ndarray) -> Surface:
        """The sheet as it lies."""

    @abstractmethod
    def exerted(self, q: np.ndarray, exerted: np.ndarray) -> HoldingForces:
        """Force and couple on the nodes of g (N,)."""

    @abstractmethod
    def on_edges(self, q: np.ndarray, pull: np.ndarray) -> list[OnEdge]:
        """What the rods exert, which pull at their sides' vectors (k, a, 3)."""

    @abstractmethod
    def holding(self, q: np.ndarray, exerted: np.ndarray, at: float) -> list[tuple[np.ndarray, np.ndarray]]:
        """Where, and with which forces of g (N,), the sheet is held, pairs (…, 3), its nodes first."""
