"""Rows of a stability map: a cell, the status of its run, its error."""

from collections.abc import Iterable
from typing import Any

Row = dict[str, Any]
Cell = dict[str, Any]
LARGE = 0.05  # limit of the error of a model that holds
FAULTS = {"failed": "a fault of the program", "lost": "lost"}  # statuses without a verdict on the model
KEYS = {"grid": "cells", "damping": "damping_ratio", "time-step": "step"}  # other studies: "factor"


def verdict(row: Row) -> str:
    """Return the verdict on a cell: holds, off (error above LARGE), refuses, fails, or one of FAULTS."""
    if row["status"] == "converged":
        return "off" if (row["error"] or 0.0) > LARGE else "holds"
    if row["status"] in FAULTS:
        return FAULTS[row["status"]]
    return "refuses" if row["status"] in ("refused", "strain-outside-model") else "fails"


def place(row: Row) -> Any:
    """Return the value of a cell's varied parameter."""
    return row["cell"][KEYS.get(row["study"], "factor")]


def label_of(row: Row) -> str:
    """Return the model or integrator of a cell."""
    return str(row["cell"].get("model") or row["cell"]["integrator"])


def fault_sentences(rows: Iterable[Row]) -> list[str]:
    """Return a sentence for every row that ended by one of FAULTS."""
    lost = (row for row in rows if row["status"] in FAULTS)
    return [f"{r['study']} {r['cell']}: {verdict(r)}: {r['message']}" for r in lost]


def percent(error: float | None) -> str:
    """Return an error as text in percent, without the sign %."""
    if error is None:
        return ""
    if error < 5e-5:
        return "< 0.01"
    if error >= 1.0:
        return f"{100 * error:.0f}"
    return f"{100 * error:.2f}" if error < 0.01 else f"{100 * error:.2g}"
