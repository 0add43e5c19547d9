"""Grids as the user writes them: `N` along the shorter side, `NxM` along x and y, `NxMxL` with layers.

What the numbers mean is said in `sheetbench.scenes.grid`.
"""

from __future__ import annotations

from collections.abc import Sequence

from sheetbench.scenes import Scene, Sheet, SpringTable
from sheetbench.scenes.errors import BadInput
from sheetbench.scenes.grid import MASSES, Grid, grid_of

Asked = int | Sequence[int] | str | None


def parse_grid(sheet: Sheet, text: str) -> Grid:
    """The grid of `N`, `NxM` or `NxMxL`. Raises BadInput naming the option, under both its names."""
    parts = text.lower().replace("×", "x").split("x")
    try:
        numbers = [int(part) for part in parts]
    except ValueError:
        numbers = []
    if len(numbers) not in (1, 2, 3) or min(numbers) < 2:
        raise BadInput(
            f"--lumped = '{text}', the same as --grid: not a grid; write 9 (masses along the shorter side, "
            "near-square cells), 9x13 (along x and y) or 9x13x3 (with layers), each at least 2"
        )
    return grid_of(sheet, numbers)


def scene_grid(scene: Scene, asked: Asked = None) -> Grid:
    """The grid asked for, as text or as numbers; else that of the scene's own [springs], if they name one, or
    nine masses along the shorter side."""
    if isinstance(asked, str):
        return parse_grid(scene.sheet, asked)
    own = scene.springs.grid if isinstance(scene.springs, SpringTable) else None
    return grid_of(scene.sheet, asked if asked is not None else own or MASSES)
