"""Quadratic drag of still air on the mid-surface (`sheetbench.scenes.air`), by quadrature.

    f = −∫ ½ ρ c_d |v_n| v_n N a dr ds,   a = φ,r × φ,s,   v_n = v·a/|a|,
    ∂f/∂v = −∫ ρ c_d |v_n| N N a aᵀ/|a| dr ds

It is even in a: the sense in which r, s turn does not matter. How a changes with the shape is left out of the
tangent. Units: N, m, s, kg.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from fem_reference.surface.biquadratic import AT_GAUSS, GAUSS_WEIGHTS


@dataclass(frozen=True)
class Drag:
    """The drag at velocities (m, 9, 3) [m/s] of the elements' nodes, as a `Follower` load; coefficient:
    ½ ρ c_d [kg/m³]; by_v: change of the velocities with that of the places [1/s], for the tangent."""

    coefficient: float
    velocities: np.ndarray
    by_v: float
    conservative: ClassVar[bool] = True

    @property
    def elements(self) -> np.ndarray:
        return np.arange(len(self.velocities))

    def _flow(self, vectors: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """a (m, g, 3), |a| and v_n (m, g) at the Gauss points."""
        value, slope = AT_GAUSS
        along, across = np.einsum("agi,eic->aegc", slope, vectors[:, :9])
        area = np.cross(along, across)
        size = np.linalg.norm(area, axis=-1)
        return area, size, np.einsum("gi,eic,egc->eg", value, self.velocities, area, optimize=True) / size

    def force(self, vectors: np.ndarray) -> np.ndarray:
        area, _, speed = self._flow(vectors)
        pressure = -self.coefficient * np.abs(speed) * speed
        out = np.zeros_like(vectors)
        out[:, :9] = np.einsum("g,gi,eg,egc->eic", GAUSS_WEIGHTS, AT_GAUSS[0], pressure, area, optimize=True)
        return out

    def tangent(self, vectors: np.ndarray) -> np.ndarray:
        area, size, speed = self._flow(vectors)
        share = -2.0 * self.by_v * self.coefficient * GAUSS_WEIGHTS * np.abs(speed) / size
        value = AT_GAUSS[0]
        out = np.zeros((len(vectors), 18, 3, 18, 3))
        out[:, :9, :, :9] = np.einsum(
            "eg,gi,egc,gj,egd->eicjd", share, value, area, value, area, optimize=True
        )
        return out

    def work(self, vectors: np.ndarray) -> float:
        """Zero: it has no potential."""
        return 0.0
