"""Equilibria in contact: penalties of obstacles, raised from a soft start to their full stiffness.

Along a load path with stiff penalties one row of points after another comes into contact, at a few
corrections each: Newton's method on a quadratic penalty is the primal–dual active-set method, and bending
changes the active set slowly. So soft penalties are raised at the full load in stages of equal factors, each
by Newton's method with extrapolated stresses. Under a given load a patch is k^(−1/2) deep where it touches
around a point, k^(−2/3) along a line: from the second stage on, the shape goes as far beyond the last one as
that depth does, but not where the patch keeps its area, as on a box's face, where depths are like 1/k. All
stages but the last end at a residual small enough for a rolling contact to settle while its patch is wide,
and small beside what contact bears: a sheet that natural curvature bends may be light. A failed stage is
repeated from the last shape itself with the square root of its factor. The status is the last stage's. If
soft penalties fail or lead through an obstacle, `settle` starts again from rest with stiff ones, in load
steps so short that no obstacle moves by more than a quarter of its radius in one.

A penalty has the `obstacle`, the acting `share` of its stiffness, whether its patch is within cells, `bent`,
and at its points the full stiffness `full` (…) [Pa/m], `thickness` (…) [m] and `area` (…) [m²]; its method
`near` takes the result of `configuration`.
"""

import math
from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import replace
from typing import Any

import numpy as np

from sheetbench.answers.solution import Status
from sheetbench.numerics.continuation.newton import Start, newton
from sheetbench.numerics.continuation.path import Fault, LoadStepFailed, Path
from sheetbench.numerics.continuation.structure import Forces, State, Structure

LARGEST_FACTOR, SMALLEST_FACTOR = 30.0, 1.05  # of the penalties, from stage to stage
NARROW = 0.8  # share of its area that a patch along a line or around a point has left after the first stage
POINT, LINE = 1 / 2, 2 / 3  # powers of 1/k that depths of patches are like
REACH = 0.1  # largest displacement of the first linear step; longer ones lead around a round obstacle
SOFT_STEPS, STAGES, CELL_STAGES = 0.05, 0.01, 3e-3  # residuals at which load steps and early stages end
STAGE_CORRECTIONS = 80  # they first shrink slowly: a narrow patch rolls by its width in each
STEP_SHARE = 0.25  # of the radius, by which obstacles and supports come in between descents
OUT_OF_REACH = 10.0  # sizes from rest and beyond all prescribed motions: out of reach
DEPTH = 0.005  # of the size, or of a fifth of the radius: that soft penalties let the load sink in


def set_stiffness_share(penalties: Sequence[Any], share: float) -> None:
    """Set the acting share of the penalties' stiffness, from 0 to 1."""
    for one in penalties:
        one.share = share


def within_reach(structure: Structure[State, Forces]) -> bool:
    """Return whether an obstacle lies within reach of a structure."""
    rest = structure.rest()
    at, reach = structure.configuration(rest, 1.0), structure.size * (OUT_OF_REACH + structure.gap(rest, 1.0))
    ways = (np.linalg.norm(one.obstacle.place() - one.obstacle.position) for one in structure.contacts)
    both = zip(structure.contacts, ways, strict=True)
    return any(one.near(at).depth.max() > -reach - way for one, way in both)


def require_free_step(path: Path[State, Forces], state: State, load_factor: float) -> None:
    """Raise LoadStepFailed if a straight step from a path's last equilibrium would pass through an
    obstacle."""
    structure = path.structure
    before = structure.configuration(path.state, path.load_factor)
    after = structure.configuration(state, load_factor)
    if any(one.near(after).free_share(one.near(before)) < 1.0 for one in structure.contacts):
        raise LoadStepFailed(Status.STEP_LIMIT, "a step led through an obstacle", path.limits.first_reach)


def first_stiffness_share(structure: Structure[State, Forces]) -> float:
    """Set the penalties to 0, and return the share of their stiffness to begin with: the penetration is DEPTH
    under the load, or under the pressure that bends a plate of this size by the prescribed motion (8 D per
    size⁴)."""
    shares, size = [1.0], structure.size
    set_stiffness_share(structure.contacts, 0.0)
    force, gap = structure.loading(), size * structure.gap(structure.rest(), 1.0)
    for one in structure.contacts:
        bending, body = float((one.full * one.thickness**4).max()) / 12.0, one.obstacle
        bent = 8.0 * bending * max(gap, float(np.linalg.norm(body.place() - body.position))) / size**4
        deep = DEPTH * min(size, 0.2 * body.radius) * float(one.full.min())
        shares.append(max(force / float(one.area.sum()), bent) / deep)
    return min(share for share in shares if share > 0.0)


def trace_with_penalties(
    path: Path[State, Forces],
    trace: Callable[[Path[State, Forces]], Fault | None],
    near: Start[State] | None = None,
) -> Fault | None:
    """Trace a path from rest to the equilibrium at full load with stiff penalties; return the fault if it
    ends earlier, else None. trace: traces a path with given penalties; near: a start for a descent."""
    structure, limits, contacts = path.structure, path.limits, path.structure.contacts
    down = path.settle if structure.symmetric else None
    if near is not None and down is not None:
        path.put(near.state, 0.0)
        with suppress(LoadStepFailed):
            path.put(down(path, 1.0), 1.0)
            return path.inspect(path)
    share = first_stiffness_share(structure)
    while True:  # without a `settle`, a share that fails is too soft
        set_stiffness_share(contacts, share)
        planes = all(math.isinf(one.obstacle.radius) for one in contacts)
        reach = limits.first_reach if planes else min(limits.first_reach, REACH)
        path.begin(replace(limits, careful_after=limits.in_all, tolerance=SOFT_STEPS, first_reach=reach))
        ended = trace(path)
        path.limits = limits
        if ended is None:
            path.forget()
            ended = _raise_penalties(path, share)
        if ended is None or share == 1.0 or down is not None:
            break
        share = min(1.0, 30.0 * share)
    set_stiffness_share(contacts, 1.0)
    if ended is None or down is None:
        return ended
    path.begin(limits)
    gap, bodies = structure.size * structure.gap(path.state, 1.0), [one.obstacle for one in contacts]
    ways = (
        (gap + np.linalg.norm(body.place() - body.position)) / (STEP_SHARE * body.radius) for body in bodies
    )
    for load_factor in np.linspace(0.0, 1.0, max(1, *map(math.ceil, ways)) + 1)[1:].tolist():
        path.limit = path.factorisations + limits.factorisations
        try:
            state = down(path, load_factor)
            require_free_step(path, state, load_factor)
            path.put(state, load_factor)
        except LoadStepFailed as failure:
            return Fault(failure.status, f"descent with the full stiffness of contact: {failure}")
        if (fault := path.inspect(path)) is not None:
            return fault
    return None


def touched(path: Path[State, Forces]) -> tuple[float, float]:
    """Return the area in contact [m²], and the ratio of the contact forces to the size of all forces, which
    stresses at rest may dominate."""
    at, size = path.structure.configuration(path.state, 1.0), path.structure.forces(path.state, 1.0).size
    states = [one.report(at)[0] for one in path.structure.contacts]
    borne = sum(one.area * one.pressure for one in states)
    return sum(one.area for one in states), min(1.0, borne / (size or 1.0))


def _raise_penalties(path: Path[State, Forces], share: float) -> Fault | None:
    """Raise the penalties from a share to their full stiffness; return the fault if a stage fails, else
    None."""
    structure, factor = path.structure, LARGEST_FACTOR
    path.limit = path.factorisations + path.limits.factorisations
    path.limits = replace(path.limits, corrections=STAGE_CORRECTIONS, back=STAGE_CORRECTIONS)
    narrow = within_cells = all(one.bent for one in structure.contacts)
    power = POINT if all(one.obstacle.kind == "sphere" for one in structure.contacts) else LINE
    before, last, (area, borne) = path.state, 0.0, touched(path)
    while True:
        target = share ** (1.0 - 1.0 / max(1, math.ceil(-math.log(share) / math.log(factor))))
        set_stiffness_share(structure.contacts, target)
        shrunk = (share / target) ** power
        close = 0.0 if target == 1.0 else CELL_STAGES * borne if within_cells else STAGES
        try:
            beyond = (1.0 - shrunk) / (1.0 / last - 1.0) if last and narrow else 0.0
            state, size = structure.restarted(path.state, before, beyond)
            solution = newton(path, Start(state, 1.0, 1.0, size), close)
            require_free_step(path, solution[0], 1.0)
        except LoadStepFailed as failure:
            factor, before = (target / share) ** 0.5, path.state
            if factor < SMALLEST_FACTOR or failure.status is Status.NON_FINITE:
                return Fault(failure.status, f"contact could not be stiffened: {failure}")
            continue
        before, (path.state, path.factor) = path.state, solution
        if (fault := path.inspect(path)) is not None or target == 1.0:
            return fault
        if not last:
            narrow = narrow and touched(path)[0] < NARROW * area
        share, last = target, shrunk
