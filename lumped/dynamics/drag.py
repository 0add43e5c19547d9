"""Quadratic drag of still air on the masses (`sheetbench.scenes.objects.air`), compiled.

Every mass has its part A of the current area as a vector and the velocity v along it:

    F = −½ ρ c_d |v_n| v_n A,   v_n = v·A/|A|,   ∂F/∂v = −ρ c_d |v_n| A Aᵀ/|A|.

A is the force on it of a unit pressure (`lumped.pressure`) times the ratio of the mass and its tributary one
(`lumped.masses`): a sheet that falls flat stays flat. The power taken is ½ ρ c_d |v_n|³ |A|. Tangents leave
out the change of A with the shape, of the order of the turn in a step. Chains have no drag.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from lumped.assembly import Assembly
from lumped.coverage import cell_shares
from lumped.masses import over_tributary
from lumped.pressure import add_forces
from sheetbench.numerics.options import njit
from sheetbench.scenes import Scene

TINY = np.finfo(float).tiny ** 0.5


class LatticeDrag(NamedTuple):
    """Drag of a lattice. coefficient: ½ ρ c_d [kg/m³], 0 without air; positions: at rest (n, 3) [m]; cells:
    columns of masses at the corners of the mid-surface's cells (c, 4, layers); shares: (c,) of each cell on
    the sheet; weights: (n,) mass over tributary mass; area: (n, 3) [m²] work array for A."""

    coefficient: float
    positions: np.ndarray
    cells: np.ndarray
    shares: np.ndarray
    weights: np.ndarray
    area: np.ndarray


def of_scene(scene: Scene, assembly: Assembly) -> LatticeDrag:
    """Return the drag on the masses of a scene's lattice."""
    lattice, cells = assembly.lattice, assembly.cells
    coefficient = 0.0 if scene.air is None else scene.air.coefficient
    area = np.zeros_like(lattice.positions)
    weights = over_tributary(scene, lattice, assembly.inertia, cells)
    shares = cell_shares(scene, lattice, None)
    return LatticeDrag(coefficient, lattice.positions, lattice.mid_cells, shares, weights, area)


@njit
def _to_areas(drag: LatticeDrag, u: np.ndarray) -> None:
    """Set `drag.area` to A of the masses displaced by u."""
    drag.area[:] = 0.0
    add_forces(drag.positions + u[: len(drag.area)], drag.cells, drag.shares, drag.area)
    for i in range(len(drag.area)):
        drag.area[i] *= drag.weights[i]


@njit
def add_drag(drag: LatticeDrag, u: np.ndarray, v: np.ndarray, force: np.ndarray) -> float:
    """Add the drag, signed as an internal force, at a displacement and velocity (size, 3); return the power
    taken [W]."""
    power = 0.0
    if drag.coefficient == 0.0:
        return power
    _to_areas(drag, u)
    for i in range(len(drag.area)):
        a, w = drag.area[i], v[i]
        size = np.sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2])
        if size == 0.0:  # a mass without cells
            continue
        speed = (w[0] * a[0] + w[1] * a[1] + w[2] * a[2]) / size
        pressure = drag.coefficient * abs(speed) * speed
        for q in range(3):
            force[i, q] += pressure * a[q]
        power += pressure * speed * size
    return power


def velocity_tangent(drag: LatticeDrag, u: np.ndarray, v: np.ndarray) -> np.ndarray:
    """Return the derivative of each mass's drag by its velocity, (n, 3, 3) [N·s/m]."""
    _to_areas(drag, u)
    area, size = drag.area, np.linalg.norm(drag.area, axis=1)
    flow = np.abs(np.sum(v[: len(area)] * area, axis=1))
    share = 2.0 * drag.coefficient * flow / np.maximum(size, TINY) ** 2
    return (share[:, None] * area)[:, :, None] * area[:, None, :]
