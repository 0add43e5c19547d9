"""The printed error table computed again from the displacement tables it stands beside.

    error = | |u_model| − |u_experiment| | / n,    n = |u_experiment|, |u_model|, or the larger of the two

Magnitudes, as one printed sign is a misprint; 0 where neither moves. A printed cell belongs to a
normalisation if it has all its digits: rounded, or cut off after the last.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import floor
from typing import Any

import numpy as np

from comparisons.reproduction.answers import COMPONENTS, printed
from comparisons.reproduction.findings import Finding
from sheetbench.answers.habibi import PROBES, published_errors, published_inputs
from sheetbench.answers.table import PERCENT, Table, percent

TEXT = (
    "|model − experiment| of the published tables, relative to the one and to the other. * the printed error "
    "is not relative to the experiment: the normalisation changes there."
)
COLUMNS = (
    *("test", "u", "probe", PERCENT(".1f", "printed"), PERCENT(".2f", "of experiment")),
    *(PERCENT(".2f", "of model"), "relative to", "digits"),
)
PRINTED = 1e-3  # the last digit of a printed error, 0.1 %
_SLACK = 1e-6  # of that digit, for what decimals leave


@dataclass(frozen=True)
class Cell:
    """A printed error and what it would be of the experiment, of the model and of the larger of the two, as
    fractions; of: whose magnitude the printed one is relative to, "experiment", "model", "both" where that
    makes no difference to its digits, "neither"; digits: "rounded" or "cut off", "" where of neither;
    changes: whether it is relative to something else than the experiment, as an error is."""

    test: int
    component: str
    probe: str
    printed: float
    of_experiment: float
    of_model: float
    of_larger: float
    of: str
    digits: str

    @property
    def by_larger(self) -> bool:
        """Whether it is the difference over the larger of the two."""
        return bool(_digits(self.of_larger, self.printed))

    @property
    def changes(self) -> bool:
        """Whether the cell is not relative to the experiment."""
        return self.of not in ("experiment", "both")


def cells() -> list[Cell]:
    """Return every printed error, in its order."""
    found = []
    for (test, component, probe), value in published_errors().items():
        at = PROBES.index(probe), COMPONENTS.index(component)
        model, experiment = (abs(printed(test, source)[at]) for source in ("model", "experiment"))
        a, b, c = (
            abs(model - experiment) / size if size else 0.0
            for size in (experiment, model, max(model, experiment))
        )
        digits = [_digits(error, value) for error in (a, b, c)]
        of = {(True, True): "both", (True, False): "experiment", (False, True): "model"}
        whose = of.get((bool(digits[0]), bool(digits[1])), "neither")
        kept = next(filter(None, (digits[2], *digits)), "")
        found.append(Cell(test, component, probe, value, a, b, c, whose, kept))
    return found


def _digits(computed: float, value: float) -> str:
    """How a computed error becomes the printed one, "" where it does not."""
    digit = round(value / PRINTED)
    if floor(computed / PRINTED + 0.5 + _SLACK) == digit:
        return "rounded"
    return "cut off" if floor(computed / PRINTED + _SLACK) == digit else ""


def findings(cells: list[Cell]) -> list[Finding]:
    """Return what the printed errors are relative to, and their mean beside the one that is quoted."""
    mean, explained = means(cells), [cell for cell in cells if cell.by_larger]
    cut, changed = sum(cell.digits == "cut off" for cell in explained), sum(cell.changes for cell in cells)
    return [
        Finding(
            "printed errors",
            f"{len(explained)} of {len(cells)} printed errors are the difference over the larger of the two "
            f"values, {cut} of them cut off instead of rounded. {changed} are therefore relative to the "
            "model and not to the experiment; relative to the experiment throughout their mean is "
            f"{percent(mean['of_experiment'], '.2f')}.",
        ),
        Finding(
            "printed errors",
            f"The printed errors have a mean of {percent(mean['printed'], '.2f')}; "
            f"{percent(published_inputs()['mean_error'])} is quoted.",
        ),
    ]


def table(cells: list[Cell]) -> Table:
    """Return a row per printed error: of the experiment, of the model, whose magnitude it is relative to,
    with an asterisk where that is not the experiment, and how its digits follow."""
    rows = (
        (
            *(c.test, c.component, c.probe, c.printed, c.of_experiment, c.of_model),
            c.of + " *" * c.changes,
            c.digits or "no",
        )
        for c in cells
    )
    return Table.listed("Printed errors, computed again", COLUMNS, rows, "errors", grouped=True, text=TEXT)


def as_dict(cells: list[Cell]) -> dict[str, Any]:
    """Return the cells and their means for JSON."""
    quoted = published_inputs()["mean_error"]
    return {
        "cells": [{**vars(one), "changes": one.changes} for one in cells],
        "means": {**means(cells), "quoted": quoted},
    }


def means(cells: list[Cell]) -> dict[str, float]:
    """The mean of the cells as printed, of the experiment, of the model, and of the larger of the two."""
    names = ("printed", "of_experiment", "of_model", "of_larger")
    return {name: float(np.mean([getattr(cell, name) for cell in cells])) for name in names}
