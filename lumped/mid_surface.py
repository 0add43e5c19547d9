"""The mid-surface at plan points: the mean of the layers, through the masses around by polynomials.

Between masses the surface is the cubic through the nearest four lines of the grid along x and along y (all
of them where there are fewer): a sheet of curvature κ lies up to κ l²/8 beside a bilinear surface through
masses l apart, at 9 × 9 masses of a sagging sheet 1 to 3 % of its sag, and more where cells are graded.

Near rims, where not all cells between those lines are there, it is the quadric nearest to the masses of the
cell and of those connected with it, up to REACH cells on.

A linear map of the masses' displacement; its transpose shares a force at a point among the masses around it,
as loads do it among the four next to it (order 1).
"""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp

from lumped.lattice import Lattice
from sheetbench.errors import BadInput

REACH = 2  # cells beside a point's, by their sides
ON_LINE = 1e-6  # of a cell's side


class MidSurface:
    """The mid-surface of a lattice at plan points (n, 2) [m], by polynomials of an order. Raises BadInput for
    points off the sheet."""

    def __init__(self, lattice: Lattice, points: np.ndarray, order: int = 3):
        points = np.asarray(points, dtype=float).reshape(-1, 2)
        places = [lines.index(points[:, axis])[1] for axis, lines in enumerate(lattice.lines)]
        outside = np.max(np.abs(np.array(places) - 0.5), axis=0) > 0.5 + 1e-9
        if outside.any():
            raise BadInput(f"point {points[outside][0].tolist()} m is off the sheet")
        if lattice.present is not None:
            self._near_rims(lattice, lattice.present, points, order)
            return
        ends = [lines.around(points[:, axis], order + 1) for axis, lines in enumerate(lattice.lines)]
        (i, x, beyond_x), (j, y, beyond_y) = ends
        columns = lattice.columns()[j[:, :, None], i[:, None, :]]
        self._nodes = columns.reshape(len(points), -1, lattice.grid[2])
        signs = np.ones((*columns.shape[:3], 3))  # an image moves across its plane of symmetry the other way
        signs[..., 0] -= 2.0 * beyond_x[:, None, :]
        signs[..., 1] -= 2.0 * beyond_y[:, :, None]
        weights = y[:, :, None, None] * x[:, None, :, None] / lattice.grid[2] * signs
        self._share = weights.reshape(len(points), -1, 3)

    def _near_rims(self, lattice: Lattice, present: np.ndarray, points: np.ndarray, order: int) -> None:
        """Nodes and shares on a lattice with absent cells, cell by cell of the points'."""
        x, y = lattice.lines
        own = [_own_cell(lattice, present, point) for point in points]
        most = (order + 1) ** 2 if order == 1 else (2 * REACH + 2) ** 2
        self._nodes = np.zeros((len(points), most, lattice.grid[2]), dtype=int)
        self._share = np.zeros((len(points), most, 3))
        columns = lattice.columns()
        for cell in set(own):
            (row, column), which = cell, np.array([n for n, each in enumerate(own) if each == cell])
            rows, over = _connected(present, cell, 0 if order == 1 else REACH)
            places = np.stack([x.at[over], y.at[rows]], axis=1)
            sides = np.array([x.widths[column], y.widths[row]])
            middle = np.array([x.at[column], y.at[row]]) + 0.5 * sides
            known, wanted = ((at - middle) / sides for at in (places, points[which]))
            near = 1.0 / (0.5 + (known**2).sum(axis=1))
            fit = np.linalg.pinv(_terms(known, order) * near[:, None], rcond=1e-9) * near
            self._nodes[which[:, None], np.arange(len(rows))] = columns[rows, over]
            shares = (_terms(wanted, order) @ fit)[:, :, None] / lattice.grid[2]
            self._share[which[:, None], np.arange(len(rows))] = shares

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


def _own_cell(lattice: Lattice, present: np.ndarray, point: np.ndarray) -> tuple[int, int]:
    """Row and column of the cell present in which, or on whose rim, a plan point [m] lies. Raises BadInput
    where there is none."""
    (column, x), (row, y) = (lines.index(c) for c, lines in zip(point, lattice.lines, strict=True))
    near = [
        (row + j, column + i)
        for j in (0, *([-1] if y < ON_LINE else [1] if y > 1.0 - ON_LINE else []))
        for i in (0, *([-1] if x < ON_LINE else [1] if x > 1.0 - ON_LINE else []))
    ]
    for j, i in near:
        if 0 <= j < present.shape[0] and 0 <= i < present.shape[1] and present[j, i]:
            return int(j), int(i)
    raise BadInput(f"point {point.tolist()} m: there is no sheet, by its outline or a cutout")


def _connected(present: np.ndarray, cell: tuple[int, int], reach: int) -> tuple[np.ndarray, np.ndarray]:
    """Rows and columns of the lines that cross at the corners of a cell, and of those that can be reached
    from it over so many sides."""
    found, last = {cell}, {cell}
    for _ in range(reach):
        beside = {(j + dj, i + di) for j, i in last for dj, di in ((0, 1), (0, -1), (1, 0), (-1, 0))}
        last = {
            (j, i)
            for j, i in beside - found
            if 0 <= j < present.shape[0] and 0 <= i < present.shape[1] and present[j, i]
        }
        found |= last
    corners = sorted({(j + dj, i + di) for j, i in found for dj in (0, 1) for di in (0, 1)})
    rows, over = np.array(corners).T
    return rows, over


def _terms(at: np.ndarray, order: int) -> np.ndarray:
    """The terms of a bilinear surface (order 1), or of a quadric, at places (n, 2)."""
    x, y = at.T
    terms = [np.ones_like(x), x, y, x * y] + ([] if order == 1 else [x * x, y * y])
    return np.stack(terms, axis=1)
