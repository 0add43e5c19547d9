"""Progress of work: its description, size and completed fraction; amounts as text."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from time import perf_counter
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from sheetbench.answers.size import Size

UNITS = ((1e12, "TB"), (1e9, "GB"), (1e6, "MB"))


def count(number: int) -> str:
    """Return a count as text."""
    return f"{number:,}".replace(",", " ") if number < 1_000_000 else f"{number / 1e6:.3g} million"


def memory(amount: float) -> str:
    """Return an amount of memory [bytes] as text."""
    unit, name = next(((unit, name) for unit, name in UNITS if amount >= unit), UNITS[-1])
    return f"{amount / unit:.2g} {name}" if amount < 100 * unit else f"{amount / unit:.0f} {name}"


def duration(seconds: float) -> str:
    """Return a time [s] as text."""
    if seconds < 90:
        return f"{seconds:.0f} s"
    return f"{seconds / 60:.0f} min" if seconds < 5400 else f"{seconds / 3600:.1f} h"


Progress = Callable[["Work | str"], None]
LONG = 2.0  # s: longer work is announced


@dataclass(frozen=True)
class Work:
    """Work in progress; doing: as "solving shell"; size: if known; share: current fraction of the load, None
    before the first iteration."""

    doing: str
    size: Size | None = None
    share: float | None = None

    @property
    def long(self) -> bool:
        """Whether the expected time is at least LONG."""
        return self.size is not None and self.size.seconds >= LONG

    @property
    def at_once(self) -> bool:
        """Whether progress is printed without a terminal too: for long work, at its start."""
        return self.long and self.share is None

    def at(self, share: float) -> Work:
        """Return the work with another completed fraction."""
        return replace(self, share=share)

    def __str__(self) -> str:
        size = ""
        if self.size is not None and self.long:
            size = f" ({count(self.size.unknowns)} unknowns, about {duration(self.size.seconds)})"
        if self.share is None:
            return f"{self.doing}{size} …"
        if self.share > 1.0:  # an iteration of a path that turns back
            return f"{self.doing}{size}: following its path beyond the load"
        return f"{self.doing}{size}: {100.0 * self.share:.0f} % of the load"


class Pace:
    """Remaining time of work that advances at a constant rate; end: its end, in any unit."""

    def __init__(self, end: float) -> None:
        self._end = end
        self._first: tuple[float, float] | None = None

    def remaining(self, reached: float) -> str:
        """Return the remaining time as text after a comma, "" while it is unknown."""
        now = perf_counter()
        start_time, start = self._first = self._first or (now, reached)
        if not reached > start:
            return ""
        return f", {duration((now - start_time) * (self._end - reached) / (reached - start))} left"


class _Silent:
    """A progress function that does nothing; a class, for help() to show its name, not an address."""

    def __call__(self, what: object) -> None:
        pass

    def __repr__(self) -> str:
        return "silent"


silent = _Silent()
