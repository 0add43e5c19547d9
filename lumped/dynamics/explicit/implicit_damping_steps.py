"""Steps of velocity Verlet with implicit damping in one compiled call, see `verlet_implicit_damping`.

The matrix M + ½ h C is factored at a shape that the sheet has been in, banded, L Lᵀ; the velocity at a
step's end is found by corrections with these factors from the dampers as they are now. Corrections that
shrink slowly end the call, for the factors to be made anew.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit

from lumped.dynamics.explicit.steps import (
    ExplicitArrays,
    Workspace,
    exerted_on,
    external,
    resist,
    rounded,
    work_of_loads,
    work_of_supports,
)
from lumped.springs.all_forces import add_at_places, add_damping_again
from lumped.springs.tiles import NUMBA_FALSE, NUMBA_TRUE, OPTIONS
from sheetbench.numerics import banded

VELOCITY_TOLERANCE = 1e-8  # what corrections leave of the velocity, relative to the largest
STALE = 0.1  # ratio of successive corrections above which the factors are made anew
MEASURED = 32  # steps at most from one measurement of that ratio to the next
CORRECTIONS = 12


class Factors(NamedTuple):
    """Banded factors of a matrix of m unknowns (`sheetbench.numerics.banded`). place, unknown, value: (e,)
    entries of T, unknowns in the band's order."""

    band: np.ndarray
    unknowns: int
    width: int
    place: np.ndarray
    unknown: np.ndarray
    value: np.ndarray


@njit(**OPTIONS)
def march(
    steps: int,
    h: float,
    arrays: ExplicitArrays,
    matrix: Factors,
    factors: np.ndarray,
    place: np.ndarray,
    place_rate: np.ndarray,
    u: np.ndarray,
    v: np.ndarray,
    a: np.ndarray,
    workspace: Workspace,
    guess: np.ndarray,
    last: np.ndarray,
    solved: np.ndarray,
) -> tuple[bool, int, float, float]:
    """As `lumped.dynamics.explicit.steps.march`, but for steps that it ends early, whole, once corrections
    shrink slowly, and that it cannot take without new factors. guess, last: (3 s,); solved: as long as the
    band, and its width."""
    packing, driven, rate = arrays.packing, arrays.driven, arrays.rate
    x, w, force, damping, load = workspace.x, workspace.w, workspace.force, workspace.damping, workspace.load
    count = packing.layers * packing.plane
    taken = work = 0.0
    external(arrays, factors[0], u, load)
    rounded(arrays, u, x)
    w[:] = v
    last[:] = v
    force[:] = 0.0
    _, power = add_at_places(x, w, NUMBA_FALSE, NUMBA_TRUE, packing, force, workspace.tile)
    power += resist(rate, w, force)
    if len(driven):
        add_at_places(x, w, NUMBA_TRUE, NUMBA_FALSE, packing, force, workspace.tile)
    for i in range(len(driven)):
        workspace.exerted[i] = exerted_on(arrays, driven[i], a, force, load)
    ratio, measured = 1.0, 0
    for n in range(steps):
        for i in range(len(u)):
            guess[i] = v[i] + (v[i] - last[i])
            last[i] = v[i]
        for i in range(len(u)):
            half = v[i] + 0.5 * h * a[i]
            v[i] = half
            u[i] += h * half
        if arrays.working:
            for i in range(len(u)):
                workspace.moved[i] = h * v[i]
        for i in range(len(driven)):
            p, jump = driven[i], place[n + 1, i] - place[n, i] - h * place_rate[n, i]
            u[p] += jump
            workspace.moved[p] += jump
            v[p] += place_rate[n + 1, i] - place_rate[n, i]
            guess[p] = v[p]
        if arrays.working:
            workspace.load_before[:] = load
            external(arrays, factors[n + 1], u, load)
        rounded(arrays, u, x)
        force[:] = 0.0
        add_at_places(x, w, NUMBA_TRUE, NUMBA_FALSE, packing, force, workspace.tile)
        size, aged = np.inf, False
        for k in range(CORRECTIONS):
            w[:] = guess
            damping[:] = 0.0
            add_damping_again(x, w, packing, damping, workspace.tile)
            resist(rate, w, damping)
            before = size
            size, largest = _correct(0.5 * h, arrays, matrix, v, load, force, damping, guess, solved)
            if not np.isfinite(size):
                return False, n, taken, work
            if k > 0:
                ratio, measured = size / before if before > 0.0 else 0.0, n
                aged = aged or ratio > STALE
            if min(ratio, 1.0) * size <= VELOCITY_TOLERANCE * largest and (k > 0 or n - measured < MEASURED):
                break
        else:
            return False, n, taken, work
        now = 0.0
        for q in range(3):
            first = np.uint64(q) * packing.size
            for i in range(count):
                gained = (guess[first + i] - v[first + i]) * (2.0 / h)
                inertia = arrays.mass[first + i] * gained
                a[first + i] = gained
                v[first + i] = guess[first + i]
                now += v[first + i] * (load[first + i] - force[first + i] - inertia)
        for i in range(len(driven)):
            p = driven[i]
            now += v[p] * (damping[p] - (load[p] - force[p] - arrays.mass[p] * a[p]))
        taken += 0.5 * h * (power + now)
        power = now
        if arrays.working:
            work += work_of_loads(arrays, workspace.load_before, load, workspace.moved)
        if len(driven):
            for i in range(len(force)):
                force[i] += damping[i]
        work += work_of_supports(
            arrays, workspace, driven, (a, force, load), place[n : n + 2], place_rate[n : n + 2]
        )
        if aged:
            return True, n + 1, taken, work
    return True, steps, taken, work


@njit(**OPTIONS)
def _correct(
    half: float,
    arrays: ExplicitArrays,
    matrix: Factors,
    w: np.ndarray,
    load: np.ndarray,
    force: np.ndarray,
    damping: np.ndarray,
    guess: np.ndarray,
    solved: np.ndarray,
) -> tuple[float, float]:
    """Add (M + ½ h C)⁻¹ [M (w − v) + ½ h (load − force − damping)] to the velocity guessed, v; the largest of
    that and of v."""
    solved[:] = 0.0
    for e in range(len(matrix.place)):
        p = matrix.place[e]
        pull = arrays.mass[p] * (w[p] - guess[p]) + half * (load[p] - force[p] - damping[p])
        solved[matrix.unknown[e]] += matrix.value[e] * pull
    banded.substitute(matrix.band, matrix.unknowns, matrix.width, solved)
    size = largest = 0.0
    for e in range(len(matrix.place)):
        p = matrix.place[e]
        move = matrix.value[e] * solved[matrix.unknown[e]]
        guess[p] += move
        size += move * move
        largest += guess[p] * guess[p]
    return np.sqrt(size), np.sqrt(largest)
