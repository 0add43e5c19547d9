"""Items that act on a sheet: each brings its force and tangent, summed in statics, motion and modes.

An item reads a `SheetShape` and acts on all coordinates or, like the loads of `surface.loads`, on position
and director at the nodes of the plan's elements. No other class depends on an item's kind.
"""

from typing import Protocol

import numpy as np

from fem_reference.discrete.course import Factor, factor_at
from fem_reference.discrete.shape import SheetShape
from fem_reference.surface.biquadratic import AT_GAUSS, GAUSS_WEIGHTS
from fem_reference.surface.loads import Follower

Tangent = tuple[np.ndarray, np.ndarray]  # elements (k,) of the plan, and their matrices (k, 18, 3, 18, 3)


class SheetItem(Protocol):
    """Interface of an item that acts on a sheet: a force, and methods with defaults. conservative: it has a
    potential, a symmetric tangent."""

    conservative: bool = True

    def force(self, shape: SheetShape) -> np.ndarray:
        """Return the force on the coordinates (N,)."""

    def tangent(self, shape: SheetShape) -> Tangent | None:
        """Return the force's derivative by the surface's vectors, None for a constant force."""
        return None

    def damping(self, shape: SheetShape) -> Tangent | None:
        """Return the derivative of the force by the rates of the surface's vectors."""
        return None

    def support_forces(self, shape: SheetShape) -> dict[str, tuple[np.ndarray, np.ndarray]]:
        """Return positions (…, 3) [m] and forces (…, 3) [N] by which the item supports the sheet, by name."""
        return {}

    def potential(self, shape: SheetShape) -> float:
        """Return the potential [J] of a conservative item, 0 at the flat sheet."""
        return 0.0

    def stored(self, shape: SheetShape) -> float:
        """Return the part of the potential that a motion stores as energy [J]; the rest counts as work."""
        return 0.0

    def powers(self, shape: SheetShape) -> tuple[float, float]:
        """Return the power [W] dissipated by the item and the power that it supplies, in a moving shape."""
        return 0.0, float(self.force(shape) @ shape.v)


class DeadLoad(SheetItem):
    """DeadLoad force (N,), scaled by its factor."""

    def __init__(self, full: np.ndarray, factor: Factor):
        self._full, self._factor = full, factor

    def force(self, shape: SheetShape) -> np.ndarray:
        return factor_at(self._factor, shape.at) * self._full

    def potential(self, shape: SheetShape) -> float:
        return -float(self.force(shape) @ shape.q)

    def stored(self, shape: SheetShape) -> float:
        return self.potential(shape) if self._factor is None else 0.0

    def powers(self, shape: SheetShape) -> tuple[float, float]:
        return 0.0, 0.0 if self._factor is None else float(self.force(shape) @ shape.v)


class FollowerLoad(SheetItem):
    """Follower load of `surface.loads`, scaled by its factor."""

    def __init__(self, load: Follower, factor: Factor):
        self._load, self._factor, self.conservative = load, factor, load.conservative

    def force(self, shape: SheetShape) -> np.ndarray:
        on = self._load.elements
        pull = factor_at(self._factor, shape.at) * self._load.force(shape.vectors[on])
        return shape.sheet.of_surface(on, pull)

    def tangent(self, shape: SheetShape) -> Tangent | None:
        on = self._load.elements
        return on, factor_at(self._factor, shape.at) * self._load.tangent(shape.vectors[on])

    def potential(self, shape: SheetShape) -> float:
        on = self._load.elements
        return -factor_at(self._factor, shape.at) * self._load.work(shape.vectors[on])


class Drag(SheetItem):
    """Quadratic drag of still air on the mid-surface (`sheetbench.scenes.objects.air`), by quadrature.

        f = −∫ ½ ρ c_d |v_n| v_n N a dr ds,   a = φ,r × φ,s,   v_n = v·a/|a|,
        ∂f/∂v = −∫ ρ c_d |v_n| N N a aᵀ/|a| dr ds

    It is even in a: the orientation of r, s does not matter. The tangent neglects the change of a with the
    shape. coefficient: ½ ρ c_d [kg/m³]."""

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
        sides = value, area, value, area
        out[:, :9, :, :9] = np.einsum("eg,gi,egc,gj,egd->eicjd", share, *sides, optimize=True)
        return np.arange(len(out)), out

    def powers(self, shape: SheetShape) -> tuple[float, float]:
        return -float(self.force(shape) @ shape.v), 0.0


def _flow(shape: SheetShape) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return a (m, g, 3), |a| and v_n (m, g) at the Gauss points."""
    value, slope = AT_GAUSS
    along, across = np.einsum("agi,eic->aegc", slope, shape.vectors[:, :9])
    area = np.cross(along, across)
    size = np.linalg.norm(area, axis=-1)
    speed = np.einsum("gi,eic,egc->eg", value, shape.rates[:, :9], area, optimize=True) / size
    return area, size, speed
