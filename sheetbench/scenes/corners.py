"""Corners that a moved edge shares with a neighbour: what both demand there, and whether both can be obeyed.

A motion holds position and director of its whole edge, corners included (`sheetbench.scenes.kinematics`).
A support beside it holds what its kind says, another motion all of it; a chain goes where the corner goes,
unless its base stands there. Where they agree the corner belongs to the motion. They must agree at every
moment, for what is left out is not the same in every model: at the samples of both tables, and between them
at two points that no periodic motion takes for samples. Statics take the last pose of both.
"""

from __future__ import annotations

from itertools import pairwise, product

import numpy as np

from sheetbench.scenes.actuators import Chain, EdgeMotion
from sheetbench.scenes.kinematics import UP, MovedEdge, TiltedEdge
from sheetbench.scenes.sheet import EDGES, Sheet
from sheetbench.scenes.supports import (
    AnySupport,
    Clamped,
    Curved,
    Symmetric,
    held_axes,
    holds_director,
    place,
)
from sheetbench.scenes.tables import PiecewiseLinear

EXACT = 1e-6  # m per metre of the longer side, and in a director: what numbers written in decimals leave
BETWEEN = (0.381966, 0.618034)

Neighbour = AnySupport | EdgeMotion


def conflict(
    actuators: tuple[Chain | EdgeMotion, ...], supports: tuple[AnySupport, ...], sheet: Sheet
) -> str | None:
    """A sentence saying which motion and which neighbour cannot both be obeyed at their corner, or None."""
    for i, motion in enumerate(actuators):
        if not isinstance(motion, EdgeMotion):
            continue
        earlier = [other for other in actuators[:i] if isinstance(other, Chain)]
        on_edges = [support for support in supports if place(support) is None]
        for other in (*on_edges, *earlier, *actuators[i + 1 :]):
            if EDGES[other.edge].normal_axis != EDGES[motion.edge].normal_axis:
                reason = _between(motion, other, sheet)
                if reason is not None:
                    return reason
    return None


def _between(motion: EdgeMotion, other: Neighbour | Chain, sheet: Sheet) -> str | None:
    ends = sheet.edge_ends(other.edge)
    corner = next(end for end in ends if end in sheet.edge_ends(motion.edge))
    if isinstance(other, Chain):
        if other.base not in ("start", "end") or corner != ends[other.base == "end"]:
            return None
        return (
            f"the base of the chain on edge {other.edge} stands at the corner that the motion on edge "
            f"{motion.edge} moves"
        )
    if isinstance(other, Curved) and other.curvature != 0.0:
        return (
            f"the rod on edge {other.edge} (curvature {other.curvature:g} 1/m) moves the corner that the "
            f"motion on edge {motion.edge} holds"
        )
    axes, turns = _held(other)
    differences, turned = [], ""
    for time in _moments(motion, other):
        when = f"at t = {time:.3g} s"
        u, director = _pose(motion, corner, sheet, time)
        place, normal = _place(other, corner, sheet, time)
        gaps = [(abs(u[axis] - place[axis]), axis, when) for axis in axes]
        differences.append(max(gaps))
        if any(abs(director[axis] - normal[axis]) > EXACT for axis in turns):
            turned = when
    gap, axis, when = max(differences)
    if gap > EXACT * max(sheet.lengths):
        return (
            f"the motion on edge {motion.edge} moves the corner that {_named(other)} holds: "
            f"{'xyz'[axis]} by {gap:.3g} m {when}"
        )
    if turned:
        return (
            f"the motion on edge {motion.edge} turns the director at the corner where {_named(other)} "
            f"holds it otherwise, {turned}"
        )
    return None


def _held(other: Neighbour) -> tuple[tuple[int, ...], tuple[int, ...]]:
    """Axes of position and of director that a neighbour holds at the corner."""
    every = (0, 1, 2)
    if isinstance(other, EdgeMotion):
        return every, every
    if isinstance(other, Symmetric):
        return held_axes(other), held_axes(other)
    return held_axes(other), every if holds_director(other) else ()


def _moments(motion: EdgeMotion, other: Neighbour) -> list[float]:
    """Times [s] at which to look."""
    table = other if isinstance(other, EdgeMotion) else getattr(other, "motion", None)
    samples = sorted({*motion.time, *(table.time if table is not None else ())})
    between = [a + share * (b - a) for (a, b), share in product(pairwise(samples), BETWEEN)]
    return sorted([*samples, *between])


def _place(other: Neighbour, corner: tuple, sheet: Sheet, time: float) -> tuple[np.ndarray, np.ndarray]:
    """Displacement [m] and director (3,) that a neighbour gives the corner."""
    if isinstance(other, EdgeMotion):
        return _pose(other, corner, sheet, time)
    displacement = np.zeros(3)
    if other.motion is not None:
        displacement = PiecewiseLinear(other.motion.time, other.motion.displacement).at(time)
    tilted = TiltedEdge(other).placed(np.zeros((1, 2))).director if isinstance(other, Clamped) else 0.0
    return displacement, UP + tilted


def _pose(motion: EdgeMotion, corner: tuple, sheet: Sheet, time: float) -> tuple[np.ndarray, np.ndarray]:
    """Displacement [m] and director (3,) that a motion gives the corner."""
    placed = MovedEdge(motion, sheet).placed(np.array([corner]), time=time)
    return placed.displacement[0], UP + placed.director


def _named(other: Neighbour) -> str:
    if isinstance(other, EdgeMotion):
        return f"the motion on edge {other.edge}"
    return f"the {other.kind} support on edge {other.edge}"
