"""Counts, memory and durations in words."""

from __future__ import annotations

UNITS = ((1e12, "TB"), (1e9, "GB"), (1e6, "MB"))


def count(number: int) -> str:
    """Return a number of things."""
    return f"{number:,}".replace(",", " ") if number < 1_000_000 else f"{number / 1e6:.3g} million"


def memory(amount: float) -> str:
    """Return an amount of memory [bytes]."""
    unit, name = next(((unit, name) for unit, name in UNITS if amount >= unit), UNITS[-1])
    return f"{amount / unit:.2g} {name}" if amount < 100 * unit else f"{amount / unit:.0f} {name}"


def duration(seconds: float) -> str:
    """Return a time [s]."""
    if seconds < 90:
        return f"{seconds:.0f} s"
    return f"{seconds / 60:.0f} min" if seconds < 5400 else f"{seconds / 3600:.1f} h"
