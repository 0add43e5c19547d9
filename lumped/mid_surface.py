"""The mid-surface at plan points: the mean of the layers, through the masses around by polynomials.

Between masses the surface is the cubic through the nearest four lines of the grid along x and along y (all
of them where there are fewer): a bilinear surface through masses at the distance l is up to κ l²/8 off a
sheet of curvature κ, at 9 × 9 masses of a sagging sheet 1 to 3 % of its sag, and more where cells are graded.

On lattices with absent cells every cell has a quadric fitted by least squares to its own masses and to the
masses of cells connected with it, up to REACH cells on; masses count the more the nearer they are and the
more sheet the cells around them have. The surface is a mean of the quadrics of the four cells around the
nearest crossing of lines, weighed by the cells' mass per area and by ½ ± the distance from the lines there,
in cells, along x and y. It is continuous: a cell's own quadric at its middle, the mean of both between two.

A linear map of the masses' displacement; its transpose shares a force at a point among the masses around it,
as loads do it among the four next to it (order 1).
"""

from functools import cache
from itertools import product

import numpy as np
import scipy.sparse as sp

from lumped.lattice import Lattice
from sheetbench.errors import BadInput
from sheetbench.numerics.cache import cached

REACH = 2  # cells beside a point's, by their sides
ON_LINE = 1e-6  # of a cell's side


class MidSurface:
    """Mid-surface of a lattice at plan points, by polynomials.

    Parameters
    ----------
    lattice : Lattice
        Lattice; the shares of its masses are kept for equal points.
    points : ndarray of shape (n, 2)
        Plan points [m].
    order : int, default 3
        Order of the polynomials between masses, 1 or 3.

    Raises
    ------
    BadInput
        For points off the sheet.
    """

    def __init__(self, lattice: Lattice, points: np.ndarray, order: int = 3):
        self._shares = _shares(lattice, np.asarray(points, dtype=float).reshape(-1, 2), order)

    def of(self, field: np.ndarray) -> np.ndarray:
        """Return the values (n, 3) at the points of a field of vectors (masses and more, 3)."""
        return np.asarray(self._shares @ field[: self._shares.shape[1]])

    def matrix(self, size: int) -> sp.csr_array:
        """Return the map of flat displacements (size, 3) to flat values, (3 points, 3 size)."""
        points, masses = self._shares.shape
        wider = sp.csr_array((points, size - masses))
        return sp.csr_array(sp.kron(sp.hstack([self._shares, wider]), sp.eye_array(3)))

    def shared(self, values: np.ndarray, size: int) -> np.ndarray:
        """Distribute values (n, k) at the points over the masses, (size, k), by the transposed map."""
        masses = self._shares.shape[1]
        return np.pad(self._shares.T @ values, ((0, size - masses), (0, 0)))


@cached(last=8, most=2**16, size=lambda lattice, points, _: points.nbytes + 8 * lattice.mass_count)
def _shares(lattice: Lattice, points: np.ndarray, order: int) -> sp.csr_array:
    """Return the share of every mass in the value at plan points (n, 2) [m], (n, masses). Raises BadInput for
    points off the sheet."""
    places = [lines.index(points[:, axis])[1] for axis, lines in enumerate(lattice.lines)]
    outside = np.max(np.abs(np.array(places) - 0.5), axis=0) > 0.5 + 1e-9
    if outside.any():
        raise BadInput(f"point {points[outside][0].tolist()} m is off the sheet")
    if lattice.per_area is not None:
        own = _own_cells(lattice, np.pad(lattice.per_area, 1), points)
        if order > 1:
            return _of_columns(lattice, *_near_rims(lattice, lattice.per_area, own, points))
    (i, x), (j, y) = (lines.around(points[:, axis], order + 1) for axis, lines in enumerate(lattice.lines))
    return _of_columns(lattice, j, i, y[:, :, None] * x[:, None, :])


def _of_columns(lattice: Lattice, rows: np.ndarray, over: np.ndarray, shares: np.ndarray) -> sp.csr_array:
    """Return the map (n, masses) with shares (n, k, l) of the columns of masses at crossings of lines, rows
    (n, k) and over (n, l), each divided equally among the layers, without zeros."""
    nodes, layers = lattice.columns()[rows[:, :, None], over[:, None, :]], lattice.grid[2]
    points = np.broadcast_to(np.arange(len(rows))[:, None, None, None], nodes.shape)
    each = np.broadcast_to(shares[..., None] / layers, nodes.shape)
    entries = (each.ravel(), (points.ravel(), nodes.ravel()))
    matrix = sp.csr_array(sp.coo_array(entries, shape=(len(rows), lattice.mass_count)))
    matrix.eliminate_zeros()
    return matrix


def _near_rims(
    lattice: Lattice, per_area: np.ndarray, cells: np.ndarray, points: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return lines and weights as for `_of_columns`, on a lattice with absent cells, of points in the cells
    `cells` (n, 2): the lines around them."""
    wide, around, (x, y) = np.pad(per_area, 1), _around(per_area), lattice.lines
    reach = REACH + 1

    def places(at: np.ndarray, row: int, column: int) -> np.ndarray:
        """Return plan points (n, 2) [m] from the middle of a cell in its sides."""
        first, sides = np.array([x.at[column], y.at[row]]), np.array([x.widths[column], y.widths[row]])
        return np.asarray((at - first) / sides - 0.5)

    @cache
    def nearest(row: int, column: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return rows and columns of the lines that cross at the masses (k,) of a cell and of cells connected
        with it, and the map from their values to the terms of the polynomial nearest to them, (terms, k)."""
        rows, over = _corners(per_area, row, column)
        at = places(np.stack([x.at[over], y.at[rows]], axis=1), row, column)
        near = np.sqrt(around[rows, over]) / (0.5 + (at**2).sum(axis=1))
        return rows, over, np.linalg.pinv(_terms(at) * near[:, None], rcond=1e-9) * near

    lines = np.arange(-reach, reach + 2)
    share = np.zeros((len(points), len(lines), len(lines)))
    for row, column in set(map(tuple, cells.tolist())):
        which = np.flatnonzero((cells == (row, column)).all(axis=1))
        at = places(points[which], row, column)
        blend = np.stack([np.maximum(0.0, -at), 1.0 - np.abs(at), np.maximum(0.0, at)])
        weight = blend[:, None, :, 1] * blend[None, :, :, 0]
        weight *= wide[row : row + 3, column : column + 3, None]
        weight /= weight.sum(axis=(0, 1))
        for j, i in np.argwhere(weight.any(axis=2)).tolist():
            rows, over, fit = nearest(row + j - 1, column + i - 1)
            values = _terms(places(points[which], row + j - 1, column + i - 1)) @ fit
            share[which[:, None], rows - row + reach, over - column + reach] += weight[j, i, :, None] * values
    rows, over = (np.clip(cells[:, axis, None] + lines, 0, per_area.shape[axis]) for axis in (0, 1))
    return rows, over, share


def _own_cells(lattice: Lattice, wide: np.ndarray, points: np.ndarray) -> np.ndarray:
    """Return row and column (n, 2) of a present cell that contains each plan point (n, 2) [m], inside or on
    its rim; wide: mass per area of the cells, padded by zeros. Raises BadInput for a point without one."""
    (column, x), (row, y) = (lines.index(points[:, axis]) for axis, lines in enumerate(lattice.lines))
    over, up = (np.where(at < ON_LINE, -1, np.where(at > 1.0 - ON_LINE, 1, 0)) for at in (x, y))
    beside = [np.stack([row + j * up, column + i * over], axis=1) for j, i in product((0, 1), (0, 1))]
    there = np.array([wide[tuple(cell.T + 1)] > 0.0 for cell in beside])
    if not there.any(axis=0).all():
        off = points[~there.any(axis=0)][0].tolist()
        raise BadInput(f"point {off} m: there is no sheet, by its outline or a cutout")
    return np.stack(beside)[there.argmax(axis=0), np.arange(len(points))]


def _corners(per_area: np.ndarray, row: int, column: int) -> tuple[np.ndarray, np.ndarray]:
    """Return rows and columns of the lines that cross at the corners of a cell and of the cells that can be
    reached from it over REACH sides."""
    from scipy.ndimage import binary_dilation

    cell = np.zeros(per_area.shape, dtype=bool)
    cell[row, column] = True
    reached = binary_dilation(cell, iterations=REACH, mask=per_area > 0.0)
    rows, over = np.nonzero(_around(reached))
    return rows, over


def _around(cells: np.ndarray) -> np.ndarray:
    """Return the mean of the cells around each crossing of lines, (rows + 1, columns + 1)."""
    wide = np.pad(cells, 1).astype(float)
    return np.asarray(0.25 * (wide[1:, 1:] + wide[1:, :-1] + wide[:-1, 1:] + wide[:-1, :-1]))


def _terms(at: np.ndarray) -> np.ndarray:
    """Return the terms of a quadric at plan points (n, 2)."""
    x, y = at.T
    return np.stack([np.ones_like(x), x, y, x * y, x * x, y * y], axis=1)
