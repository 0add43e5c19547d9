"""Plots of a page, drawn as SVG: readable without a script, in print, light and dark.

Series differ by colour (Okabe and Ito's, which the colour-blind tell apart), by marker and by dash. A script
says the values under the pointer, or under the point that arrow keys choose.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

from sheetbench.answers.table import number

WIDTH, HEIGHT = 720, 340
LEFT, RIGHT, TOP, BOTTOM = 66, 14, 12, 46
MOST = 1500  # points of a series that are drawn


@dataclass(frozen=True)
class Series:
    """Named points (x, y), joined by a line or not; labels: of the points, for the pointer."""

    name: str
    x: Sequence[float]
    y: Sequence[float]
    line: bool = True
    labels: Sequence[str] = ()


@dataclass(frozen=True)
class Axis:
    """What an axis measures, and whether in powers of ten."""

    label: str
    log: bool = False


@dataclass(frozen=True)
class Mark:
    """A number along an axis and where it stands [pixels]."""

    text: str
    at: float


@dataclass(frozen=True)
class Drawn:
    """A series ready for the page: number, the line's path, points (x, y) [pixels]."""

    number: int
    name: str
    path: str
    points: list[tuple[float, float]]
    dots: bool


@dataclass(frozen=True)
class Plot:
    """A plot: title, axes and series in the units of the axes' labels; text: a sentence under it."""

    title: str
    x: Axis
    y: Axis
    series: Sequence[Series]
    text: str = ""
    width: int = field(default=WIDTH, init=False)
    height: int = field(default=HEIGHT, init=False)

    @property
    def shown(self) -> list[Series]:
        """The series with the points that can be drawn, thinned out where they are very many."""
        kept = [_finite(series, self.x.log, self.y.log) for series in self.series]
        return [series for series in kept if series.x]

    @property
    def frame(self) -> dict[str, float]:
        """The rectangle of the data [pixels]."""
        return {"left": LEFT, "right": WIDTH - RIGHT, "top": TOP, "bottom": HEIGHT - BOTTOM}

    def marks(self) -> tuple[list[Mark], list[Mark]]:
        """Numbers along both axes."""
        x, y = self._spans()
        across = [(v, _place(v, x, self.x.log, LEFT, WIDTH - RIGHT)) for v in _ticks(x, self.x.log)]
        up = [(v, _place(v, y, self.y.log, HEIGHT - BOTTOM, TOP)) for v in _ticks(y, self.y.log)]
        return [Mark(_text(v), at) for v, at in across], [Mark(_text(v), at) for v, at in up]

    def drawn(self) -> list[Drawn]:
        """The series in pixels."""
        x, y = self._spans()
        found = []
        for n, series in enumerate(self.shown):
            points = [
                (
                    round(_place(a, x, self.x.log, LEFT, WIDTH - RIGHT), 1),
                    round(_place(b, y, self.y.log, HEIGHT - BOTTOM, TOP), 1),
                )
                for a, b in zip(series.x, series.y, strict=True)
            ]
            path = (
                "M" + "L".join(f"{a:g} {b:g}" for a, b in points) if series.line and len(points) > 1 else ""
            )
            found.append(Drawn(n % 6, series.name, path, points, not series.line or len(points) <= 40))
        return found

    def data(self) -> dict[str, Any]:
        """What the script needs to say values: names, labels, numbers as text, places in pixels."""
        drawn = self.drawn()
        return {
            "x": self.x.label,
            "y": self.y.label,
            "series": [
                {
                    "name": series.name,
                    "at": places.points,
                    "x": [number(value, ".4g") for value in series.x],
                    "y": [number(value, ".4g") for value in series.y],
                    "labels": list(series.labels),
                }
                for series, places in zip(self.shown, drawn, strict=True)
            ],
        }

    def in_words(self) -> str:
        """What a reader who does not see it is told."""
        names = ", ".join(series.name for series in self.shown)
        return f"{self.title}: {self.y.label} over {self.x.label}, of {names}. Arrow keys read the values."

    def _spans(self) -> tuple[tuple[float, float], tuple[float, float]]:
        xs = [value for series in self.shown for value in series.x]
        ys = [value for series in self.shown for value in series.y]
        return _span(xs, self.x.log), _span(ys, self.y.log)


def _finite(series: Series, log_x: bool, log_y: bool) -> Series:
    def fits(value: Any, log: bool) -> bool:
        return isinstance(value, int | float) and math.isfinite(value) and (value > 0 or not log)

    pairs = list(zip(series.x, series.y, strict=False))
    kept = [i for i, (x, y) in enumerate(pairs) if fits(x, log_x) and fits(y, log_y)]
    kept = kept[:: max(1, -(-len(kept) // MOST))]
    labels = [series.labels[i] for i in kept] if series.labels else []
    x, y = [float(series.x[i]) for i in kept], [float(series.y[i]) for i in kept]
    return Series(series.name, x, y, series.line, labels)


def _span(values: list[float], log: bool) -> tuple[float, float]:
    low, high = min(values, default=0.0), max(values, default=1.0)
    if log:
        return low / 1.5, high * 1.5
    margin = 0.05 * (high - low) or 0.5 * abs(high) or 1.0
    return low - margin, high + margin


def _place(value: float, span: tuple[float, float], log: bool, start: float, end: float) -> float:
    low, high = map(math.log, span) if log else span
    return start + (end - start) * ((math.log(value) if log else value) - low) / (high - low)


def _ticks(span: tuple[float, float], log: bool) -> list[float]:
    low, high = span
    if log:
        powers = range(math.floor(math.log10(low)), math.ceil(math.log10(high)) + 1)
        factors = (1,) if len(powers) > 4 else (1, 3) if len(powers) > 3 else (1, 2, 5)
        return [f * 10.0**p for p in powers for f in factors if low <= f * 10.0**p <= high]
    power = 10.0 ** math.floor(math.log10((high - low) / 6))
    step = next(power * f for f in (1, 2, 5, 10) if (high - low) / (power * f) <= 6)
    return [i * step for i in range(math.ceil(low / step), math.floor(high / step) + 1)]


def _text(value: float) -> str:
    return number(float(f"{value:.6g}"), "g")
