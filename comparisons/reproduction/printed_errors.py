"""The printed error table computed again from the displacement tables it stands beside.

    error = | |u_model| − |u_experiment| | / n,    n = |u_experiment|, |u_model|, or the larger of the two

Magnitudes, as one printed sign is a misprint; 0 where neither moves. A printed cell belongs to a
normalisation if it has all its digits: rounded, or cut off after the last.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import floor
from typing import Annotated, Any

import numpy as np

from comparisons.reproduction.answers import SOURCES
from comparisons.reproduction.findings import Finding
from comparisons.reproduction.published import published_displacements, published_errors, published_inputs
from sheetbench.answers.table import PERCENT, Column, Table, percent

TEXT = (
    "|model − experiment| of the published tables, relative to the one and to the other, and to which "
    "of them the printed error is relative."
)
SHOWN = ("test", "component", "probe", "printed", "of_experiment", "of_model", "of", "digits")
PRINTED = 1e-3  # the last digit of a printed error, 0.1 %
_SLACK = 1e-6  # of that digit, for what decimals leave


@dataclass(frozen=True)
class Cell:
    """A printed error and what it would be of the experiment and of the model, as fractions."""

    test: int
    component: Annotated[str, Column("u")]
    probe: str
    printed: Annotated[float, PERCENT(".1f")]
    of_experiment: Annotated[float, PERCENT(".2f")]
    of_model: Annotated[float, PERCENT(".2f")]

    @property
    def of_larger(self) -> float:
        """What it would be of the larger of the two."""
        return min(self.of_experiment, self.of_model)

    @property
    def of(self) -> Annotated[str, Column("relative to")]:
        """Whose magnitude it is relative to: "both" where that makes no difference to its digits."""
        known = {"experiment": self.of_experiment, "model": self.of_model}
        found = [name for name, error in known.items() if _digits(error, self.printed)]
        return "both" if len(found) > 1 else "".join(found) or "neither"

    @property
    def digits(self) -> str:
        """How the error of the larger becomes the printed one: "rounded", "cut off", or "no"."""
        return _digits(self.of_larger, self.printed) or "no"


def cells() -> list[Cell]:
    """Return every printed error, in its order."""
    found, moved = [], published_displacements()
    for (test, component, probe), value in published_errors().items():
        model, experiment = (abs(moved[test, source, component, probe]) for source in SOURCES)
        both = (abs(model - experiment) / size if size else 0.0 for size in (experiment, model))
        found.append(Cell(test, component, probe, value, *both))
    return found


def _digits(computed: float, value: float) -> str:
    """How a computed error becomes the printed one, "" where it does not."""
    digit = round(value / PRINTED)
    if floor(computed / PRINTED + 0.5 + _SLACK) == digit:
        return "rounded"
    return "cut off" if floor(computed / PRINTED + _SLACK) == digit else ""


def findings(cells: list[Cell]) -> list[Finding]:
    """Return what the printed errors are relative to, and their mean beside the one that is quoted."""
    mean, digits = means(cells), [cell.digits for cell in cells]
    sentences = (
        f"{len(cells) - digits.count('no')} of {len(cells)} printed errors are the difference over the "
        f"larger of the two values, {digits.count('cut off')} of them cut off instead of rounded. "
        f"{sum(cell.of == 'model' for cell in cells)} are therefore relative to the model and not to the "
        f"experiment; relative to that throughout their mean is {percent(mean['of_experiment'], '.2f')}.",
        f"The printed errors have a mean of {percent(mean['printed'], '.2f')}; "
        f"{percent(published_inputs()['mean_error'])} is quoted.",
    )
    return [Finding("printed errors", sentence) for sentence in sentences]


def table(cells: list[Cell]) -> Table:
    """Return a row per printed error."""
    caption = "Printed errors, computed again"
    return Table.of(Cell, cells, caption, "errors", fields=SHOWN, grouped=True, text=TEXT)


def as_dict(cells: list[Cell]) -> dict[str, Any]:
    """Return the cells and their means for JSON."""
    shown = [{**vars(one), "of_larger": one.of_larger, "of": one.of, "digits": one.digits} for one in cells]
    return {"cells": shown, "means": {**means(cells), "quoted": published_inputs()["mean_error"]}}


def means(cells: list[Cell]) -> dict[str, float]:
    """The mean of the cells as printed, of the experiment, of the model, and of the larger of the two."""
    names = ("printed", "of_experiment", "of_model", "of_larger")
    return {name: float(np.mean([getattr(cell, name) for cell in cells])) for name in names}
