"""What a study is, and its cells carried out through a campaign: a row each."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace
from typing import Unpack

from matplotlib.figure import Figure

from comparisons.models.grading import parse_grading
from comparisons.models.sizes import require_room
from comparisons.models.spec import GradingLike, Lattice
from comparisons.runs.campaign import CampaignKeywords, Run, carry_out
from comparisons.runs.store import Finished, Store
from comparisons.stability.rows import Cell, Row
from sheetbench.answers.table import Column
from sheetbench.errors import BadInput
from sheetbench.scenes import load


@dataclass(frozen=True)
class Study:
    """cells: of the default map, or of the full one; measure: a task (`comparisons.runs.campaign`), called
    with a cell as keyword arguments, that returns its row; columns: of the table, each named by a key of the
    cell or of the row; draw: the map onto an empty figure; says: what is varied, what the boundary is;
    graded: whether its cells take a grading of the lattice.

    A row has a status and, where there is a reference, the error against it as a fraction.
    """

    name: str
    title: str
    says: str
    cells: Callable[[bool], list[Cell]]
    measure: str
    columns: dict[str, Column]
    draw: Callable[[Figure, list[Row]], None]
    size: tuple[float, float] = (7.2, 3.4)
    graded: bool = False


def columns(**forms: str | Column) -> dict[str, Column]:
    """Return columns by keys of the cell or the row, from a number's format, "" for words, or a column
    without a name."""
    made = {key: Column(form=form) if isinstance(form, str) else form for key, form in forms.items()}
    return {key: replace(column, name=key.replace("_", " ")) for key, column in made.items()}


def survey(
    studies: Iterable[Study],
    store: Store,
    *,
    full: bool = False,
    grading: GradingLike = None,
    large: bool = False,
    **how: Unpack[CampaignKeywords],
) -> list[Row]:
    """Return a row per cell of every study, in order; cells that the store has are not measured again.

    full: every cell, the long ones too. grading: of the lattices of the studies whose cells take one. A cell
    that raises is a row with its status (`refused`, `failed` or, where it took its process down, `lost`).
    Raises BadInput, before the first is measured, for a grading that is none or that no study takes, and
    unless `large` for cells that take more memory than there is.
    """
    graded = parse_grading(grading)
    own = {} if graded is None else Lattice(grading=graded).settings
    queue = [(s, cell | own if s.graded else cell) for s in studies for cell in s.cells(full)]
    if own and not any("grading" in cell for _, cell in queue):
        raise BadInput(f"grading = {grading}: none of these studies has lattices to grade")
    masses = max((cell["masses"] for _, cell in queue if "masses" in cell), default=0)
    if masses and not large:  # the cells without are small
        require_room(load("one-edge-clamped"), Lattice((masses, masses)), instead="leave --full out")
    runs = [Run(study.measure, cell, f"{study.name}: {in_words(cell)}") for study, cell in queue]
    outcomes = carry_out(runs, store, **how)
    return [_row(study, cell, outcome) for (study, cell), outcome in zip(queue, outcomes, strict=True)]


def _row(study: Study, cell: Cell, outcome: Finished) -> Row:
    """Return a cell's row: what was measured, with the keys that every row has."""
    every: Row = {"error": None, "iterations": None, "seconds": outcome.seconds, "snaps": []}
    fixed = {"study": study.name, "cell": cell, "status": outcome.status, "message": outcome.message}
    return {**every, **outcome.row, **fixed}


def in_words(cell: Cell) -> str:
    """Return a cell's keys and values."""
    return ", ".join(f"{k} {v:g}" if isinstance(v, float) else f"{k} {v}" for k, v in cell.items())
