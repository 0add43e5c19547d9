"""Rows of a table of measurements that do not fit while the others do: typing slips, lost markers.

The row farthest off is left out and the fit made again from where it was; it is named if it is then FAR times
the others' standard deviation off. Up to MOST rows are tried in turn, one in FEWEST at most.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from comparisons.identification.fit import Fit, Nearest
from comparisons.identification.measurements import MOVED, Displacements

SUSPECT = 5.0  # times the residuals' standard deviation, judged by their median: a row that is looked at
FAR = 8.0  # times the others' standard deviation
MOST = 3  # rows
FEWEST = 8  # rows for each that may be left out: fewer do not tell what is usual
NORMAL = 1.4826  # standard deviation over the median of |noise|, of normal noise


@dataclass(frozen=True)
class Outlier:
    """A row that does not fit: its number, its name, its component that is farthest off, that component as
    measured and as the fit of all other rows has it [m]."""

    row: int
    name: str
    component: str
    measured: float
    fitted: float

    def __str__(self) -> str:
        return (
            f"{self.name}: {self.component} = {self.measured:g} m, but {self.fitted:.4g} m by the fit of the "
            "other rows"
        )


def outliers(fit: Fit, best: Nearest) -> tuple[Outlier, ...]:
    """Return the rows that do not fit, beside the best search of all rows; none of a surface."""
    measured = fit.measured
    if not isinstance(measured, Displacements):
        return ()
    residuals, x = fit.per_point(best.residuals), best.x
    rows: list[int] = []
    found: tuple[Outlier, ...] = ()
    while len(rows) < min(MOST, len(residuals) // FEWEST):
        rest = np.abs(np.delete(residuals, rows, axis=0))
        rest = rest[np.isfinite(rest)]
        if rest.max() <= SUSPECT * NORMAL * np.median(rest):
            break
        size = np.nan_to_num(np.abs(residuals)).max(axis=1)
        size[rows] = 0.0
        rows.append(int(np.argmax(size)))
        x = replace(fit, measured=measured.without(rows)).search(x).x
        residuals = fit.per_point(fit.at(x)[0])
        spread = float(np.nanstd(np.delete(residuals, rows, axis=0)))
        if np.nan_to_num(np.abs(residuals[rows])).max(axis=1).min() > FAR * spread:
            found = tuple(_named(measured, residuals, row) for row in rows)
    return found


def _named(measured: Displacements, residuals: np.ndarray, row: int) -> Outlier:
    worst = int(np.argmax(np.nan_to_num(np.abs(residuals[row]))))
    value = float(measured.displacement[row, worst])
    return Outlier(row, measured.name_of(row), MOVED[worst], value, value + float(residuals[row, worst]))
