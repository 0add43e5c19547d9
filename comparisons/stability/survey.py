"""The cells of studies carried out through a campaign, and their rows."""

from __future__ import annotations

from collections.abc import Callable, Iterable

from comparisons.runs.campaign import Progress, Run, carry_out
from comparisons.runs.executors import Pool, processes
from comparisons.runs.store import Finished, Store
from comparisons.stability.study import Row, Study


def survey(
    studies: Iterable[Study],
    store: Store,
    *,
    full: bool = False,
    workers: int = 1,
    pool: Pool = processes,
    retry: bool = False,
    progress: Callable[[Progress], None] = lambda progress: None,
) -> list[Row]:
    """A row per cell of every study, in order; cells that the store has are not measured again.

    full: every cell, the long ones too. retry: what failed or was lost before is measured again. A cell that
    raises is a row with its status (`refused`, `failed` or, where it took its process down, `lost`).
    """
    asked = [(study, cell) for study in studies for cell in study.cells(full)]
    runs = [Run(study.measure, cell, f"{study.name} {_short(cell)}") for study, cell in asked]
    outcomes = carry_out(runs, store, workers=workers, pool=pool, retry=retry, progress=progress)
    return [row(study, cell, outcome) for (study, cell), outcome in zip(asked, outcomes, strict=True)]


def row(study: Study, cell: dict, outcome: Finished) -> Row:
    """A cell's row: what was found, with the keys that every row has."""
    every: Row = {"error": None, "iterations": None, "seconds": outcome.seconds, "snaps": []}
    fixed = {"study": study.name, "cell": cell, "status": outcome.status, "message": outcome.message}
    return {**every, **outcome.row, **fixed}


def _short(cell: dict) -> str:
    return " ".join(
        f"{key}={value:g}" if isinstance(value, float) else f"{key}={value}" for key, value in cell.items()
    )
