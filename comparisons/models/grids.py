"""Grids of a sheet: how many masses lie along x and y, as a number of cells or as the user writes it.

A grid is (nx, ny, layers), counted in masses: 9 × 9 masses have 8 × 8 cells.
"""

from __future__ import annotations

from sheetbench.scenes import Sheet
from sheetbench.scenes.errors import BadInput

Grid = tuple[int, int, int]
LAYERS = 2
MASSES = 9


def near_square(sheet: Sheet, cells: int) -> tuple[int, int]:
    """Cells along x and y: `cells` along the shorter side, and cells as square as that allows."""
    shorter = min(sheet.lengths)
    along_x, along_y = (max(cells, round(cells * length / shorter)) for length in sheet.lengths)
    return along_x, along_y


def default_grid(sheet: Sheet) -> Grid:
    """Nine masses along the shorter side, near-square cells, two layers."""
    along_x, along_y = near_square(sheet, MASSES - 1)
    return along_x + 1, along_y + 1, LAYERS


def parse_grid(text: str, option: str) -> Grid:
    """The grid of `N` (N × N masses), `NxM` or `NxMxL`.

    Raises BadInput naming the option.
    """
    parts = text.lower().replace("×", "x").split("x")
    try:
        numbers = [int(part) for part in parts]
    except ValueError:
        numbers = []
    if len(numbers) not in (1, 2, 3) or min(numbers) < 2:
        raise BadInput(
            f"{option} = '{text}': not a grid; write 9, 9x13 or 9x13x2 "
            "(masses along x, masses along y, layers; each at least 2)"
        )
    if len(numbers) == 1:
        numbers *= 2
    return numbers[0], numbers[1], numbers[2] if len(numbers) == 3 else LAYERS
