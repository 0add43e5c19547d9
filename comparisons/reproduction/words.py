"""Numbers of a reproduction in words, as its findings and tables say them."""

from __future__ import annotations

from sheetbench.answers.table import number, quantity


def percent(fraction: float, form: str = ".2g") -> str:
    """Return a fraction in per cent."""
    return f"{number(100.0 * fraction, form)} %"


def millimetres(length: float, form: str = ".2f") -> str:
    """Return a length [m]."""
    return quantity(length, "m", form)
