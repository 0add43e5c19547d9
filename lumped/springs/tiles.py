"""Runs of springs at constant distances between their masses, a tile at a time, which compilers vectorise.

With the masses numbered plane by plane (`lumped.springs.packing`), springs of one direction join mass a + i
to mass a + i + d for i = 0, 1, …: no list of masses is looked at. A tile holds up to WIDTH springs, a
quantity of all of them a row. A spring's shape, which is what takes divisions and roots, is found once for a
displacement and kept behind the rows; dampers are asked for any number of velocities after that. Forces go to
the first ends and to the second ones in loops of their own, since in one the ends of neighbours meet. Sums
may be reassociated and products fused with them, in an order that only the code settles, not the threads; no
assumption is made about numbers that overflow.

Vectors are flat, component by component: x, y and z of every mass in turn. Indices are unsigned, since a
signed one might count from the end, which a vector cannot.
"""

from __future__ import annotations

from typing import Any

import numpy as np

WIDTH = 128
LANES = np.uint64(8)  # springs of a run come in blocks of so many, as wide as the widest vectors
NUMBA_TRUE: Any = np.True_  # for Python's own numba compiles a kernel once for each
NUMBA_FALSE: Any = np.False_
STRIDE = WIDTH + 8  # of rows; a power of two would put them all in the same few places of a cache
ROWS = tuple(np.uint64(row * STRIDE) for row in range(24))
# kinds of memory that never overlap (`numerics.memory`): what is only read (rest data, displacements,
# velocities), what springs keep of their shape, rows of a tile, and the three components of forces
GIVEN, KEPT, ROW, FORCE_X, FORCE_Y, FORCE_Z = range(6)
OPTIONS: dict[str, Any] = {
    "cache": True,
    "error_model": "numpy",
    "fastmath": {"contract", "reassoc", "arcp", "nsz"},
}
