"""The published error table, recomputed from the published displacement tables.

    error = | |u_model| − |u_experiment| | / n,    n = |u_experiment|, |u_model|, or the larger of the two

Magnitudes are compared, because one printed sign is a misprint; the error is 0 if both are 0. A printed value
matches a normalisation if all its digits agree, rounded or cut off.
"""

from dataclasses import dataclass
from math import floor
from typing import Annotated, Any

import numpy as np

from sheetbench.answers.table import PERCENT, Column, Table, percent
from studies.reproduction.answers import SOURCES
from studies.reproduction.findings import Finding
from studies.reproduction.published import published_displacements, published_errors, published_inputs

TEXT = (
    "|model − experiment| of the published tables, relative to the one and to the other, and to which "
    "of them the printed error is relative."
)
SHOWN = ("test", "component", "probe", "printed", "of_experiment", "of_model", "of", "digits")
PRINTED = 1e-3  # the last digit of a printed error, 0.1 %
_SLACK = 1e-6  # of that digit, for rounding of decimals


@dataclass(frozen=True)
class Cell:
    """A printed error and the errors relative to the experiment and to the model, as fractions."""

    test: int
    component: Annotated[str, Column("u")]
    probe: str
    printed: Annotated[float, PERCENT(".1f")]
    of_experiment: Annotated[float, PERCENT(".2f")]
    of_model: Annotated[float, PERCENT(".2f")]

    @property
    def of_larger(self) -> float:
        """Error relative to the larger of both magnitudes."""
        return min(self.of_experiment, self.of_model)

    @property
    def of(self) -> Annotated[str, Column("relative to")]:
        """Source of the normalisation, "both" if either gives the printed digits, else "neither"."""
        errors = {"experiment": self.of_experiment, "model": self.of_model}
        matching = [name for name, error in errors.items() if _digits(error, self.printed)]
        return "both" if len(matching) > 1 else "".join(matching) or "neither"

    @property
    def digits(self) -> str:
        """Conversion of `of_larger` to the printed digits: "rounded", "cut off", or "no" for none."""
        return _digits(self.of_larger, self.printed) or "no"


def cells() -> list[Cell]:
    """Return every printed error, in the published order."""
    out, displacements = [], published_displacements()
    for (test, component, probe), value in published_errors().items():
        model, experiment = (abs(displacements[test, source, component, probe]) for source in SOURCES)
        errors = (abs(model - experiment) / size if size else 0.0 for size in (experiment, model))
        out.append(Cell(test, component, probe, value, *errors))
    return out


def _digits(computed: float, value: float) -> str:
    """Return the conversion of a computed error to the printed digits, "" if they differ."""
    digit = round(value / PRINTED)
    if floor(computed / PRINTED + 0.5 + _SLACK) == digit:
        return "rounded"
    return "cut off" if floor(computed / PRINTED + _SLACK) == digit else ""


def findings(cells: list[Cell]) -> list[Finding]:
    """Return findings on the normalisation of the printed errors, and on their mean and the quoted one."""
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
    """Return a table with a row per printed error."""
    caption = "Printed errors, computed again"
    return Table.of(Cell, cells, caption, "errors", fields=SHOWN, grouped=True, text=TEXT)


def as_dict(cells: list[Cell]) -> dict[str, Any]:
    """Return the cells and their means as JSON data."""
    rows = [{**vars(c), "of_larger": c.of_larger, "of": c.of, "digits": c.digits} for c in cells]
    return {"cells": rows, "means": {**means(cells), "quoted": published_inputs()["mean_error"]}}


def means(cells: list[Cell]) -> dict[str, float]:
    """Return the means of the printed errors and of the errors by each normalisation."""
    names = ("printed", "of_experiment", "of_model", "of_larger")
    return {name: float(np.mean([getattr(cell, name) for cell in cells])) for name in names}
