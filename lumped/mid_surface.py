"""The mid-surface at plan points: the mean of the layers, through the masses around by polynomials.

Between masses the surface is the cubic through the nearest four lines of the grid along x and along y (all
of them where there are fewer): a sheet of curvature κ lies up to κ l²/8 beside a bilinear surface through
masses l apart, at 9 × 9 masses of a sagging sheet 1 to 3 % of its sag, and more where cells are graded.

A linear map of the masses' displacement; its transpose shares a force at a point among the masses around it,
as loads do it among the four next to it (order 1).
"""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp

from lumped.lattice import Lattice
from sheetbench.errors import BadInput


class MidSurface:
    """The mid-surface of a lattice at plan points (n, 2) [m], by polynomials of an order. Raises BadInput for
    points off the sheet."""

    def __init__(self, lattice: Lattice, points: np.ndarray, order: int = 3):
        points = np.asarray(points, dtype=float).reshape(-1, 2)
        places = [lines.index(points[:, axis])[1] for axis, lines in enumerate(lattice.lines)]
        outside = np.max(np.abs(np.array(places) - 0.5), axis=0) > 0.5 + 1e-9
        if outside.any():
            raise BadInput(f"point {points[outside][0].tolist()} m is off the sheet")
        ends = [lines.around(points[:, axis], order + 1) for axis, lines in enumerate(lattice.lines)]
        (i, x, beyond_x), (j, y, beyond_y) = ends
        columns = lattice.columns()[j[:, :, None], i[:, None, :]]
        self._nodes = columns.reshape(len(points), -1, lattice.grid[2])
        signs = np.ones((*columns.shape[:3], 3))  # an image moves across its plane of symmetry the other way
        signs[..., 0] -= 2.0 * beyond_x[:, None, :]
        signs[..., 1] -= 2.0 * beyond_y[:, :, None]
        weights = y[:, :, None, None] * x[:, None, :, None] / lattice.grid[2] * signs
        self._share = weights.reshape(len(points), -1, 3)

    def of(self, field: np.ndarray) -> np.ndarray:
        """Values (n, 3) at the points of a field of vectors over the masses, (masses and more, 3)."""
        values: np.ndarray = np.einsum("pcq,pclq->pq", self._share, field[self._nodes])
        return values

    def matrix(self, size: int) -> sp.csr_array:
        """The map of displacements (size, 3) to values at the points, (3 points, 3 size), both flat."""
        points, around, layers = self._nodes.shape
        axes = np.arange(3)
        shape = (points, around, layers, 3)
        rows = np.broadcast_to(3 * np.arange(points)[:, None, None, None] + axes, shape)
        columns = 3 * self._nodes[..., None] + axes
        values = np.broadcast_to(self._share[:, :, None, :], shape)
        entries = (values.ravel(), (rows.ravel(), columns.ravel()))
        return sp.csr_array(sp.coo_array(entries, shape=(3 * points, 3 * size)))

    def shared(self, values: np.ndarray, size: int) -> np.ndarray:
        """The transpose: values (n, 3) at the points shared among the masses, (size, 3)."""
        out = np.zeros((size, 3))
        parts = (self._share * np.asarray(values, float)[:, None, :])[:, :, None, :]
        np.add.at(out, self._nodes, np.broadcast_to(parts, (*self._nodes.shape, 3)))
        return out
