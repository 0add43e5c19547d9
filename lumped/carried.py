"""The scene's payloads on a lattice (`sheetbench.scenes.masses`).

Each mass of the lattice takes of a payload at a point the share that it would take of a force there:
bilinearly among the columns of the cell, equally among the layers, so that the mass and its first moment are
those of the payload; of one spread over a part of the sheet, as an area load is shared. A body's second
moments P act through the slopes ∂x, ∂y of the bilinear surface over that cell and the director d of its
columns, with the shares B of the displacement's derivative at the point:

    M = Σ_a P_aa B_a B_aᵀ,    a = x, y, d

the mean of the cells where the point is on a line. Neighbours share it, and its rows add up to zero, so that
it has no weight.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import scipy.sparse as sp

from lumped.coverage import areas_of_masses
from lumped.lattice import Lattice
from lumped.mid_surface import MidSurface, cells_at
from sheetbench.scenes import Scene


def point_masses(scene: Scene, lattice: Lattice) -> np.ndarray:
    """What every mass of a lattice takes of the payloads, (n,) [kg]."""
    out = np.zeros(lattice.mass_count)
    for payload in scene.masses:
        if payload.at is not None:
            out += payload.mass * _shares(lattice, np.array(payload.at))
            continue
        area = areas_of_masses(scene, lattice, payload.where).ravel()
        out += payload.mass * np.repeat(area / area.sum(), lattice.grid[2]) / lattice.grid[2]
    return out


def rotary_masses(scene: Scene, lattice: Lattice) -> sp.coo_array:
    """What neighbours share for the bodies' moments of inertia, (n, n) [kg], alike for x, y and z."""
    total = sp.csr_array((lattice.mass_count,) * 2)
    for payload in scene.masses:
        if payload.at is None or payload.inertia is None:
            continue
        cells = cells_at(lattice, payload.at)
        for cell in cells:
            for moment, slope in zip(payload.second_moments, _slopes(lattice, cell, payload.at), strict=True):
                total = total + moment / len(cells) * (slope @ slope.T)
    return sp.coo_array(total)


def _shares(lattice: Lattice, at: np.ndarray) -> np.ndarray:
    """What of a force at a plan point (2,) [m] every mass takes, (n,)."""
    along_z = MidSurface(lattice, at, order=1).shared(np.array([[0.0, 0.0, 1.0]]), lattice.mass_count)
    return np.asarray(along_z[:, 2])


def _slopes(lattice: Lattice, cell: tuple[int, int], at: Sequence[float]) -> tuple[sp.csc_array, ...]:
    """B (n, 1) [1/m] in a cell, row and column, of the derivatives by x and y and of the director."""
    (row, column), (x, y), layers = cell, lattice.lines, lattice.grid[2]
    wide, high = x.widths[column], y.widths[row]
    over, up = (at[0] - x.at[column]) / wide, (at[1] - y.at[row]) / high
    along, across = np.array([1.0 - over, over]), np.array([1.0 - up, up])
    step, even = np.array([-1.0, 1.0]), np.ones(layers) / layers
    heights = lattice.positions[:layers, 2]
    shares = (
        np.einsum("j,i,k->jik", across, step / wide, even),
        np.einsum("j,i,k->jik", step / high, along, even),
        np.einsum("j,i,k->jik", across, along, heights / (heights @ heights)),
    )
    masses = lattice.columns()[row : row + 2, column : column + 2]
    out = []
    for share in shares:
        entries = share.ravel(), (masses.ravel(), np.zeros(share.size, dtype=int))
        out.append(sp.csc_array(sp.coo_array(entries, shape=(lattice.mass_count, 1))))
    return tuple(out)
