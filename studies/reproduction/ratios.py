"""Ratios between published entries beside those that a whole scan of sheets can show.

Between points, uz(P)/uz(Q); and of shortening against deflection, −u a/uz² at the free corner or free edge, a
the side: a strip that only bends, one way, has about 0.6 of its own length. As E (or a layer distance) runs
over its scan a ratio runs over a range, of those sheets on which both entries have the published sign. A
published ratio outside of it is met by none of them; between two neighbours of the scan that lie on either
side of it, it is met.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Annotated

import numpy as np

from comparisons.reproduction.published import SOURCES, published, scene
from sheetbench.answers.table import NUMBER, Column
from sheetbench.scenes.habibi import PROBES
from studies.reproduction.nearest import SOURCE, Scan
from studies.reproduction.sheets import RODS

Entry = tuple[str, int]  # a probe and a component


@dataclass(frozen=True)
class Ratio:
    """A ratio of a test as published, by source, and the least and the most of it over a scan of a kind of
    sheets; None where no sheet of the scan has both signs."""

    test: int
    sense: int
    name: Annotated[str, Column("ratio")]
    kind: Annotated[str, Column("of")]
    published: Annotated[dict[str, float], NUMBER(".3g")]
    least: Annotated[float | None, NUMBER(".3g")]
    most: Annotated[float | None, NUMBER(".3g")]

    @property
    def rod(self) -> str:
        """The sense of the rod in words."""
        return RODS[self.sense]

    @property
    def matches(self) -> Annotated[str, Column("met")]:
        """Which published tables have a ratio that a sheet of the scan has."""
        return " and ".join(source for source in SOURCES if self.met(source)) or "neither"

    def met(self, source: str) -> bool:
        """Whether the published ratio lies within the range."""
        if self.least is None or self.most is None:
            return False
        return self.least <= self.published[source] <= self.most


def ratios(scans: Sequence[Scan]) -> list[Ratio]:
    """Every ratio over every scan of one test."""
    return [ratio for one in scans if len(one.tests) == 1 for ratio in _of_scan(one)]


def _of_scan(one: Scan) -> list[Ratio]:
    (test,) = one.tests
    side = max(scene(test).sheet.lengths)
    tables = {source: published(test, source) for source in SOURCES}
    rows = []
    for name, of, to in _pairs(test):
        values = {source: _value(table, of, to, side) for source, table in tables.items()}
        signs = _signs(tables[SOURCE[one.kind]], of, to)
        range_ = [
            float(_value(moved, of, to, side))
            for moved in one.displacement
            if np.isfinite(moved).all() and _signs(moved, of, to) == signs
        ]
        least, most = min(range_, default=None), max(range_, default=None)
        rows.append(Ratio(test, one.sense, name, one.kind, values, least, most))
    return rows


def _pairs(test: int) -> list[tuple[str, Entry, Entry]]:
    """Names of the ratios of a test and their two entries; along x (or y) where of shortening."""
    points = (
        (("P4", "P1"), ("P4", "P2"), ("P2", "P1"))
        if test == 1
        else (("P3", "P1"), ("P4", "P2"), ("P4", "P3"))
    )
    named = [(f"uz({p})/uz({q})", (p, 2), (q, 2)) for p, q in points]
    free = "P4" if test == 1 else "P3"
    return [*named, (f"−ux({free})·a/uz({free})²", (free, 0), (free, 2))]


def _value(moved: np.ndarray, of: Entry, to: Entry, side: float) -> float:
    above, below = (moved[PROBES.index(probe), axis] for probe, axis in (of, to))
    return float(above / below) if of[1] == to[1] else float(-above * side / below**2)


def _signs(moved: np.ndarray, of: Entry, to: Entry) -> tuple[float, ...]:
    return tuple(float(np.sign(moved[PROBES.index(probe), axis])) for probe, axis in (of, to))
