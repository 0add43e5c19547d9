"""How large a lattice is to solve, told from its grid alone.

A column of L masses is joined to itself and eight others, every layer with the next ones: 9 (3 L − 2) blocks
of the tangent. What is kept and done is proportional to the blocks, but for the factors of the tangent.

The constants were fitted to static solves on an AMD EPYC with Python 3.11, 2026-11-22: bytes to the peaks of
the resident set for 17 × 17 × 2 to 257 × 257 × 2 masses, four layers and a strip of 5 × 1025, all of them
within 31 %; seconds to 0.24, 1.4 and 42 s for 33, 65 and 257 masses a side on a quiet core. One that is
shared takes up to three times as long.
"""

from __future__ import annotations

from sheetbench.scenes.grid import Grid
from sheetbench.scenes.size import Size, factors

ALWAYS = 40e6  # bytes
A_BLOCK = 1200.0  # bytes
A_NONZERO = 26.0  # bytes, of the factors, with what the solver needs on the way
BLOCK_SECONDS, OPERATION_SECONDS = 4e-6, 1.5e-9


def footprint(grid: Grid) -> Size:
    """Of statics; dynamics and natural frequencies take about as much memory."""
    nx, ny, layers = grid
    blocks = nx * ny * 9 * (3 * layers - 2)
    nonzeros, operations = factors((nx, ny), 3 * layers)
    return Size(
        unknowns=3 * nx * ny * layers,
        memory=ALWAYS + A_BLOCK * blocks + A_NONZERO * nonzeros,
        seconds=BLOCK_SECONDS * blocks + OPERATION_SECONDS * operations,
    )
