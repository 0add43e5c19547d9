"""Runs of springs at constant distances between their masses, a tile at a time, which compilers vectorise.

With the masses numbered plane by plane (`lumped.springs.packing`), springs of one direction join mass a + i
to mass a + i + d for i = 0, 1, …: no list of masses is looked at. A tile holds up to WIDTH springs, a
quantity of all of them a row: positions go in as differences (`difference`), forces come out (`spread`), and
the loops between touch nothing but the tile and the rows of rest geometry and stiffness, which the compiler
can tell apart. Sums may be reassociated and products fused with them, in an order that only the code settles,
not the threads; no assumption is made about numbers that overflow.

Vectors are flat, component by component: x, y and z of every mass in turn. Indices are unsigned, since a
signed one might count from the end, which a vector cannot.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numba import njit

WIDTH = 128
YES: Any = np.True_  # for Python's own numba compiles a kernel once for each
NO: Any = np.False_
ROWS = tuple(np.uint64(row * WIDTH) for row in range(24))
OPTIONS: dict[str, Any] = {
    "cache": True,
    "error_model": "numpy",
    "fastmath": {"contract", "reassoc", "arcp", "nsz"},
}


@njit(**OPTIONS)
def difference(x: np.ndarray, first: int, second: int, row: int, count: int, tile: np.ndarray) -> None:
    """x[second + i] − x[first + i] into a row of the tile."""
    for i in range(count):
        tile[row + i] = x[second + i] - x[first + i]


@njit(**OPTIONS)
def spread(tile: np.ndarray, row: int, first: int, second: int, count: int, force: np.ndarray) -> None:
    """Add a row of the tile to the forces on the second ends, and take it from those on the first."""
    for i in range(count):
        force[first + i] -= tile[row + i]
    for i in range(count):
        force[second + i] += tile[row + i]
