"""The mid-surface at plan points: the mean of the layers, bilinear between the columns of masses.

A linear map of the masses' displacement; its transpose shares a force at a point among the masses around it.
"""

from __future__ import annotations

import numpy as np

from lumped.lattice import Lattice
from sheetbench.scenes.errors import BadInput


class MidSurface:
    """The mid-surface of a lattice at plan points (n, 2) [m]. Raises BadInput for points off the sheet."""

    def __init__(self, lattice: Lattice, points: np.ndarray):
        points = np.asarray(points, dtype=float).reshape(-1, 2)
        i, x = lattice.lines[0].index(points[:, 0])
        j, y = lattice.lines[1].index(points[:, 1])
        outside = np.maximum(np.abs(x - 0.5), np.abs(y - 0.5)) > 0.5 + 1e-9
        if outside.any():
            raise BadInput(f"point {points[outside][0].tolist()} m is off the sheet")
        weights = np.stack([(1 - x) * (1 - y), x * (1 - y), x * y, (1 - x) * y], axis=1)
        columns = lattice.columns()
        corners = ((j, i), (j, i + 1), (j + 1, i + 1), (j + 1, i))
        self._nodes = np.stack([columns[at] for at in corners], axis=1)
        self._share = weights / lattice.grid[2]

    def of(self, field: np.ndarray) -> np.ndarray:
        """Values (n, 3) at the points of a field over the masses, (masses and more, 3)."""
        values: np.ndarray = np.einsum("pc,pclq->pq", self._share, field[self._nodes])
        return values

    def shared(self, values: np.ndarray, size: int) -> np.ndarray:
        """The transpose: values (n, 3) at the points shared among the masses, (size, 3)."""
        out = np.zeros((size, 3))
        parts = self._share[:, :, None, None] * np.asarray(values, float)[:, None, None, :]
        np.add.at(out, self._nodes, np.broadcast_to(parts, (*self._nodes.shape, 3)))
        return out
