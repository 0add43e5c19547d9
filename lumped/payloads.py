"""The scene's payloads on a lattice (`sheetbench.scenes.objects.masses`).

Each mass of the lattice takes of a payload at a point the share that it would take of a force there:
bilinearly among the columns of the cell, equally among the layers, so that the payload's mass and first
moment are kept. A payload spread over a part of the sheet is shared as an area load is. Its moments of
inertia J act on the rates of the columns' directors, d = bᵀ x of a column's layers x, each by its share s of
the area:

    M = s b bᵀ ⊗ J

which the layers share; its rows add up to zero, so that it has no weight.
"""

import numpy as np
import scipy.sparse as sp

from lumped.coverage import areas_of_masses
from lumped.lattice import Lattice
from lumped.mid_surface import MidSurface
from sheetbench.scenes import Scene


def point_masses(scene: Scene, lattice: Lattice) -> np.ndarray:
    """Return the mass (n,) [kg] that the payloads add to every mass of a lattice."""
    out = np.zeros(lattice.mass_count)
    for payload in scene.masses:
        if payload.at is not None:
            out += payload.mass * _shares(lattice, np.array(payload.at))
            continue
        area = areas_of_masses(scene, lattice, payload.where)
        out += payload.mass * area / area.sum()
    return out


def rotary_masses(scene: Scene, lattice: Lattice) -> sp.bsr_array:
    """Return the layers' mass matrix of the bodies' moments of inertia, (3 n, 3 n) [kg], in 3 × 3 blocks."""
    count, layers = lattice.mass_count, lattice.grid[2]
    heights = lattice.positions[:layers, 2]
    lever = heights / (heights @ heights)
    total = sp.bsr_array((3 * count, 3 * count), blocksize=(3, 3))
    for payload in scene.masses:
        if payload.inertia is not None:
            area = areas_of_masses(scene, lattice, payload.where).reshape(-1, layers).sum(axis=1)
            directors = sp.kron(sp.diags_array(area / area.sum()), np.outer(lever, lever))
            total = total + sp.kron(directors, np.diag(payload.of_director), format="bsr")
    return total


def pairs_of(blocks: sp.bsr_array) -> tuple[np.ndarray, np.ndarray]:
    """Return the masses, rows and columns (k,), of a matrix's blocks."""
    return np.repeat(np.arange(len(blocks.indptr) - 1), np.diff(blocks.indptr)), blocks.indices


def _shares(lattice: Lattice, at: np.ndarray) -> np.ndarray:
    """Return the share of every mass in a force at a plan point (2,) [m], (n,)."""
    return MidSurface(lattice, at, order=1).shared(np.ones((1, 1)), lattice.mass_count)[:, 0]
