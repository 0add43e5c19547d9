"""Banded Cholesky factors of symmetric positive definite matrices, as compiled loops that hold no lock.

Storage: row j holds column j of the lower triangle from the diagonal on, band[j, i − j] = A_ij, then zeros.
PANEL columns are eliminated together and the rest is updated two columns at a time: a rank-PANEL update whose
operands stay in registers. Rows end with zeros, so that loops run over whole vectors, and what cannot overlap
is said (`numerics.memory`). LAPACK's dpbtrf eliminates a column at a time at bandwidths below 65, which is
what small lattices have.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
import scipy.sparse as sp
from scipy.sparse.csgraph import reverse_cuthill_mckee

from sheetbench.numerics.memory import load, store
from sheetbench.numerics.typed import inner, njit

PANEL = 6  # the unknowns of a column of masses in two layers
LANES, ONE = np.uint64(8), np.uint64(1)  # that loops run over at once; index arithmetic is unsigned
TRY_OTHER_ORDER = 20_000  # unknowns up to which a second order is looked at: beyond, bands do not pay
BACKWARD_ERROR = 1e-10  # ‖A x − b‖ relative to ‖A‖‖x‖ + ‖b‖ beyond which the matrix counts as singular
REORDERED = {"reassoc", "contract", "nsz"}  # sums in any order, for vector instructions; infinities count


class Band(NamedTuple):
    """Where the entries of a matrix over 3×3 blocks go.

    order: (n,) the unknown at each place; width: entries below the diagonal; source, target, weight: entry of
    the blocks, entry of the storage where it is added, both flat, and its factor (none where all are one).
    """

    order: np.ndarray
    width: int
    source: np.ndarray
    target: np.ndarray
    weight: np.ndarray


NO_BAND = Band(np.empty(0, np.intp), 0, np.empty(0, np.int32), np.empty(0, np.int32), np.empty(0))


def ordered(rows: np.ndarray, columns: np.ndarray, n: int) -> tuple[np.ndarray, int]:
    """The order (n,) of an n × n matrix with entries (row, column), both triangles, and its bandwidth: as the
    unknowns are numbered, along the rows of the grid, or reverse Cuthill–McKee where that is narrower."""
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


def cost(n: int, width: int) -> float:
    """Multiplications of one factorisation, nearly."""
    return float(n) * (width + 1.0) ** 2


def band_of(
    source: np.ndarray,
    rows: np.ndarray,
    columns: np.ndarray,
    weight: np.ndarray,
    order: np.ndarray,
    width: int,
) -> Band:
    """Where the entries (row, column) go in this order."""
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


@njit(cache=True, nogil=True)
def padded_length(n: int) -> int:
    """Rows of the storage: whole panels, and two that the loops run over into."""
    return -(-n // PANEL) * PANEL + 2


@njit(cache=True, nogil=True)
def row_length(width: int) -> int:
    """Columns of the storage: those of the band, and zeros that the loops run over into."""
    return width + 1 + PANEL + 8


@njit(cache=True, nogil=True)
def padded_vector(n: int, width: int) -> np.ndarray:
    """Return zeros for a vector in the band's order that `substitute` takes."""
    return np.zeros(padded_length(n) + row_length(width))


@njit(cache=True, nogil=True)
def shape(band: Band) -> tuple[int, int]:
    """Rows and columns of the storage."""
    return padded_length(len(band.order)), row_length(band.width)


@inner()
def _lanes(count: int) -> Any:
    """A number of steps up to that of whole vectors."""
    return (np.uint64(count) + LANES - ONE) // LANES * LANES


@njit(cache=True, nogil=True)
def stored(blocks: np.ndarray, band: Band) -> np.ndarray:
    """The matrix of blocks (b, 3, 3) in band storage: whole panels, and zeros where the loops run over."""
    out = np.zeros(shape(band))
    entries, places = blocks.ravel(), out.ravel()
    if not len(band.weight):
        for e in range(len(band.source)):
            places[np.uint64(band.target[e])] += entries[np.uint64(band.source[e])]
    for e in range(len(band.weight)):
        places[band.target[e]] += band.weight[e] * entries[band.source[e]]
    return out


@inner()
def _corner(band: np.ndarray, k0: int) -> Any:
    """The triangle L of a panel's own rows: its inverted diagonal, and its columns below that."""
    own = band[k0 : k0 + PANEL]
    diagonal = own[0, 0], own[1, 0], own[2, 0], own[3, 0], own[4, 0], own[5, 0]
    first = own[0, 1], own[0, 2], own[0, 3], own[0, 4], own[0, 5]
    second = own[1, 1], own[1, 2], own[1, 3], own[1, 4]
    return diagonal, first, second, (own[2, 1], own[2, 2], own[2, 3]), (own[3, 1], own[3, 2]), own[4, 1]


@inner(fastmath=REORDERED)
def _forward(corner: Any, b0: float, b1: float, b2: float, b3: float, b4: float, b5: float) -> Any:
    """L⁻¹ b, in registers."""
    diagonal, (c01, c02, c03, c04, c05), (c12, c13, c14, c15), (c23, c24, c25), (c34, c35), c45 = corner
    i0, i1, i2, i3, i4, i5 = diagonal
    x0 = b0 * i0
    x1 = (b1 - c01 * x0) * i1
    x2 = (b2 - c02 * x0 - c12 * x1) * i2
    x3 = (b3 - c03 * x0 - c13 * x1 - c23 * x2) * i3
    x4 = (b4 - c04 * x0 - c14 * x1 - c24 * x2 - c34 * x3) * i4
    x5 = (b5 - c05 * x0 - c15 * x1 - c25 * x2 - c35 * x3 - c45 * x4) * i5
    return x0, x1, x2, x3, x4, x5


@inner(fastmath=REORDERED)
def _backward(corner: Any, b0: float, b1: float, b2: float, b3: float, b4: float, b5: float) -> Any:
    """L⁻ᵀ b, in registers."""
    diagonal, (c01, c02, c03, c04, c05), (c12, c13, c14, c15), (c23, c24, c25), (c34, c35), c45 = corner
    i0, i1, i2, i3, i4, i5 = diagonal
    x5 = b5 * i5
    x4 = (b4 - c45 * x5) * i4
    x3 = (b3 - c34 * x4 - c35 * x5) * i3
    x2 = (b2 - c23 * x3 - c24 * x4 - c25 * x5) * i2
    x1 = (b1 - c12 * x2 - c13 * x3 - c14 * x4 - c15 * x5) * i1
    x0 = (b0 - c01 * x1 - c02 * x2 - c03 * x3 - c04 * x4 - c05 * x5) * i0
    return x0, x1, x2, x3, x4, x5


@njit(cache=True, nogil=True, fastmath=REORDERED)
def factor(band: np.ndarray, n: int, width: int) -> bool:
    """Turn the matrix into its Cholesky factor in place, with its diagonal inverted; False where it is not
    positive definite."""
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
        corner = _corner(band, k0)
        p0 = np.uint64(k0) * stride + np.uint64(PANEL)  # places of the row behind the panel
        p1 = p0 + stride - ONE
        p2 = p1 + stride - ONE
        p3 = p2 + stride - ONE
        p4 = p3 + stride - ONE
        p5 = p4 + stride - ONE
        for i in range(_lanes(width)):
            b0, b1, b2 = load(0, flat, p0 + i), load(1, flat, p1 + i), load(2, flat, p2 + i)
            b3, b4, b5 = load(3, flat, p3 + i), load(4, flat, p4 + i), load(5, flat, p5 + i)
            x0, x1, x2, x3, x4, x5 = _forward(corner, b0, b1, b2, b3, b4, b5)
            store(0, flat, p0 + i, x0)
            store(1, flat, p1 + i, x1)
            store(2, flat, p2 + i, x2)
            store(3, flat, p3 + i, x3)
            store(4, flat, p4 + i, x4)
            store(5, flat, p5 + i, x5)
        for j in range(k0 + PANEL, min(n, k0 + PANEL + width), 2):
            off = j - k0
            first, second = band[j], band[j + 1]
            l0, l1, l2 = band[k0, off:], band[k0 + 1, off - 1 :], band[k0 + 2, off - 2 :]
            l3, l4, l5 = band[k0 + 3, off - 3 :], band[k0 + 4, off - 4 :], band[k0 + 5, off - 5 :]
            f0, f1, f2, f3, f4, f5 = l0[0], l1[0], l2[0], l3[0], l4[0], l5[0]
            g0, g1, g2, g3, g4, g5 = l0[1], l1[1], l2[1], l3[1], l4[1], l5[1]
            first[0] -= f0 * f0 + f1 * f1 + f2 * f2 + f3 * f3 + f4 * f4 + f5 * f5
            for i in range(ONE, ONE + _lanes(width + PANEL - off - 1)):
                m0, m1, m2 = load(0, l0, i), load(0, l1, i), load(0, l2, i)
                m3, m4, m5 = load(0, l3, i), load(0, l4, i), load(0, l5, i)
                by_first = f0 * m0 + f1 * m1 + f2 * m2 + f3 * m3 + f4 * m4 + f5 * m5
                by_second = g0 * m0 + g1 * m1 + g2 * m2 + g3 * m3 + g4 * m4 + g5 * m5
                store(1, first, i, load(1, first, i) - by_first)
                store(2, second, i - ONE, load(2, second, i - ONE) - by_second)
    return True


@njit(cache=True, nogil=True)
def factored(blocks: np.ndarray, band: Band) -> tuple[np.ndarray, bool]:
    """Cholesky factors of the matrix of blocks (b, 3, 3), and whether there are such."""
    factors = stored(blocks, band)
    return factors, factor(factors, len(band.order), band.width)


@inner(fastmath=REORDERED)
def substitute(factors: np.ndarray, n: int, width: int, x: np.ndarray) -> None:
    """Solve with the factors in place, x in the band's order in a `padded_vector`."""
    last, count = (n - 1) // PANEL * PANEL, _lanes(width)
    for k0 in range(0, last + 1, PANEL):
        own, rest, corner = x[k0 : k0 + PANEL], x[k0 + PANEL :], _corner(factors, k0)
        f0, f1, f2, f3, f4, f5 = _forward(corner, own[0], own[1], own[2], own[3], own[4], own[5])
        own[0], own[1], own[2], own[3], own[4], own[5] = f0, f1, f2, f3, f4, f5
        l0, l1, l2 = factors[k0, 6:], factors[k0 + 1, 5:], factors[k0 + 2, 4:]
        l3, l4, l5 = factors[k0 + 3, 3:], factors[k0 + 4, 2:], factors[k0 + 5, 1:]
        for i in range(count):
            taken = f0 * load(0, l0, i) + f1 * load(0, l1, i) + f2 * load(0, l2, i)
            taken += f3 * load(0, l3, i) + f4 * load(0, l4, i) + f5 * load(0, l5, i)
            store(1, rest, i, load(1, rest, i) - taken)
    for k0 in range(last, -1, -PANEL):
        own, rest, corner = x[k0 : k0 + PANEL], x[k0 + PANEL :], _corner(factors, k0)
        l0, l1, l2 = factors[k0, 6:], factors[k0 + 1, 5:], factors[k0 + 2, 4:]
        l3, l4, l5 = factors[k0 + 3, 3:], factors[k0 + 4, 2:], factors[k0 + 5, 1:]
        s0 = s1 = s2 = s3 = s4 = s5 = 0.0
        for i in range(count):
            value = load(1, rest, i)
            s0 += load(0, l0, i) * value
            s1 += load(0, l1, i) * value
            s2 += load(0, l2, i) * value
            s3 += load(0, l3, i) * value
            s4 += load(0, l4, i) * value
            s5 += load(0, l5, i) * value
        b0, b1, b2, b3, b4, b5 = own[0] - s0, own[1] - s1, own[2] - s2, own[3] - s3, own[4] - s4, own[5] - s5
        own[0], own[1], own[2], own[3], own[4], own[5] = _backward(corner, b0, b1, b2, b3, b4, b5)


@njit(cache=True, nogil=True)
def solve_unrefined(factors: np.ndarray, width: int, order: np.ndarray, b: np.ndarray) -> np.ndarray:
    """x with A x = b as the factors have it."""
    x = padded_vector(len(order), width)
    for j in range(len(order)):
        x[j] = b[order[j]]
    substitute(factors, len(order), width, x)
    out = np.empty(len(order))
    for j in range(len(order)):
        out[order[j]] = x[j]
    return out
