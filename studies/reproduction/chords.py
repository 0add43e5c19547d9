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

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations
from math import acos

import numpy as np

from comparisons.reproduction.published import DIGIT, SOURCES, published, scene
from sheetbench.scenes import EDGES
from sheetbench.scenes.kinematics import bent_or_tilted


@dataclass(frozen=True)
class Chord:
    """Two points by name, their distance on the flat sheet and as published [m], the stretch that this asks
    for, at least (0 where none), and the angle that directions on the line between them span, at least [rad].
    sense: of the rod that holds the first, or 0."""

    test: int
    source: str
    start: str
    end: str
    flat: float
    published: float
    stretch: float
    turning: float
    sense: int


def chords() -> list[Chord]:
    """Every two probes, and every probe with the point straight across on each supported edge."""
    return [chord for test in (1, 2) for source in SOURCES for chord in of_table(test, source)]


def of_table(test: int, source: str, table: np.ndarray | None = None) -> list[Chord]:
    """The chords of a test's published displacements, or of others in their place, (4, 3) [m]."""
    moved = published(test, source) if table is None else table
    posed = scene(test)
    names, flat = list(posed.probes), np.column_stack([posed.probe_points(), np.zeros(len(moved))])
    digits = np.where(np.isfinite(moved), 0.5 * DIGIT, 0.0)
    chords = []
    for i, j in combinations(range(len(names)), 2):
        ends = (flat[i] + moved[i], flat[j] + moved[j])
        chords.append(
            _chord(test, source, (names[i], names[j]), (flat[i], flat[j]), ends, digits[i] + digits[j])
        )
    for sense in (1, -1) if test == 2 else (0,):
        here = scene(test, sense or 1)
        rods = {rod.edge: rod for rod in bent_or_tilted(here.supports, here.sheet)}
        for support in here.supports:
            edge = EDGES[support.edge]
            at = flat.copy()
            at[:, edge.normal_axis] = here.sheet.lengths[edge.normal_axis] if edge.far_end else 0.0
            rod = rods.get(support.edge)
            stays = np.zeros_like(at) if rod is None else rod.placed(at[:, :2]).displacement
            for i, probe in enumerate(names):
                turned = bool(stays[i].any())
                if sense == -1 and not turned:
                    continue
                chords.append(
                    _chord(
                        test, source, (f"{support.edge} beside {probe}", probe), (at[i], flat[i]),
                        (at[i] + stays[i], flat[i] + moved[i]), digits[i], sense if turned else 0,
                    )
                )  # fmt: skip
    return [chord for chord in chords if np.isfinite(chord.published)]


def nearer(of: Chord, moved: np.ndarray) -> float:
    """By how much the two points are nearer to each other than on the flat sheet [m], the probes moved by (4,
    3) [m]."""
    ends = (of.start, of.end, of.sense)
    same = next(c for c in of_table(of.test, of.source, moved) if (c.start, c.end, c.sense) == ends)
    return same.flat - same.published


def _chord(
    test: int,
    source: str,
    names: tuple[str, str],
    flat: Sequence[np.ndarray],
    ends: Sequence[np.ndarray],
    digits: np.ndarray,
    sense: int = 0,
) -> Chord:
    """digits (3,) [m]: how far the difference of the ends may be from the printed one."""
    offset = np.abs(ends[1] - ends[0])
    rest = float(np.linalg.norm(flat[1] - flat[0]))
    least = float(np.linalg.norm(np.maximum(offset - digits, 0.0)))
    most = float(np.linalg.norm(offset + digits))
    return Chord(
        test=test,
        source=source,
        start=names[0],
        end=names[1],
        flat=rest,
        published=float(np.linalg.norm(offset)),
        stretch=max(least / rest - 1.0, 0.0),
        turning=2.0 * acos(min(most / rest, 1.0)),
        sense=sense,
    )
