"""Newton's method with extrapolated stresses at one load, and the linear step that leads to it.

The corrections are those of Magisano, Leonetti & Garcea (2017), as `trace` says. Close to the end those with
the factors at hand serve as long as each leaves a tenth of the residual or less.
Three watchdogs end them: a number that is not finite, a step that leaves the structure far behind, and
corrections that do not shrink.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import isfinite
from typing import Generic

import numpy as np

from sheetbench.answers.solution import Status
from sheetbench.numerics.continuation.path import LoadStepFailed, Path
from sheetbench.numerics.continuation.structure import Forces, State
from sheetbench.numerics.direct import Factor, SingularMatrixError

SOLVED = 1e-14  # backward error of a correction that is not refined: the next one is its refinement
VANISHING = 1e-13  # work of a step, relative to the load step's first: beyond it only rounding is left
STALE = 0.1  # of a residual: factors whose correction leaves more are too old


@dataclass(frozen=True)
class Start(Generic[State]):
    """What Newton's method starts from: a state, the load factor it is for, and length and work of the step
    that has led to it; factor: of the tangent where a linear step from a path's last equilibrium began."""

    state: State
    target: float
    length: float
    work: float
    factor: Factor | None = None


def predicted(path: Path[State, Forces], target: float, reach: float, factor: Factor | None) -> Start[State]:
    """Return where the first linear step from a path's last equilibrium towards a load leads, no longer than
    `reach`. factor: of the tangent there, where it is at hand; it serves where that does not depend on the
    load. Raises LoadStepFailed."""
    first = _linear_step(path, target, factor)
    if reach < first.length < np.inf:
        target = path.load_factor + (target - path.load_factor) * reach / first.length
        first = _linear_step(path, target, first.factor)
    if not first.length < path.limits.farthest:
        raise LoadStepFailed(Status.DIVERGED, "the first step has no end", path.limits.first_reach)
    return first


def _linear_step(path: Path[State, Forces], target: float, factor: Factor | None) -> Start[State]:
    structure = path.structure
    forces = structure.forces(path.state, target)
    try:
        rows = None if factor is None else structure.rows(path.state, forces, target)
        fresh = factor is None and not structure.prestrained
        once = structure.correct(path.state, forces, target, path.count) if fresh else None
        if once is not None:
            factor, step, rows, state = once
        else:
            if rows is None:
                matrix, rows = structure.linearised(path.state, forces, target)
                if structure.prestrained:  # the tangent would be of stresses at the target, nothing moved yet
                    matrix = path.tangent(path.state, path.load_factor)
                if factor is None or not structure.symmetric:
                    factor = path.factored(matrix)
            assert factor is not None
            step = factor.solve(rows, SOLVED)
            state = structure.advance(path.state, forces, target, step)
    except SingularMatrixError as error:
        raise LoadStepFailed(Status.SINGULAR, str(error), path.limits.first_reach) from None
    length = structure.length(path.state, state)
    return Start(state, target, length, abs(float(step @ rows)), factor)


def newton(path: Path[State, Forces], first: Start[State], close: float = 0.0) -> tuple[State, Factor | None]:
    """The equilibrium at the load factor of a start, and the factors of its tangent where those at hand are,
    which next to nothing has changed since. close: a residual that is good enough. Raises
    StepFailed."""
    structure, limits = path.structure, path.limits
    state, target, before = first.state, first.target, np.inf
    factor = first.factor if structure.linear else None
    off, blurred, again = 0.0, 0.0, False  # moved since the factors; the error of the stress that they are of
    works, lengths = [first.work], [first.length]
    for _ in range(limits.corrections):
        forces = structure.forces(state, target)
        imbalance = structure.imbalance(state, forces)
        relative = imbalance / forces.size if forces.size > 0.0 else imbalance
        path.note(target, relative, lengths[-1])
        if not isfinite(relative):
            raise LoadStepFailed(Status.NON_FINITE, "a number overflowed", first.length)
        rounded = works[-1] <= VANISHING * works[0] and imbalance > 0.5 * before
        alike = factor is not None and (structure.linear or max(off, blurred) <= path.alike)
        settled = relative <= limits.tolerance or rounded
        if not settled and (relative <= limits.refine_below or lengths[-1] <= limits.idle):
            settled = imbalance <= structure.imbalance_floor(state)
        if relative <= close or (settled and structure.gap(state, target) <= limits.tolerance):
            return state, factor if alike else None
        last, back = lengths[-1], limits.back
        if len(lengths) > back and last >= max(lengths[-1 - back], limits.shrinking * lengths[-2]):
            raise LoadStepFailed(Status.STEP_LIMIT, "the corrections do not shrink", first.length)
        if path.factorisations >= path.limit:
            reason = f"{path.limit} factorisations were not enough"
            raise LoadStepFailed(Status.STEP_LIMIT, reason, first.length)
        refined = relative <= limits.refine_below
        serves = alike and refined and not (again and imbalance > STALE * before)
        try:
            rows = structure.rows(state, forces, target) if serves else None
            again = rows is not None
            once = None if again else structure.correct(state, forces, target, path.count)
            if rows is not None and factor is not None:
                step = factor.solve(rows, SOLVED)
            elif once is not None:
                factor, step, rows, following = once
                off, blurred = 0.0, last**2
            else:
                matrix, rows = structure.linearised(state, forces, target)
                near, factor = factor if not refined else None, None
                found = None
                if near is not None:
                    iterated = path.solver.iterated
                    found = near.solve(rows, SOLVED) if structure.linear else iterated(matrix, near, rows)
                if found is None or near is None:
                    near = None  # its memory is needed
                    factor = path.factored(matrix)
                    step, off, blurred = factor.solve(rows, SOLVED), 0.0, last**2
                else:
                    step, factor = found, near
        except SingularMatrixError as error:
            raise LoadStepFailed(Status.SINGULAR, str(error), first.length) from None
        if once is None:
            following = structure.advance(state, forces, target, step)
        lengths.append(structure.length(state, following))
        off += lengths[-1]
        if not lengths[-1] < limits.farthest:
            raise LoadStepFailed(Status.DIVERGED, "the corrections have no end", first.length)
        works.append(abs(float(step @ rows)))
        state, before = following, imbalance
    raise LoadStepFailed(
        Status.STEP_LIMIT, f"no equilibrium in {limits.corrections} corrections", first.length
    )
