"""Quadratic drag of still air on the mid-surface (`sheetbench.scenes.objects.air`), by quadrature.

    f = −∫ ½ ρ c_d |v_n| v_n N a dr ds,   a = φ,r × φ,s,   v_n = v·a/|a|,
    ∂f/∂v = −∫ ρ c_d |v_n| N N a aᵀ/|a| dr ds

It is even in a: the sense in which r, s turn does not matter. How a changes with the shape is left out of the
tangent. Units: N, m, s, kg.
"""

from __future__ import annotations

import numpy as np

from fem_reference.discrete.items import SheetItem, Tangent
from fem_reference.discrete.shape import SheetShape
from fem_reference.surface.biquadratic import AT_GAUSS, GAUSS_WEIGHTS


class Drag(SheetItem):
    """The drag of still air; coefficient: ½ ρ c_d [kg/m³]."""

    def __init__(self, coefficient: float):
        self._coefficient = coefficient

    def force(self, shape: SheetShape) -> np.ndarray:
        area, _, speed = _flow(shape)
        pressure = -self._coefficient * np.abs(speed) * speed
        out = np.zeros_like(shape.vectors)
        out[:, :9] = np.einsum("g,gi,eg,egc->eic", GAUSS_WEIGHTS, AT_GAUSS[0], pressure, area, optimize=True)
        return shape.sheet.of_surface(np.arange(len(out)), out)

    def damping(self, shape: SheetShape) -> Tangent | None:
        area, size, speed = _flow(shape)
        share = -2.0 * self._coefficient * GAUSS_WEIGHTS * np.abs(speed) / size
        value = AT_GAUSS[0]
        out = np.zeros((len(area), 18, 3, 18, 3))
        out[:, :9, :, :9] = np.einsum(
            "eg,gi,egc,gj,egd->eicjd", share, value, area, value, area, optimize=True
        )
        return np.arange(len(out)), out

    def exchanged(self, shape: SheetShape, step: np.ndarray) -> tuple[float, float]:
        return -float(self.force(shape) @ step), 0.0


def _flow(shape: SheetShape) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """a (m, g, 3), |a| and v_n (m, g) at the Gauss points."""
    value, slope = AT_GAUSS
    along, across = np.einsum("agi,eic->aegc", slope, shape.vectors[:, :9])
    area = np.cross(along, across)
    size = np.linalg.norm(area, axis=-1)
    speed = np.einsum("gi,eic,egc->eg", value, shape.rates[:, :9], area, optimize=True) / size
    return area, size, speed
