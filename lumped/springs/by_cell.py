"""Constants that every plan cell has its own of: tables of a spring set (`sheetbench.scenes.springs`).

A table is rows of cells from y0 to y1, each from x0 to x1; edge_shear, strip_shear and those of the far edges
have lists along the edges. One number is every cell's.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from sheetbench.errors import BadInput
from sheetbench.scenes import PerDirection, SpringSet
from sheetbench.scenes.grid import Grid
from sheetbench.scenes.springs import Either

EDGES_OWN = ("edge_shear", "strip_shear", "far_edge_shear", "far_strip_shear")


def varies(springs: SpringSet) -> bool:
    """Whether any constant is given cell by cell."""
    return any(isinstance(value, tuple) for _, _, value in _numbers(springs))


def of_cells(value: Any, count: int) -> np.ndarray:
    """The value of each of `count` cells, (count,)."""
    return np.array(value, dtype=float).ravel() if isinstance(value, tuple) else np.full(count, float(value))


def of_cell(springs: SpringSet, row: int, column: int) -> SpringSet:
    """One cell's springs, all of them numbers; without those of edges."""
    return _mapped(
        springs.model_copy(update=dict.fromkeys(EDGES_OWN, 0.0)),
        lambda value, _: value[row][column] if isinstance(value, tuple) else value,
    )


def gathered(cells: Sequence[Sequence[SpringSet]]) -> SpringSet:
    """The springs of a lattice from those of its cells, rows from y0 to y1; one layer distance for all."""
    first = cells[0][0]
    found: dict[str, Any] = {"layer_distance": first.layer_distance}
    for name in SpringSet.model_fields:
        values = [[getattr(cell, name) for cell in row] for row in cells]
        if name in (*found, *EDGES_OWN):
            continue
        if any(isinstance(value, PerDirection) for row in values for value in row):
            x, y = (_table([[_along(value, axis) for value in row] for row in values]) for axis in "xy")
            found[name] = x if x == y else PerDirection(x=x, y=y)
        else:
            found[name] = _table(values)
    return SpringSet(**found)


def _along(value: Any, axis: str) -> Any:
    return getattr(value, axis) if isinstance(value, PerDirection) else value


def _table(values: list[list[float]]) -> float | tuple[tuple[float, ...], ...]:
    """Zero where all are zero."""
    return tuple(map(tuple, values)) if np.any(values) else 0.0


def cut(springs: SpringSet, rows: int, columns: int) -> SpringSet:
    """The springs of the first rows and columns of cells."""

    def part(value: Any, axis: str) -> Any:
        if not isinstance(value, tuple):
            return value
        if isinstance(value[0], tuple):
            return tuple(row[:columns] for row in value[:rows])
        return value[: rows if axis == "x" else columns]

    return _mapped(springs, part)


def require_cells(springs: SpringSet, grid: Grid, whose: str) -> None:
    """Raise BadInput for a table that is not one of the grid's cells. whose: how the message begins."""
    rows, columns = grid[1] - 1, grid[0] - 1
    along = {"x": (rows,), "y": (columns,)}
    for name, axis, value in _numbers(springs):
        if not isinstance(value, tuple):
            continue
        wanted = along[axis] if name in EDGES_OWN else (rows, columns)
        if _shape(value) != wanted:
            key = f"{name}.{axis}" if axis else name
            cells = " rows of ".join(map(str, wanted))
            raise BadInput(f"{whose}springs.{key}: {cells} cells are wanted on {grid[0]}x{grid[1]} masses")


def _shape(value: tuple[Any, ...]) -> tuple[int, ...] | None:
    """Rows and columns of a table, or the length of a list; None where rows differ in length."""
    if not value or not isinstance(value[0], tuple):
        return (len(value),)
    lengths = {len(row) for row in value}
    return (len(value), lengths.pop()) if len(lengths) == 1 else None


def _numbers(springs: SpringSet) -> list[tuple[str, str, Any]]:
    """(name, direction, value) of every constant; the direction is empty where there is one for all."""
    found = []
    for name, value in springs:
        if isinstance(value, PerDirection | Either):
            found += [(name, axis, getattr(value, axis)) for axis in "xy"]
        else:
            found.append((name, "", value))
    return found


def _mapped(springs: SpringSet, change: Any) -> SpringSet:
    """The springs with change(value, direction) for every constant."""
    changed: dict[str, Any] = {}
    for name, value in springs:
        if isinstance(value, PerDirection | Either):
            pair = {axis: change(getattr(value, axis), axis) for axis in "xy"}
            changed[name] = value.model_copy(update=pair)
        else:
            changed[name] = change(value, "")
    return springs.model_copy(update=changed)
