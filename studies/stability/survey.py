"""The cells of studies carried out through a campaign, and their rows."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Unpack

from comparisons.models.grading import parse_grading
from comparisons.models.sizes import require_room
from comparisons.models.spec import GradingLike, Lattice
from comparisons.runs.campaign import CampaignKeywords, Run, carry_out
from comparisons.runs.store import Finished, Store
from comparisons.stability.rows import Row
from sheetbench.errors import BadInput
from sheetbench.scenes import load
from studies.stability.study import Study


def survey(
    studies: Iterable[Study],
    store: Store,
    *,
    full: bool = False,
    grading: GradingLike = None,
    large: bool = False,
    **how: Unpack[CampaignKeywords],
) -> list[Row]:
    """A row per cell of every study, in order; cells that the store has are not measured again.

    full: every cell, the long ones too. grading: of the lattices of the studies whose cells take one.
    A cell that raises is a row with its status (`refused`,
    `failed` or, where it took its process down, `lost`). Raises BadInput, before the first is measured, for a
    grading that is none or that no study takes, and unless `large` for cells that take more memory than there
    is.
    """
    graded = parse_grading(grading)
    own = {} if graded is None else Lattice(grading=graded).settings
    queue = [(s, cell | own if s.graded else cell) for s in studies for cell in s.cells(full)]
    if own and not any("grading" in cell for _, cell in queue):
        raise BadInput(f"grading = {grading}: none of these studies has lattices to grade")
    if not large:
        _require_room([cell["masses"] for _, cell in queue if "masses" in cell])
    runs = [Run(study.measure, cell, f"{study.name} {_short(cell)}") for study, cell in queue]
    outcomes = carry_out(runs, store, **how)
    return [row(study, cell, outcome) for (study, cell), outcome in zip(queue, outcomes, strict=True)]


def _require_room(masses: Sequence[int]) -> None:
    """Of the lattices of cells with so many masses a side; the other cells are small."""
    if masses:
        finest = Lattice((max(masses), max(masses)))
        require_room(load("one-edge-clamped"), finest, instead="leave --full out")


def row(study: Study, cell: dict, outcome: Finished) -> Row:
    """A cell's row: what was found, with the keys that every row has."""
    every: Row = {"error": None, "iterations": None, "seconds": outcome.seconds, "snaps": []}
    fixed = {"study": study.name, "cell": cell, "status": outcome.status, "message": outcome.message}
    return {**every, **outcome.row, **fixed}


def _short(cell: dict) -> str:
    return " ".join(
        f"{key}={value:g}" if isinstance(value, float) else f"{key}={value}" for key, value in cell.items()
    )
