"""Size of a lattice's solve, from its grid alone.

A column of L masses is joined to itself and eight others, every layer with the next ones: 9 (3 L − 2) blocks
of the tangent. What is kept and done is proportional to the blocks, but for the factors of the tangent.

The constants were fitted on an Intel Xeon at 2.5 GHz with Python 3.11, 2026-11-22. Bytes: to the peaks of
the resident set on the whole path from the flat sheet, 1.2 GB at 129 × 129 × 2 and 0.3 GB at 33 × 33 × 4
masses; a path that begins at a coarser lattice, as large `consistent` ones do, has one set of factors at a
time and takes about half. Seconds: to 0.25, 1.1, 6 and 30 s for 33, 65, 129 and 257 masses a side on a quiet
core; the whole path takes about twice as long, and a core that is shared up to three times.
"""

from sheetbench.answers.size import Size, factors
from sheetbench.scenes.objects.grid import Grid

ALWAYS = 40e6  # bytes
A_BLOCK = 600.0  # bytes
A_NONZERO = 24.0  # bytes, of the factors, with what the solver needs on the way
BLOCK_SECONDS, OPERATION_SECONDS = 8e-6, 3e-10


def footprint(grid: Grid) -> Size:
    """Return the size of a static solve; dynamics and natural frequencies take about as much memory.

    Parameters
    ----------
    grid : tuple of int
        Masses along x, y and z.

    Returns
    -------
    Size
        Unknowns, peak memory [bytes] and seconds.
    """
    nx, ny, layers = grid
    blocks = nx * ny * 9 * (3 * layers - 2)
    nonzeros, operations = factors((nx, ny), 3 * layers)
    return Size(
        unknowns=3 * nx * ny * layers,
        memory=ALWAYS + A_BLOCK * blocks + A_NONZERO * nonzeros,
        seconds=BLOCK_SECONDS * blocks + OPERATION_SECONDS * operations,
    )
