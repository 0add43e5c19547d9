"""What a plate's forces leave over, on the flat sheet, those of the loads being the scene's own.

A small rigid motion strains neither plate nor rods, so that K u has neither a force nor a moment,
Σ X × f_φ + e_z × f_d + m × f_m = 0 (see `surface.balance`): what is left over is the rounding of K u. A
direct solution, refined once, has no other residual.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.sparse import csr_matrix

from fem_reference.plate.rods import PlateRods
from fem_reference.surface.actuator_forces import OnEdge
from fem_reference.surface.balance import Surface, left_over
from sheetbench.scenes import Balance, Scene

EPSILON = float(np.finfo(float).eps)
ROUNDINGS = 4.0  # of a term of K u: K is Bᵀ C B times an area


@dataclass(frozen=True)
class Solved:
    """K u = f of all unknowns (N,), solved for those that are free (k,)."""

    stiffness: csr_matrix
    force: np.ndarray
    u: np.ndarray
    free: np.ndarray

    @cached_property
    def unbalanced(self) -> np.ndarray:
        """K u − f (N,): where held, what holds."""
        return self.stiffness @ self.u - self.force

    @property
    def held(self) -> np.ndarray:
        """K u − f (N,), zero where free."""
        out = self.unbalanced.copy()
        out[self.free] = 0.0
        return out

    @property
    def size(self) -> float:
        """Norms of the load and of what holds, which residuals are measured against."""
        return float(np.linalg.norm(self.force) + np.linalg.norm(self.held))

    @property
    def residual(self) -> float:
        """Norm of what is left on the free unknowns, relative to the size."""
        return float(np.linalg.norm(self.unbalanced[self.free]) / (self.size or 1.0))

    @property
    def rounding(self) -> np.ndarray:
        """What rounding may leave of each (N,), of the solver's residual too, which is as small as that."""
        return ROUNDINGS * EPSILON * (abs(self.stiffness) @ np.abs(self.u) + np.abs(self.force))


def balance(
    scene: Scene,
    surface: Surface,
    rods: PlateRods,
    solved: Solved,
    reactions: dict[str, np.ndarray],
    edges: Sequence[OnEdge],
) -> Balance:
    """The balance of what is solved; reactions (3,) [N] by name; edges: what the rods exert there."""
    vectors = np.concatenate([surface.position, surface.director, rods.bound.own])
    on_vectors = np.where(rods.number >= 0, solved.held[rods.number], 0.0)
    n, per_unknown = len(surface.position), np.full(len(solved.u), 1.0 / surface.lever)  # of couples
    per_unknown[rods.number[:n]] = 1.0
    held = [(vectors[:n], on_vectors[:n]), (vectors[n:], on_vectors[n:])]
    return left_over(
        scene, surface, edges, reactions, held, solved.size, float(per_unknown @ solved.rounding)
    )
