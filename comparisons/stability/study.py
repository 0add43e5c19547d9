"""What a study is: cells to measure, one row each, and how to draw, tabulate and explain them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from matplotlib.figure import Figure

from comparisons.report.table import Column

Row = dict[str, Any]
Cell = dict[str, Any]
LARGE = 0.05  # an error that has to be explained


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


def doubtful(row: Row) -> bool:
    """Whether a row is converged and still off by more than LARGE."""
    return row["status"] == "converged" and row.get("error") is not None and row["error"] > LARGE


def percent(error: float | None) -> str:
    """An error as it stands in a map or a text, in percent and without the sign."""
    if error is None:
        return ""
    if error < 5e-5:
        return "0"
    if error >= 1.0:
        return f"{100 * error:.0f}"
    return f"{100 * error:.2f}" if error < 0.01 else f"{100 * error:.2g}"
