"""Distances between points of the sheet, as published and as a sheet can have them.

Any two points of the flat sheet are joined by a straight line of its material, of length s. With c their
published distance,

    c > s    that line is stretched by c/s − 1 at least, on average;
    c < s    if it keeps its length, its directions span an angle of 2 arccos(c/s) at least: all of them lie
             within half of it from their bisector, on which the line has s cos(half) or more.

No material, support or load enters, only that the sheet is whole. Of a clamped or bent edge the points beside
the probes are known where it is in its place, those of the rod from its curvature and either sense. c is
taken at the end of what the printed digits allow that makes each statement the weaker.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import combinations
from math import acos
from typing import Annotated, NamedTuple

import numpy as np

from comparisons.reproduction.published import DIGIT, SOURCES, published, scene
from sheetbench.answers.table import MILLIMETRES, PERCENT, Column, Unit
from sheetbench.scenes import EDGES
from sheetbench.scenes.kinematics import bent_or_tilted
from studies.reproduction.sheets import RODS


@dataclass(frozen=True)
class Chord:
    """Two points by name, their distance on the flat sheet and as published [m], the stretch that this asks
    for, at least (0 where none), and the angle that directions on the line between them span, at least [rad].
    sense: of the rod that holds the first, or 0."""

    test: int
    source: Annotated[str, Column("table")]
    start: Annotated[str, Column("from")]
    end: Annotated[str, Column("to")]
    flat: Annotated[float, MILLIMETRES("z.2f")]
    published: Annotated[float, MILLIMETRES("z.2f")]
    stretch: float
    turning: float
    sense: int

    @property
    def rod(self) -> str:
        """The sense of the rod in words."""
        return RODS[self.sense]

    @property
    def least_stretch(self) -> Annotated[float | None, PERCENT(".2f", "stretch ≥")]:
        """The stretch, None without."""
        return self.stretch or None

    @property
    def least_span(self) -> Annotated[float | None, Unit("rad", "°", 180.0 / np.pi)(".0f", "span ≥")]:
        """The angle that directions span, None without."""
        return self.turning or None


def chords() -> list[Chord]:
    """Every two probes, and every probe with the point straight across on each supported edge."""
    return [chord for test in (1, 2) for source in SOURCES for chord in of_table(test, source)]


class Point(NamedTuple):
    """Where a point lies on the flat sheet and where it is (3,) [m], and how far that may be from what is
    printed."""

    name: str
    flat: np.ndarray
    moved: np.ndarray
    digits: np.ndarray


def of_table(test: int, source: str, table: np.ndarray | None = None) -> list[Chord]:
    """The chords of a test's published displacements, or of others in their place, (4, 3) [m]."""
    moved = published(test, source) if table is None else table
    probed = scene(test)
    flat = np.column_stack([probed.probe_points(), np.zeros(len(moved))])
    digits = np.where(np.isfinite(moved), 0.5 * DIGIT, 0.0)
    probes = [Point(*of) for of in zip(probed.probes, flat, flat + moved, digits, strict=True)]
    pairs = [(start, end, 0) for start, end in combinations(probes, 2)]
    for sense in (1, -1) if test == 2 else (0,):
        here = scene(test, sense or 1)
        rods = {rod.edge: rod for rod in bent_or_tilted(here.supports, here.sheet)}
        for support in here.supports:
            edge, rod = EDGES[support.edge], rods.get(support.edge)
            at = flat.copy()
            at[:, edge.normal_axis] = here.sheet.lengths[edge.normal_axis] if edge.far_end else 0.0
            stays = np.zeros_like(at) if rod is None else rod.placed(at[:, :2]).displacement
            for probe, place, shift in zip(probes, at, stays, strict=True):
                turned = bool(shift.any())
                if turned or sense != -1:
                    held = Point(f"{support.edge} beside {probe.name}", place, place + shift, np.zeros(3))
                    pairs.append((held, probe, sense if turned else 0))
    chords = [_chord(test, source, *pair) for pair in pairs]
    return [chord for chord in chords if np.isfinite(chord.published)]


def nearer(of: Chord, moved: np.ndarray) -> float:
    """By how much the two points are nearer to each other than on the flat sheet [m], the probes moved by (4,
    3) [m]."""
    ends = (of.start, of.end, of.sense)
    same = next(c for c in of_table(of.test, of.source, moved) if (c.start, c.end, c.sense) == ends)
    return same.flat - same.published


def _chord(test: int, source: str, start: Point, end: Point, sense: int) -> Chord:
    offset, digits = np.abs(end.moved - start.moved), start.digits + end.digits
    flat = float(np.linalg.norm(end.flat - start.flat))
    least = float(np.linalg.norm(np.maximum(offset - digits, 0.0)))
    most = float(np.linalg.norm(offset + digits))
    return Chord(
        test=test,
        source=source,
        start=start.name,
        end=end.name,
        flat=flat,
        published=float(np.linalg.norm(offset)),
        stretch=max(least / flat - 1.0, 0.0),
        turning=2.0 * acos(min(most / flat, 1.0)),
        sense=sense,
    )
