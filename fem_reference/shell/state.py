"""Where a shell stands, and the forces there."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from fem_reference.surface.rod_elements import Strained


@dataclass(frozen=True)
class State:
    """change: q (2, n, 3); aside: of the rods' m (q, 3); stress (m, 54) and rod_stress (k, s): extrapolated,
    the elements' own where None."""

    change: np.ndarray
    aside: np.ndarray = field(default_factory=lambda: np.zeros((0, 3)))
    stress: np.ndarray | None = None
    rod_stress: np.ndarray | None = None


@dataclass(frozen=True)
class Forces:
    """At a state: of the elements Q (m, 18, 3), s (m, 54), D (m, 54, 54); directors d and m (n + q, 3) and
    their T (n + q, 3, 2); B and s of the rods; residuals (2n + q, 3) on u, d and m; size of the forces that
    balance [N]; short: the step (2n + q, 3) to what is prescribed."""

    vectors: np.ndarray
    stress: np.ndarray
    moduli: np.ndarray
    directors: np.ndarray
    frames: np.ndarray
    rods: Strained
    residuals: np.ndarray
    size: float
    short: np.ndarray

    @property
    def residual(self) -> np.ndarray:
        """Residuals (2, n, 3) on the sheet."""
        return self.residuals[: len(self.residuals) - len(self.aside)].reshape(2, -1, 3)

    @property
    def aside(self) -> np.ndarray:
        """Residuals (q, 3) on the rods' m."""
        return self.residuals[2 * (len(self.residuals) - len(self.directors)) :]

    @property
    def couple(self) -> np.ndarray:
        """Residuals on the directors, in their tangent planes (n + q, 2)."""
        turning = self.residuals[len(self.residuals) - len(self.directors) :]
        found: np.ndarray = np.einsum("nc,nck->nk", turning, self.frames)
        return found
