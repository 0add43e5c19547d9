"""What acts on a sheet: items that bring their own force and tangent, summed by one loop at rest, in motion
and in modes.

An item sees the sheet in a `SheetShape` and acts on all coordinates, or, as those of `surface.loads` do, on
the position and director of the nodes of the plan's elements. Nothing but its class knows what it is.
"""

from __future__ import annotations

from typing import Protocol

import numpy as np

from fem_reference.discrete.course import Factor, factor_at
from fem_reference.discrete.shape import SheetShape
from fem_reference.surface.biquadratic import AT_GAUSS, GAUSS_WEIGHTS
from fem_reference.surface.loads import Follower

Tangent = tuple[np.ndarray, np.ndarray]  # elements (k,) of the plan, and their matrices (k, 18, 3, 18, 3)


class SheetItem(Protocol):
    """An item. conservative: it has a potential, and so a symmetric tangent. One that inherits this leaves
    out what has a default here."""

    conservative: bool = True

    def force(self, shape: SheetShape) -> np.ndarray:
        """On the coordinates (N,)."""

    def tangent(self, shape: SheetShape) -> Tangent | None:
        """Derivative of the force by the surface's vectors, None of one that does not depend on them."""
        return None

    def damping(self, shape: SheetShape) -> Tangent | None:
        """That by their rates."""
        return None

    def holds(self, shape: SheetShape) -> dict[str, tuple[np.ndarray, np.ndarray]]:
        """Where, and with which forces (…, 3) [N], what is no load holds the sheet, by its name there."""
        return {}

    def potential(self, shape: SheetShape) -> float:
        """Of a conservative item, 0 at the flat sheet [J]."""
        return 0.0

    def stored(self, shape: SheetShape) -> float:
        """The part of it that a motion keeps as energy [J]; what is not kept is work."""
        return 0.0

    def exchanged(self, shape: SheetShape) -> tuple[float, float]:
        """Power dissipated and put in [W] in a shape that moves."""
        return 0.0, float(self.force(shape) @ shape.v)


class Dead(SheetItem):
    """A force (N,) that nothing but its factor changes."""

    def __init__(self, full: np.ndarray, factor: Factor):
        self._full, self._factor = full, factor

    def force(self, shape: SheetShape) -> np.ndarray:
        return factor_at(self._factor, shape.at) * self._full

    def potential(self, shape: SheetShape) -> float:
        return -float(self.force(shape) @ shape.q)

    def stored(self, shape: SheetShape) -> float:
        return self.potential(shape) if self._factor is None else 0.0

    def exchanged(self, shape: SheetShape) -> tuple[float, float]:
        return 0.0, 0.0 if self._factor is None else float(self.force(shape) @ shape.v)


class Following(SheetItem):
    """A load of `surface.loads` that follows the sheet, with its factor."""

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

    It is even in a: the sense in which r, s turn does not matter. How a changes with the shape is left out of
    the tangent. coefficient: ½ ρ c_d [kg/m³].
    """

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

    def exchanged(self, shape: SheetShape) -> tuple[float, float]:
        return -float(self.force(shape) @ shape.v), 0.0


def _flow(shape: SheetShape) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """a (m, g, 3), |a| and v_n (m, g) at the Gauss points."""
    value, slope = AT_GAUSS
    along, across = np.einsum("agi,eic->aegc", slope, shape.vectors[:, :9])
    area = np.cross(along, across)
    size = np.linalg.norm(area, axis=-1)
    speed = np.einsum("gi,eic,egc->eg", value, shape.rates[:, :9], area, optimize=True) / size
    return area, size, speed
