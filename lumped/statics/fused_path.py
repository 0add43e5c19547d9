"""The load path of a small lattice as a single compiled call that holds no lock.

The path of `lumped.statics.equilibrium`, correction by correction, with one difference: a tangent that is not
positive definite fails the load step, which is then halved. Where a few halvings do not help, the call ends
with the last equilibrium, and the search goes on from there in Python with all its means. Supports that move
are known at full load only: a path under them is one load step here, or none.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numba import njit

from lumped.springs import together
from lumped.springs.tiles import NO, YES
from lumped.springs.together import Stresses
from lumped.statics import fused
from lumped.statics.fused import Posed, Work
from lumped.statics.limits import (
    CLOSE,
    COARSE,
    COLLAPSED,
    CORRECTIONS,
    EASY,
    FARTHEST,
    FINE,
    FIRST_REACH,
    POLISHED,
    POLISHINGS,
    QUICK,
    SETTLED,
)
from lumped.statics.soundness import long_enough, upright
from sheetbench.numerics.banded import BACKWARD_ERROR

NONE: Any = np.int64(0)  # for Python's own numba would compile what it is handed to once more
LINES = 200  # of history: room for ten load steps and more
LINES_A_STEP = 60  # at most
HALVINGS = 3  # of one load step, before it is left to Python


class Followed(NamedTuple):
    """How far a path went: whether the flat sheet's tangent is positive definite, and if so the last
    equilibrium's load factor, displacement (n, 3) [m] and stresses, whose tangent's factors are in the work
    space; how far and by what load the next step is to go; tangents factored on the way; and a line (load
    factor, residual, step [m]) of every correction."""

    definite: bool
    load_factor: float
    u: np.ndarray
    stresses: Stresses
    reach: float
    step: float
    factorisations: int
    history: np.ndarray


class Reached(NamedTuple):
    """A load step's end: whether it is an equilibrium, where, tangents factored, and lines of history."""

    found: bool
    u: np.ndarray
    factorisations: int
    lines: int


@njit(cache=True, nogil=True)
def followed(posed: Posed, work: Work) -> Followed:
    """The path from the flat sheet to full load, as far as it goes."""
    u = np.zeros_like(posed.dead)
    stress = together.stresses(u, posed.springs)
    history, lines, factorisations = np.empty((LINES, 3)), NONE, 1
    load_factor, step, reach, halvings = 0.0, 1.0, FIRST_REACH * posed.size, 0
    if not fused.factored(u, stress, posed, work):
        return Followed(False, load_factor, u, stress, reach, step, factorisations, history[:lines])
    while 1.0 - load_factor > 1e-12 and lines + LINES_A_STEP <= LINES:
        step = min(step, 1.0 - load_factor)
        if posed.moves and step < 1.0:
            break
        moved, miss = predicted(step, posed, work)
        farthest = np.abs(moved).max()
        if not miss <= BACKWARD_ERROR or not farthest < np.inf:
            break
        if farthest > reach:
            if posed.moves:
                break
            moved *= reach / farthest
            step *= reach / farthest
            farthest = reach
        ahead = load_factor + step
        tolerance = FINE if abs(1.0 - ahead) < 1e-12 else COARSE
        expected = together.extrapolated(u, moved, posed.springs)
        done = _corrected(u + moved, expected, ahead, moved, tolerance, posed, work, history, lines)
        factorisations += done.factorisations
        if not done.found or not sound(done.u, posed):
            step /= 2.0
            reach = min(reach, farthest) / 2.0
            halvings += 1
            factorisations += 1
            if not fused.factored(u, stress, posed, work):  # the last equilibrium's again
                return Followed(False, 0.0, u, stress, reach, step, factorisations, history[:0])
            if halvings > HALVINGS:
                break
            continue
        u, load_factor, lines, halvings = done.u, ahead, done.lines, 0
        stress = together.stresses(u, posed.springs)
        if done.factorisations <= EASY:
            reach *= 1.5
        step *= 4.0
    return Followed(True, load_factor, u, stress, reach, step, factorisations, history[:lines])


@njit(inline="always")
def predicted(step: float, posed: Posed, work: Work) -> tuple[np.ndarray, float]:
    """Displacement (n, 3) [m] of a load step, linear at the state whose factors are at hand, and its backward
    error."""
    force = step * posed.dead
    if not posed.moves:
        return fused.solved(force, posed, work)
    for b in range(len(posed.rows)):
        row, column = posed.rows[b], posed.indices[b]
        for q in range(3):
            for r in range(3):
                force[row, q] -= work.blocks[b, q, r] * posed.placed[column, r]
    moved, miss = fused.solved(force, posed, work)
    return moved + posed.placed, miss


@njit(inline="always")
def _corrected(
    u: np.ndarray,
    stress: Stresses,
    load_factor: float,
    moved: np.ndarray,
    tolerance: float,
    posed: Posed,
    work: Work,
    history: np.ndarray,
    lines: int,
) -> Reached:
    """`lumped.statics.equilibrium.corrected`."""
    before, length, grown = np.inf, np.abs(moved).max(), 0
    unbalanced, residual = fused.residual_at(u, load_factor, posed)
    for count in range(CORRECTIONS):
        history[lines] = load_factor, residual, length
        lines += 1
        if not np.isfinite(residual):
            break
        idle = length <= SETTLED * posed.size and residual < floor(u, load_factor, unbalanced, posed)
        if residual < COARSE or idle:
            close = count > 0 and length <= CLOSE * posed.size
            return _polished(
                u, load_factor, unbalanced, residual, tolerance, close, count, posed, work, history, lines
            )
        done = fused.corrected(u, unbalanced, load_factor, stress, YES, posed, work)
        if not done.definite or not done.miss <= BACKWARD_ERROR:
            return Reached(False, u, count + 1, lines)
        u, unbalanced, residual, stress = u + done.step, done.unbalanced, done.residual, done.stresses
        before, length = length, np.abs(done.step).max()
        grown = grown + 1 if length > before else 0
        if length > FARTHEST * posed.size or (count > 2 and grown > 1):
            return Reached(False, u, count + 1, lines)
    return Reached(False, u, CORRECTIONS, lines)


@njit(inline="always")
def _polished(
    u: np.ndarray,
    load_factor: float,
    unbalanced: np.ndarray,
    residual: float,
    tolerance: float,
    close: bool,
    factorisations: int,
    posed: Posed,
    work: Work,
    history: np.ndarray,
    lines: int,
) -> Reached:
    """`lumped.statics.equilibrium.polish`. close: whether the factors at hand are this tangent's."""
    aim = max(tolerance, floor(u, load_factor, unbalanced, posed))
    for fresh in range(POLISHINGS + 1):
        if fresh:
            done = fused.corrected(
                u, unbalanced, load_factor, together.stresses(u, posed.springs), NO, posed, work
            )
            factorisations += 1
            length = np.abs(done.step).max()
            fine = done.definite and done.miss <= BACKWARD_ERROR and np.isfinite(done.residual)
            if not fine or length > POLISHED * posed.size:
                break
            if done.residual < residual:
                u, unbalanced, residual = u + done.step, done.unbalanced, done.residual
            history[lines] = load_factor, residual, length
            lines += 1
        elif not close:
            continue
        while not residual < aim:
            step, _ = fused.solved(unbalanced, posed, work)
            left, less = fused.residual_at(u + step, load_factor, posed)
            if not less < QUICK * residual:
                break
            u, unbalanced, residual = u + step, left, less
            history[lines] = load_factor, residual, np.abs(step).max()
            lines += 1
        if residual < aim:
            return Reached(True, u, factorisations, lines)
    return Reached(False, u, factorisations, lines)


@njit(inline="always")
def floor(u: np.ndarray, load_factor: float, unbalanced: np.ndarray, posed: Posed) -> float:
    """`lumped.statics.equilibrium.rounding_floor`, from the unbalanced force (n, 3) [N] at u."""
    external = load_factor * posed.dead
    size = fused.scale(external - unbalanced, external, posed.held)
    carried = np.abs(u).max() * np.sqrt((posed.link_stiffness**2).sum())
    return np.finfo(np.float64).eps * carried / size if size > 0.0 else np.inf


@njit(inline="always")
def sound(u: np.ndarray, posed: Posed) -> bool:
    """Whether u (n, 3) [m] is a state that means something (`lumped.statics.faults`)."""
    links = posed.springs.links
    return upright(posed.columns, posed.positions, posed.areas, u) and long_enough(
        u, links.nodes, links.offset, links.rest_length, COLLAPSED
    )
