"""The mid-surface at plan points: the mean of the layers, through the masses around by polynomials.

Between masses the surface is the cubic through the nearest four lines of the grid along x and along y (all
of them where there are fewer): a sheet of curvature κ lies up to κ l²/8 beside a bilinear surface through
masses l apart, at 9 × 9 masses of a sagging sheet 1 to 3 % of its sag, and more where cells are graded.

On lattices with absent cells every cell has the quadric nearest to its masses and those of cells connected
with it, up to REACH cells on. The surface is blended from these, so that it is continuous: at a crossing of
lines it is the mean of the quadrics of the cells around, in a cell the bilinear mean of its four corners',

    u(x) = Σ_corners N_v(x) mean_{c around v} q_c(x),      N_v = 1 at v and 0 at the others.

A linear map of the masses' displacement; its transpose shares a force at a point among the masses around it,
as loads do it among the four next to it (order 1).
"""

from __future__ import annotations

from dataclasses import dataclass

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
        """Nodes and shares on a lattice with absent cells: of the lines around each point's cell."""
        own = [_own_cell(lattice, present, point) for point in points]
        reach = 0 if order == 1 else REACH + 1
        around = np.arange(-reach, reach + 2)
        corner = np.array(own).reshape(-1, 2)
        rows, over = (np.clip(corner[:, axis, None] + around, 0, present.shape[axis]) for axis in (0, 1))
        self._nodes = lattice.columns()[rows[:, :, None], over[:, None, :]].reshape(
            len(points), -1, lattice.grid[2]
        )
        share = np.zeros((len(points), len(around), len(around)))
        known: dict[tuple[int, int], _Polynomial] = {}
        for cell in set(own):
            which = np.array([n for n, each in enumerate(own) if each == cell])
            blend = (
                _blend(lattice, present, cell, points[which]) if order > 1 else {cell: np.ones(len(which))}
            )
            for other, weight in blend.items():
                if other not in known:
                    known[other] = _Polynomial.near(lattice, present, other, order)
                found = known[other]
                row, column = found.rows - cell[0] + reach, found.over - cell[1] + reach
                share[which[:, None], row, column] += weight[:, None] * found.at(points[which])
        share = share.reshape(len(points), -1, 1) / lattice.grid[2]
        self._share = np.broadcast_to(share, (*share.shape[:2], 3))

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


@dataclass(frozen=True, eq=False)
class _Polynomial:
    """The polynomial nearest to masses at the crossings of lines (k,), rows and over: its terms are fit (terms,
    k) @ values of these, in places from the middle of its cell [m], in its sides (2,) [m]."""

    rows: np.ndarray
    over: np.ndarray
    fit: np.ndarray
    middle: np.ndarray
    sides: np.ndarray
    order: int

    @classmethod
    def near(cls, lattice: Lattice, present: np.ndarray, cell: tuple[int, int], order: int) -> _Polynomial:
        """Of a cell (row, column) and those connected with it."""
        (row, column), (x, y) = cell, lattice.lines
        rows, over = _connected(present, cell, 0 if order == 1 else REACH)
        sides = np.array([x.widths[column], y.widths[row]])
        middle = np.array([x.at[column], y.at[row]]) + 0.5 * sides
        places = (np.stack([x.at[over], y.at[rows]], axis=1) - middle) / sides
        near = 1.0 / (0.5 + (places**2).sum(axis=1))
        fit = np.linalg.pinv(_terms(places, order) * near[:, None], rcond=1e-9) * near
        return cls(rows, over, fit, middle, sides, order)

    def at(self, points: np.ndarray) -> np.ndarray:
        """What share every mass has in the values at plan points (n, 2) [m], (n, k)."""
        return np.asarray(_terms((points - self.middle) / self.sides, self.order) @ self.fit)


def _blend(
    lattice: Lattice, present: np.ndarray, cell: tuple[int, int], points: np.ndarray
) -> dict[tuple[int, int], np.ndarray]:
    """What weight (n,) the polynomials of a cell and of those around have at plan points (n, 2) [m] in it."""
    (row, column), (x, y) = cell, lattice.lines
    right = (points[:, 0] - x.at[column]) / x.widths[column]
    up = (points[:, 1] - y.at[row]) / y.widths[row]
    found: dict[tuple[int, int], np.ndarray] = {}
    for dj, by_row in ((-1, 1.0 - up), (1, up)):
        for di, by_column in ((-1, 1.0 - right), (1, right)):
            beside = [(row + dj, column), (row, column + di)]
            there = [cell, *(one for one in beside if _there(present, one))]
            if len(there) > 1 and _there(present, (row + dj, column + di)):
                there.append((row + dj, column + di))
            for one in there:
                found[one] = found.get(one, 0.0) + by_row * by_column / len(there)
    return found


def _there(present: np.ndarray, cell: tuple[int, int]) -> bool:
    """Whether there is a cell of this row and column."""
    return all(0 <= at < count for at, count in zip(cell, present.shape, strict=True)) and bool(present[cell])


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
        if _there(present, (j, i)):
            return int(j), int(i)
    raise BadInput(f"point {point.tolist()} m: there is no sheet, by its outline or a cutout")


def _connected(present: np.ndarray, cell: tuple[int, int], reach: int) -> tuple[np.ndarray, np.ndarray]:
    """Rows and columns of the lines that cross at the corners of a cell, and of those that can be reached
    from it over so many sides."""
    found, last = {cell}, {cell}
    for _ in range(reach):
        beside = {(j + dj, i + di) for j, i in last for dj, di in ((0, 1), (0, -1), (1, 0), (-1, 0))}
        last = {one for one in beside - found if _there(present, one)}
        found |= last
    corners = sorted({(j + dj, i + di) for j, i in found for dj in (0, 1) for di in (0, 1)})
    rows, over = np.array(corners).T
    return rows, over


def _terms(at: np.ndarray, order: int) -> np.ndarray:
    """The terms of a bilinear surface (order 1), or of a quadric, at places (n, 2)."""
    x, y = at.T
    terms = [np.ones_like(x), x, y, x * y] + ([] if order == 1 else [x * x, y * y])
    return np.stack(terms, axis=1)
