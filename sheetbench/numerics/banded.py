"""Banded Cholesky factors of symmetric positive definite matrices, as compiled loops that hold no lock.

Storage: row j holds column j of the lower triangle from the diagonal on, band[j, i − j] = A_ij, then zeros.
PANEL columns are eliminated together and the rest is updated two columns at a time: a rank-PANEL update whose
operands stay in registers. Rows end with zeros, so that loops run over whole vectors, and accesses have alias
scopes (`numerics.aliasing`). LAPACK's dpbtrf eliminates a column at a time at bandwidths below 65, as in
small lattices.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
import scipy.sparse as sp
from scipy.sparse.csgraph import reverse_cuthill_mckee

from sheetbench.numerics.aliasing import empty, load, load_each, store, zeros
from sheetbench.numerics.options import REORDERED, inner, njit
from sheetbench.numerics.panels import PANEL, dot, eliminate, solve_backward, solve_forward, triangle

LANES, ONE = np.uint64(8), np.uint64(1)  # entries of a vector; index arithmetic is unsigned
TRY_OTHER_ORDER = 20_000  # unknowns up to which a second order is tried: beyond, bands are too slow
BACKWARD_ERROR = 1e-10  # ‖A x − b‖ relative to ‖A‖‖x‖ + ‖b‖ beyond which the matrix counts as singular


class Band(NamedTuple):
    """Map from the entries of a matrix in 3×3 blocks to band storage. order: (n,) the unknown at each place.
    width: number of entries below the diagonal. source, target, weight: flat entry of the blocks, flat entry
    of the storage to which it is added, and its factor (empty if all are one)."""

    order: np.ndarray
    width: int
    source: np.ndarray
    target: np.ndarray
    weight: np.ndarray


def ordered(rows: np.ndarray, columns: np.ndarray, n: int) -> tuple[np.ndarray, int]:
    """Return the order (n,) of an n × n matrix with entries (row, column), both triangles, and its bandwidth.
    The order is the unknowns' own, along the rows of the grid, or reverse Cuthill–McKee if it is narrower."""
    order = np.arange(n)
    width = int(np.abs(rows - columns).max(initial=0))
    if not 0 < n <= TRY_OTHER_ORDER:
        return order, width
    graph = sp.csr_array((np.ones(len(rows), np.int8), (rows, columns)), shape=(n, n))
    other = reverse_cuthill_mckee(graph, symmetric_mode=True)
    place = np.empty(n, int)
    place[other] = order
    narrower = int(np.abs(place[rows] - place[columns]).max(initial=0))
    return (other, narrower) if narrower < width else (order, width)


def band_of(
    source: np.ndarray,
    rows: np.ndarray,
    columns: np.ndarray,
    weight: np.ndarray,
    order: np.ndarray,
    width: int,
) -> Band:
    """Return the map of entries (row, column) to the band storage of an order."""
    n = len(order)
    place = np.empty(n, int)
    place[order] = np.arange(n)
    r, c = place[rows], place[columns]
    lower = np.flatnonzero(r >= c)
    r, c, weight = r[lower], c[lower], weight[lower]
    kind = np.int32 if n * row_length(width) < 2**31 else np.int64
    target = (c * row_length(width) + r - c).astype(kind)
    weight = np.empty(0) if (weight == 1.0).all() else weight
    return Band(order.astype(np.intp), width, source[lower].astype(np.int32), target, weight)


@njit
def padded_length(n: int) -> int:
    """Return the number of rows of the storage: whole panels, and two rows of padding."""
    return -(-n // PANEL) * PANEL + 2


@njit
def row_length(width: int) -> int:
    """Return the number of columns of the storage: the band's, and zeros as padding."""
    return width + 1 + PANEL + 8


@njit
def padded_vector(n: int, width: int) -> np.ndarray:
    """Return zeros for a vector in the band's order that `substitute` takes."""
    return zeros(padded_length(n) + row_length(width))


@inner()
def _lanes(count: int) -> Any:
    """Round a number of entries up to whole vectors."""
    return (np.uint64(count) + LANES - ONE) // LANES * LANES


@njit
def stored(blocks: np.ndarray, band: Band) -> np.ndarray:
    """Return the matrix of blocks (b, 3, 3) in band storage, padded with zeros."""
    out = zeros((padded_length(len(band.order)), row_length(band.width)))
    entries, places = blocks.ravel(), out.ravel()
    if not len(band.weight):
        for e in range(len(band.source)):
            places[np.uint64(band.target[e])] += entries[np.uint64(band.source[e])]
    for e in range(len(band.weight)):
        places[band.target[e]] += band.weight[e] * entries[band.source[e]]
    return out


@njit(fastmath=REORDERED)
def factor(band: np.ndarray, n: int, width: int) -> bool:
    """Turn a matrix into its Cholesky factor in place, with an inverted diagonal; False if not definite."""
    for j in range(n, len(band)):
        band[j, 0] = 1.0
    flat, stride = band.ravel(), np.uint64(band.shape[1])
    for k0 in range(0, n, PANEL):
        for k in range(k0, k0 + PANEL):
            pivot = band[k, 0]
            for i in range(k0, k):
                pivot -= band[i, k - i] ** 2
            if not (pivot > 0.0 and pivot < np.inf):
                return False
            band[k, 0] = 1.0 / np.sqrt(pivot)
            for j in range(k + 1, k0 + PANEL):
                total = band[k, j - k]
                for i in range(k0, k):
                    total -= band[i, k - i] * band[i, j - i]
                band[k, j - k] = total * band[k, 0]
        place = np.uint64(k0) * stride
        corner = triangle(flat, place, stride - ONE)
        eliminate(corner, flat, place + np.uint64(PANEL), stride - ONE, _lanes(width))
        for j in range(k0 + PANEL, min(n, k0 + PANEL + width), 2):
            off = j - k0
            first, second = band[j], band[j + 1]
            row = place + np.uint64(off)
            f = load_each(0, flat, row, stride - ONE, PANEL)
            g = load_each(0, flat, row + ONE, stride - ONE, PANEL)
            first[0] -= dot(f, f)
            for i in range(ONE, ONE + _lanes(width + PANEL - off - 1)):
                m = load_each(0, flat, row + i, stride - ONE, PANEL)
                store(1, first, i, load(1, first, i) - dot(f, m))
                store(2, second, i - ONE, load(2, second, i - ONE) - dot(g, m))
    return True


def factored(blocks: np.ndarray, band: Band) -> tuple[np.ndarray, bool]:
    """Return the Cholesky factors of the matrix of blocks (b, 3, 3), and whether it is positive definite."""
    factors = stored(blocks, band)
    return factors, factor(factors, len(band.order), band.width)


@inner(fastmath=REORDERED)
def substitute(factors: np.ndarray, n: int, width: int, x: np.ndarray) -> None:
    """Solve with the factors in place, x in the band's order in a `padded_vector`."""
    last, flat, stride = (n - 1) // PANEL * PANEL, factors.ravel(), np.uint64(factors.shape[1])
    for k0 in range(0, last + 1, PANEL):
        solve_forward(flat, np.uint64(k0) * stride, stride - ONE, x, k0, _lanes(width))
    for k0 in range(last, -1, -PANEL):
        solve_backward(flat, np.uint64(k0) * stride, stride - ONE, x, k0, _lanes(width))


@njit
def solve_unrefined(factors: np.ndarray, width: int, order: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Solve A x = b with the factors, without refinement."""
    x = padded_vector(len(order), width)
    for j in range(len(order)):
        x[j] = b[order[j]]
    substitute(factors, len(order), width, x)
    out = empty(len(order))
    for j in range(len(order)):
        out[order[j]] = x[j]
    return out
