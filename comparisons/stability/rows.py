"""Rows of a map: a cell, how it ended, how far it is off."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

Row = dict[str, Any]
Cell = dict[str, Any]
LARGE = 0.05  # an error that has to be explained
FAULTS = {"failed": "a fault of the program", "lost": "lost"}  # and no verdict on the model
KEYS = {"grid": "cells", "damping": "damping_ratio", "time-step": "step"}  # else factor


def verdict(row: Row) -> str:
    """Return how a cell ended: holds, off by more than `LARGE`, refuses, fails, or by one of `FAULTS`."""
    if row["status"] == "converged":
        return "off" if (row["error"] or 0.0) > LARGE else "holds"
    if row["status"] in FAULTS:
        return FAULTS[row["status"]]
    return "refuses" if row["status"] in ("refused", "strain-outside-model") else "fails"


def place(row: Row) -> Any:
    """Where a cell lies on what is varied."""
    return row["cell"][KEYS.get(row["study"], "factor")]


def who(row: Row) -> str:
    """Return the model or integrator of a cell."""
    return str(row["cell"].get("model") or row["cell"]["integrator"])


def broken(rows: Iterable[Row]) -> list[str]:
    """Return a sentence for every row without an answer."""
    lost = (row for row in rows if row["status"] in FAULTS)
    return [f"{r['study']} {r['cell']}: {verdict(r)}: {r['message']}" for r in lost]


def percent(error: float | None) -> str:
    """Return an error as it stands in a map or a text, in percent and without the sign."""
    if error is None:
        return ""
    if error < 5e-5:
        return "< 0.01"
    if error >= 1.0:
        return f"{100 * error:.0f}"
    return f"{100 * error:.2f}" if error < 0.01 else f"{100 * error:.2g}"
