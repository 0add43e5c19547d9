"""Summaries of scenes and answers in a few lines, for a Python prompt."""

from collections.abc import Iterable, Mapping

import numpy as np

from sheetbench.errors import printable

WIDEST = 100  # characters of a value
ROUNDING = 1e-9  # of the largest force: equilibria are balanced to that


def text(title: str, facts: Iterable[tuple[str, str]]) -> str:
    """Return a heading and a line for each fact that is not empty."""
    rows = [(name, _short(value)) for name, value in facts if value]
    widest = max((len(name) for name, _ in rows), default=0)
    return "\n".join([printable(title), *(f"  {name:<{widest}}  {value}" for name, value in rows)])


def milliseconds(seconds: float) -> str:
    """Return a duration in words."""
    return f"{1e3 * seconds:.3g} ms" if seconds < 1.0 else f"{seconds:.3g} s"


def few(value: float, digits: int = 2) -> str:
    """Return a few digits of a number for a sentence, without an exponent from 0.001 to a million."""
    rounded = float(f"{value:.{digits}g}")
    shown = f"{rounded:.7g}" if 1e-3 <= abs(rounded) <= 1e6 else f"{value:.{digits}g}"
    return shown.replace("-", "−")


def without_rounding(forces: Mapping[str, np.ndarray]) -> dict[str, np.ndarray]:
    """Return forces (3,) [N] by name, with components that are rounding errors of the largest set to 0."""
    largest = max((float(np.abs(force).max()) for force in forces.values()), default=0.0)
    return {name: np.where(np.abs(f) > ROUNDING * largest, f, 0.0) for name, f in forces.items()}


def _short(value: str) -> str:
    value = printable(value)
    return value if len(value) <= WIDEST else f"{value[: WIDEST - 1]}…"
