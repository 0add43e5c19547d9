"""What a study is: cells to measure, one row each, and how to draw, tabulate and explain them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from matplotlib.figure import Figure

from comparisons.stability.rows import Cell, Row
from sheetbench.answers.table import Column


@dataclass(frozen=True)
class Study:
    """cells: of the default map, or of the full one; measure: a task (see `comparisons.runs.tasks`), called
    with a cell as keyword arguments and answering with its row; columns: for the table, named like keys of
    the cell or of the row; draw: the map onto an empty figure; says: what is varied, what the boundary is;
    graded: whether its cells take a grading of the lattice.

    A row has a status and, where there is a reference, the error against it as a fraction.
    """

    name: str
    title: str
    says: str
    cells: Callable[[bool], list[Cell]]
    measure: str
    columns: tuple[Column, ...]
    draw: Callable[[Figure, list[Row]], None]
    size: tuple[float, float] = (7.2, 3.4)
    graded: bool = False
