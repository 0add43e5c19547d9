"""Grids as the user writes them: `N` along the shorter side, `NxM` along x and y, `NxMxL` with layers.

The numbers count masses of lattices or elements of references (`scenes.objects.grid`).
"""

from collections.abc import Sequence

from sheetbench.errors import BadInput
from sheetbench.scenes import Scene, Sheet
from sheetbench.scenes.objects.grid import DEFAULT_MASSES, Grid, grid_of

GridLike = int | Sequence[int] | str | None
Elements = int | tuple[int, int]


def parse_elements(text: Elements | str, option: str = "--elements") -> Elements:
    """Return the elements of `N`, near-square along the shorter side, or `NxM`, along x and y; numbers pass
    unchanged. Raises BadInput naming the option."""
    if not isinstance(text, str):
        return text
    numbers = _numbers(text)
    if len(numbers) not in (1, 2):
        raise BadInput(
            f"{option} = '{text}': write 16 (elements along the shorter side) or 8x4 (along x and y)"
        )
    if min(numbers) < 1:
        raise BadInput(f"{option} = {text}: at least 1")
    return numbers[0] if len(numbers) == 1 else (numbers[0], numbers[1])


def parse_grid(sheet: Sheet, text: str) -> Grid:
    """Return the grid of `N`, `NxM` or `NxMxL`. Raises BadInput naming the option, under both its names."""
    numbers = _numbers(text)
    if len(numbers) not in (1, 2, 3) or min(numbers) < 2:
        raise BadInput(
            f"--lumped = '{text}', the same as --grid: not a grid; write 9 (masses along the shorter side, "
            "near-square cells), 9x13 (along x and y) or 9x13x3 (with layers), each at least 2"
        )
    return grid_of(sheet, numbers)


def scene_grid(scene: Scene, grid: GridLike = None) -> Grid:
    """Return a grid given as text or numbers; by default the grid of the scene's [springs], without one nine
    masses along the shorter side."""
    if isinstance(grid, str):
        return parse_grid(scene.sheet, grid)
    own = scene.springs and scene.springs.grid
    return grid_of(scene.sheet, grid if grid is not None else own or DEFAULT_MASSES)


def _numbers(text: str) -> list[int]:
    """Return the whole numbers of text as 9x13, an empty list for other text."""
    parts = text.lower().replace("×", "x").split("x")
    return [int(part) for part in parts] if all(p.isascii() and p.isdigit() for p in parts) else []
