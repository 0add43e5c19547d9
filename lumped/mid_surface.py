"""The mid-surface at plan points: the mean of the layers, through the masses around by polynomials.

Between masses the surface is the cubic through the nearest four lines of the grid along x and along y (all
of them where there are fewer): a sheet of curvature κ lies up to κ l²/8 beside a bilinear surface through
masses l apart, at 9 × 9 masses of a sagging sheet 1 to 3 % of its sag, and more where cells are graded.

On lattices with absent cells every cell has the quadric nearest to its masses and those of cells connected
with it, up to REACH cells on, by least squares; masses count the more the nearer they are and the more sheet
the cells around them have. The surface is a mean of these, so that it is continuous: of the four cells around
the nearest crossing of lines, weighed by how much sheet they have and by ½ ± the distance from the lines
there, in cells, along x and y. In the middle of a cell it is that cell's, on a side of two the mean of both.

A linear map of the masses' displacement; its transpose shares a force at a point among the masses around it,
as loads do it among the four next to it (order 1).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from lumped.lattice import Lattice
from sheetbench.errors import BadInput
from sheetbench.numerics.kept import kept

REACH = 2  # cells beside a point's, by their sides
ON_LINE = 1e-6  # of a cell's side


class MidSurface:
    """The mid-surface of a lattice at plan points (n, 2) [m], by polynomials of an order. Raises BadInput for
    points off the sheet. What masses are around them is found once for a lattice."""

    def __init__(self, lattice: Lattice, points: np.ndarray, order: int = 3):
        points = np.asarray(points, dtype=float).reshape(-1, 2)
        self._nodes, self._share = _nodes_and_shares(lattice, points, order)

    def of(self, field: np.ndarray) -> np.ndarray:
        """Values (n, 3) at the points of a field of vectors over the masses, (masses and more, 3)."""
        values: np.ndarray = np.einsum("pc,pclq->pq", self._share, field[self._nodes])
        return values

    def matrix(self, size: int) -> sp.csr_array:
        """The map of displacements (size, 3) to values at the points, (3 points, 3 size), both flat."""
        points, around, layers = self._nodes.shape
        axes = np.arange(3)
        shape = (points, around, layers, 3)
        rows = np.broadcast_to(3 * np.arange(points)[:, None, None, None] + axes, shape)
        columns = 3 * self._nodes[..., None] + axes
        values = np.broadcast_to(self._share[:, :, None, None], shape)
        entries = (values.ravel(), (rows.ravel(), columns.ravel()))
        return sp.csr_array(sp.coo_array(entries, shape=(3 * points, 3 * size)))

    def shared(self, values: np.ndarray, size: int) -> np.ndarray:
        """The transpose: values (n, 3) at the points shared among the masses, (size, 3)."""
        out = np.zeros((size, 3))
        parts = (self._share[..., None] * np.asarray(values, float)[:, None, :])[:, :, None, :]
        np.add.at(out, self._nodes, np.broadcast_to(parts, (*self._nodes.shape, 3)))
        return out


@kept(last=8, most=2**16, size=lambda lattice, points, _: points.nbytes + 8 * lattice.mass_count)
def _nodes_and_shares(lattice: Lattice, points: np.ndarray, order: int) -> tuple[np.ndarray, np.ndarray]:
    """The masses (n, columns, layers) around plan points (n, 2) [m], and what share every one of a
    column has in the value there, (n, columns). Raises BadInput for points off the sheet."""
    places = [lines.index(points[:, axis])[1] for axis, lines in enumerate(lattice.lines)]
    outside = np.max(np.abs(np.array(places) - 0.5), axis=0) > 0.5 + 1e-9
    if outside.any():
        raise BadInput(f"point {points[outside][0].tolist()} m is off the sheet")
    if lattice.per_area is not None:
        return _near_rims(lattice, lattice.per_area, points, order)
    ends = [lines.around(points[:, axis], order + 1) for axis, lines in enumerate(lattice.lines)]
    (i, x), (j, y) = ends
    columns = lattice.columns()[j[:, :, None], i[:, None, :]].reshape(len(points), -1, lattice.grid[2])
    return columns, (y[:, :, None] * x[:, None, :] / lattice.grid[2]).reshape(len(points), -1)


def _near_rims(
    lattice: Lattice, per_area: np.ndarray, points: np.ndarray, order: int
) -> tuple[np.ndarray, np.ndarray]:
    """Those on a lattice with absent cells: of the lines around each point's cell."""
    own = [_own_cell(lattice, per_area, point) for point in points]
    reach = 0 if order == 1 else REACH + 1
    around = np.arange(-reach, reach + 2)
    first = np.array(own).reshape(-1, 2, 1)
    rows, over = (np.clip(first[:, axis] + around, 0, per_area.shape[axis]) for axis in (0, 1))
    columns = lattice.columns()[rows[:, :, None], over[:, None, :]]
    share = np.zeros((len(points), len(around), len(around)))
    known: dict[tuple[int, int], _Polynomial] = {}
    for cell in set(own):
        which = np.array([n for n, each in enumerate(own) if each == cell])
        weights = {cell: np.ones(len(which))}
        for other, weight in (
            _blend(lattice, per_area, cell, points[which]) if order > 1 else weights
        ).items():
            if other not in known:
                known[other] = _Polynomial.near(lattice, per_area, other, order)
            found = known[other]
            row, column = found.rows - cell[0] + reach, found.over - cell[1] + reach
            share[which[:, None], row, column] += weight[:, None] * found.at(points[which])
    nodes = columns.reshape(len(points), -1, lattice.grid[2])
    return nodes, share.reshape(len(points), -1) / lattice.grid[2]


@dataclass(frozen=True, eq=False)
class _Polynomial:
    """The polynomial nearest to masses at the crossings of lines (k,), rows and over: its terms are
    fit (terms, k) @ values of these, in places from the middle of its cell in its sides, (2,) [m] each."""

    rows: np.ndarray
    over: np.ndarray
    fit: np.ndarray
    middle: np.ndarray
    sides: np.ndarray
    order: int

    @classmethod
    def near(cls, lattice: Lattice, per_area: np.ndarray, cell: tuple[int, int], order: int) -> _Polynomial:
        """Of a cell (row, column) and those connected with it."""
        (row, column), (x, y) = cell, lattice.lines
        rows, over = _connected(per_area, cell, 0 if order == 1 else REACH)
        sides = np.array([x.widths[column], y.widths[row]])
        middle = np.array([x.at[column], y.at[row]]) + 0.5 * sides
        places = (np.stack([x.at[over], y.at[rows]], axis=1) - middle) / sides
        near = np.sqrt(around(per_area)[rows, over]) / (0.5 + (places**2).sum(axis=1))
        fit = np.linalg.pinv(_terms(places, order) * near[:, None], rcond=1e-9) * near
        return cls(rows, over, fit, middle, sides, order)

    def at(self, points: np.ndarray) -> np.ndarray:
        """What share every mass has in the values at plan points (n, 2) [m], (n, k)."""
        return np.asarray(_terms((points - self.middle) / self.sides, self.order) @ self.fit)


def around(per_area: np.ndarray) -> np.ndarray:
    """The mean of the cells around each crossing of lines, (rows + 1, columns + 1)."""
    wide = np.pad(per_area, 1)
    return 0.25 * (wide[1:, 1:] + wide[1:, :-1] + wide[:-1, 1:] + wide[:-1, :-1])


def _blend(
    lattice: Lattice, per_area: np.ndarray, cell: tuple[int, int], points: np.ndarray
) -> dict[tuple[int, int], np.ndarray]:
    """What weight (n,) the polynomials of a cell and of those around have at plan points (n, 2) [m] in it."""
    (row, column), (x, y) = cell, lattice.lines
    right = (points[:, 0] - x.at[column]) / x.widths[column] - 0.5
    up = (points[:, 1] - y.at[row]) / y.widths[row] - 0.5
    found: dict[tuple[int, int], np.ndarray] = {}
    for dj, by_row in ((-1, np.maximum(0.0, -up)), (0, 1.0 - np.abs(up)), (1, np.maximum(0.0, up))):
        for di, by_column in (
            (-1, np.maximum(0.0, -right)),
            (0, 1.0 - np.abs(right)),
            (1, np.maximum(0.0, right)),
        ):
            beside = row + dj, column + di
            if _there(per_area, beside):
                found[beside] = by_row * by_column * per_area[beside]
    total = np.sum([*found.values()], axis=0)
    return {one: weight / total for one, weight in found.items()}


def _there(per_area: np.ndarray, cell: tuple[int, int]) -> bool:
    """Whether there is a cell of this row and column."""
    inside = all(0 <= at < count for at, count in zip(cell, per_area.shape, strict=True))
    return inside and bool(per_area[cell] > 0.0)


def _own_cell(lattice: Lattice, per_area: np.ndarray, point: np.ndarray) -> tuple[int, int]:
    """Row and column of the cell present in which, or on whose rim, a plan point [m] lies. Raises BadInput
    where there is none."""
    (column, x), (row, y) = (lines.index(c) for c, lines in zip(point, lattice.lines, strict=True))
    near = [
        (row + j, column + i)
        for j in (0, *([-1] if y < ON_LINE else [1] if y > 1.0 - ON_LINE else []))
        for i in (0, *([-1] if x < ON_LINE else [1] if x > 1.0 - ON_LINE else []))
    ]
    for j, i in near:
        if _there(per_area, (int(j), int(i))):
            return int(j), int(i)
    raise BadInput(f"point {point.tolist()} m: there is no sheet, by its outline or a cutout")


def _connected(per_area: np.ndarray, cell: tuple[int, int], reach: int) -> tuple[np.ndarray, np.ndarray]:
    """Rows and columns of the lines that cross at the corners of a cell, and of those that can be reached
    from it over so many sides."""
    found, last = {cell}, {cell}
    for _ in range(reach):
        beside = {(j + dj, i + di) for j, i in last for dj, di in ((0, 1), (0, -1), (1, 0), (-1, 0))}
        last = {one for one in beside - found if _there(per_area, one)}
        found |= last
    corners = sorted({(j + dj, i + di) for j, i in found for dj in (0, 1) for di in (0, 1)})
    rows, over = np.array(corners).T
    return rows, over


def _terms(at: np.ndarray, order: int) -> np.ndarray:
    """The terms of a bilinear surface (order 1), or of a quadric, at places (n, 2)."""
    x, y = at.T
    terms = [np.ones_like(x), x, y, x * y] + ([] if order == 1 else [x * x, y * y])
    return np.stack(terms, axis=1)
