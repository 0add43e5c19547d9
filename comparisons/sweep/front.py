"""Pareto front of error and time, cheapest rows within tolerances, and observed orders of convergence.

A row is on the Pareto front if no other row is as accurate in less time, or more accurate in as much time.
Errors below the reference's uncertainty cannot be distinguished and count as equal to it.
"""

from collections.abc import Sequence
from itertools import groupby
from math import isfinite

import numpy as np

from comparisons.sweep.model_error import left_for_grid
from sheetbench.scenes.language.summary import few, milliseconds

TOLERANCES = (0.05, 0.01, 0.001)
FLOOR_FACTOR = 3.0  # times the reference's uncertainty: smaller errors are not used for an order


def front(errors: Sequence[float | None], seconds: Sequence[float], floor: float = 0.0) -> list[int]:
    """Return the indices of the rows on the front, the quickest first, without rows of unknown error."""
    indices = [i for i, error in enumerate(errors) if error is not None and isfinite(error)]
    on_front: list[int] = []
    best = np.inf
    for i in sorted(indices, key=lambda i: (seconds[i], errors[i])):
        error = max(errors[i] or 0.0, floor)
        if error < best:
            on_front.append(i)
            best = error
    return on_front


def cheapest(
    names: Sequence[str],
    errors: Sequence[float | None],
    seconds: Sequence[float | None],
    per: str = "",
    bar: float = 0.0,
    model_error: float | None = None,
) -> list[str]:
    """Return a sentence per tolerance on the quickest row that is certainly within it.

    As in `advise`, a row's error, the reference's bar and model error (`comparisons.sweep.model_error`)
    together have to be within the tolerance.
    """
    rows = [(e, s, name) for e, s, name in zip(errors, seconds, names, strict=True) if e is not None and s]
    notes: dict[str, str] = {}
    for tolerance in TOLERANCES:
        within = [row for row in rows if row[0] + bar <= left_for_grid(tolerance, model_error)]
        if within:
            converged = (model_error or 0.0) >= tolerance
            error, time, name = min(within, key=lambda row: row[1])
            note = f"{name}, {few(100.0 * error)} % off in {milliseconds(time)}{per}."
            condition = " of a converged reference" if converged else ""
            notes.setdefault(note, f"Cheapest within {few(100.0 * tolerance)} %{condition}: {note}")
    return list(notes.values())


def order(x: Sequence[float], y: Sequence[float]) -> float | None:
    """Return the slope of log y over log x by least squares, None for fewer than two different positive x."""
    points = [(a, b) for a, b in zip(x, y, strict=True) if a > 0.0 and b > 0.0]
    if len({a for a, _ in points}) < 2:
        return None
    logs = np.log(points)
    return float(np.polyfit(logs[:, 0], logs[:, 1], 1)[0])


def error_order(
    sizes: Sequence[float | None], errors: Sequence[float | None], floor: float | None
) -> float | None:
    """Return the order of errors in a size, from errors well above the reference's uncertainty."""
    least = FLOOR_FACTOR * (floor or 0.0)
    points = [(h, e) for h, e in zip(sizes, errors, strict=True) if h and e is not None and e > least]
    return order([h for h, _ in points], [e for _, e in points])


def grouped(names: Sequence[str]) -> dict[str, list[int]]:
    """Return row numbers by name, in the order of first appearance."""
    numbered = sorted(range(len(names)), key=lambda i: (names.index(names[i]), i))
    return {name: list(rows) for name, rows in groupby(numbered, key=lambda i: names[i])}
