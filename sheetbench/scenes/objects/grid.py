"""Grids of a sheet: the numbers of masses along x, along y and through the thickness.

A grid is (nx, ny, layers), counted in masses: 9 × 9 masses have 8 × 8 cells. One number is the count along
the shorter side, and the cells are then as square as that allows; two are the counts along x and y; a third
is the number of layers, 2 unless given.
"""

from collections.abc import Sequence

import numpy as np

from sheetbench.errors import BadInput
from sheetbench.scenes.objects.sheet import Sheet

Grid = tuple[int, int, int]
LAYERS = 2
MESH = 16  # the usual number of elements (`sheetbench.choices`), which stands for a sheet's own mesh
DIGITS = 9  # of a number of cells, before it is made whole
DEFAULT_MASSES = 9  # along the shorter side, unless something else is requested


def near_square(sheet: Sheet, cells: int) -> tuple[int, int]:
    """Return the numbers of cells along x and y: `cells` along the shorter side, nearly square ones."""
    shorter = min(sheet.lengths)
    # rounding of a half, as in 7.5 cells, must not depend on the last bit
    shares = (cells * length / shorter for length in sheet.lengths)
    along_x, along_y = (max(cells, round(round(share, DIGITS))) for share in shares)
    return along_x, along_y


def elements_of(sheet: Sheet, elements: int) -> tuple[int, int]:
    """Return the numbers of elements along x and y: `elements` along the shorter side, nearly square ones. If
    the sheet has a mesh of its own, 16 stands for that mesh, and other numbers for a mesh finer or coarser in
    proportion."""
    if sheet.mesh is None:
        return near_square(sheet, elements)
    return near_square(sheet, max(1, round(elements * sheet.mesh.across / MESH)))


def grid_of(sheet: Sheet, masses: int | Sequence[int] = DEFAULT_MASSES) -> Grid:
    """Return the grid that one, two or three numbers request.

    Raises BadInput below two masses a side or two layers, and for values that are not whole numbers.
    """
    counts = np.atleast_1d(masses)
    if counts.dtype.kind not in "iu" or counts.shape not in ((1,), (2,), (3,)):
        raise BadInput(f"grid = {masses!r}: write 9, (9, 13) or (9, 13, 2)")
    numbers = counts.tolist()
    if len(numbers) == 1:
        numbers = [cells + 1 for cells in near_square(sheet, numbers[0] - 1)]
    nx, ny, layers = (*numbers, LAYERS) if len(numbers) == 2 else tuple(numbers)
    if min(nx, ny, layers) < 2:
        raise BadInput(f"grid = {nx}x{ny}x{layers}: a lattice has at least 2 masses a side and 2 layers")
    return nx, ny, layers
