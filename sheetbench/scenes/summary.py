"""Answers in a few lines, as they stand at a Python prompt, and the same as HTML for notebooks."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterable, Mapping, Sequence
from html import escape
from typing import Any

from sheetbench.errors import printable

WIDEST = 100  # characters of a value
ROUNDING = 1e-9  # of the largest force: equilibria are balanced to that
Facts = Iterable[tuple[str, str]]


class Summarised(ABC):
    """Base of answers, which show what matters of them instead of every number that they hold."""

    @abstractmethod
    def _summary(self) -> tuple[str, Facts]:
        """A heading, and facts by name."""

    def __repr__(self) -> str:
        return text(*self._summary())

    def _repr_html_(self) -> str:
        return html(*self._summary())


def text(title: str, facts: Facts) -> str:
    """A heading and a line for each fact that has something to say."""
    rows = [(name, _short(value)) for name, value in facts if value]
    widest = max((len(name) for name, _ in rows), default=0)
    return "\n".join([printable(title), *(f"  {name:<{widest}}  {value}" for name, value in rows)])


def html(title: str, facts: Facts) -> str:
    """The same as a small table."""
    rows = "".join(
        f'<tr><th style="text-align:left">{escape(name)}</th>'
        f'<td style="text-align:left">{escape(_short(value))}</td></tr>'
        for name, value in facts
        if value
    )
    return f"<b>{escape(printable(title))}</b><table>{rows}</table>"


def milliseconds(seconds: float) -> str:
    """A duration in words."""
    return f"{1e3 * seconds:.3g} ms" if seconds < 1.0 else f"{seconds:.3g} s"


def few(value: float, digits: int = 2) -> str:
    """A few digits of a number in a sentence; without an exponent from 0.001 to a million."""
    rounded = float(f"{value:.{digits}g}")
    return f"{rounded:.7g}" if 1e-3 <= abs(rounded) <= 1e6 else f"{value:.{digits}g}"


def forces(named: Mapping[str, Any]) -> str:
    """Forces (3,) [N] by name; what is rounding beside the largest of them is 0."""
    largest = max((abs(float(part)) for force in named.values() for part in force), default=0.0)

    def shown(part: float) -> str:
        return f"{part:.3g}" if abs(part) > ROUNDING * largest else "0"

    return ", ".join(f"{name} ({', '.join(map(shown, force))}) N" for name, force in named.items())


def energies(named: Mapping[str, float]) -> str:
    """Energies [J] by name."""
    return ", ".join(f"{name} {value:.4g} J" for name, value in named.items())


def numbers(values: Sequence[float], unit: str, shown: int = 5) -> str:
    """The first numbers of a list."""
    more = ", …" if len(values) > shown else ""
    return f"{', '.join(f'{value:.4g}' for value in values[:shown])}{more} {unit}"


def _short(value: str) -> str:
    value = printable(value)
    return value if len(value) <= WIDEST else f"{value[: WIDEST - 1]}…"
