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
from sheetbench.numerics.continuation.structure import Correction, Forces, State
from sheetbench.numerics.direct import SOLVED, Factor, SingularMatrixError

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


Place = tuple[State, Forces, float]  # state, forces and load factor where a step begins


def _reused(path: Path[State, Forces], at: Place[State, Forces], factor: Factor) -> Correction | None:
    """Return the correction of factors at hand; None where the right-hand side needs the tangent."""
    rows = path.structure.rows(*at)
    return None if rows is None else path.structure.solved(*at, factor, rows)


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
    at = path.state, structure.forces(path.state, target), target
    try:
        found = None
        if factor is not None:
            found = _reused(path, at, factor)
        elif not structure.prestrained:
            found = structure.correct(*at, path.count)
        if found is None:
            matrix, rows = structure.linearised(*at)
            if structure.prestrained:  # the tangent would be of stresses at the target, nothing moved yet
                matrix = path.tangent(path.state, path.load_factor)
            if factor is None or not structure.symmetric:
                factor = path.factored(matrix)
            found = structure.solved(*at, factor, rows)
    except SingularMatrixError as error:
        raise LoadStepFailed(Status.SINGULAR, str(error), path.limits.first_reach) from None
    length, work = structure.length(path.state, found.state), abs(float(found.step @ found.rows))
    return Start(found.state, target, length, work, found.factor)


def newton(path: Path[State, Forces], first: Start[State], close: float = 0.0) -> tuple[State, Factor | None]:
    """Return the equilibrium at the load factor of a start, and the factors of its tangent where next to
    nothing has changed since they were made. close: a residual that is good enough. Raises LoadStepFailed."""
    run, structure, limits = _Newton(path, first), path.structure, path.limits
    try:
        for _ in range(limits.corrections):
            forces = structure.forces(run.state, first.target)
            imbalance = structure.imbalance(run.state, forces)
            relative = imbalance / forces.size if forces.size > 0.0 else imbalance
            path.note(first.target, relative, run.lengths[-1])
            if not isfinite(relative):
                raise LoadStepFailed(Status.NON_FINITE, "a number overflowed", first.length)
            if relative <= close or run.at_rest(imbalance, relative):
                return run.state, run.alike()
            if run.stalls():
                raise LoadStepFailed(Status.STEP_LIMIT, "the corrections do not shrink", first.length)
            if path.factorisations >= path.limit:
                reason = f"{path.limit} factorisations were not enough"
                raise LoadStepFailed(Status.STEP_LIMIT, reason, first.length)
            run.correct(forces, imbalance, relative)
            if not run.lengths[-1] < limits.farthest:
                raise LoadStepFailed(Status.DIVERGED, "the corrections have no end", first.length)
    except SingularMatrixError as error:
        raise LoadStepFailed(Status.SINGULAR, str(error), first.length) from None
    reason = f"no equilibrium in {limits.corrections} corrections"
    raise LoadStepFailed(Status.STEP_LIMIT, reason, first.length)


class _Newton(Generic[State, Forces]):
    """A state on its way to equilibrium: lengths and works of its steps, the imbalance before the last one,
    the factors at hand, the way since they were made, the error of their stresses, and whether the last step
    was with those of an earlier one."""

    def __init__(self, path: Path[State, Forces], first: Start[State]):
        self.path, self.structure, self.target = path, path.structure, first.target
        self.state, self.works, self.lengths = first.state, [first.work], [first.length]
        self.factor = first.factor if path.structure.linear else None
        self.before, self.moved, self.blurred, self.again = np.inf, 0.0, 0.0, False

    def alike(self) -> Factor | None:
        """Return the factors at hand if they are of the tangent here or nearly so."""
        unchanged = self.structure.linear or max(self.moved, self.blurred) <= self.path.alike
        return self.factor if unchanged else None

    def at_rest(self, imbalance: float, relative: float) -> bool:
        """Return whether the residual is in tolerance or all rounding, and all is where it is prescribed."""
        limits, last = self.path.limits, self.lengths[-1]
        rounded = self.works[-1] <= VANISHING * self.works[0] and imbalance > 0.5 * self.before
        settled = relative <= limits.tolerance or rounded
        if not settled and (relative <= limits.refine_below or last <= limits.idle):
            settled = imbalance <= self.structure.imbalance_floor(self.state)
        return settled and self.structure.gap(self.state, self.target) <= limits.tolerance

    def stalls(self) -> bool:
        """Return whether the steps do not shrink."""
        lengths, back, share = self.lengths, self.path.limits.back, self.path.limits.shrinking
        return len(lengths) > back and lengths[-1] >= max(lengths[-1 - back], share * lengths[-2])

    def correct(self, forces: Forces, imbalance: float, relative: float) -> None:
        """Take a step: with the factors at hand, by one compiled call, or with the assembled tangent."""
        at, last = (self.state, forces, self.target), self.lengths[-1]
        refined = relative <= self.path.limits.refine_below
        stale = self.again and imbalance > STALE * self.before
        near = self.alike() if refined and not stale else None
        again = None if near is None else _reused(self.path, at, near)
        found = again or self.structure.correct(*at, self.path.count) or self._assembled(at, not refined)
        if found.factor is not self.factor:
            self.moved, self.blurred = 0.0, last**2
        self.lengths.append(self.structure.length(self.state, found.state))
        self.works.append(abs(float(found.step @ found.rows)))
        self.moved += self.lengths[-1]
        self.state, self.factor, self.before, self.again = found.state, found.factor, imbalance, bool(again)

    def _assembled(self, at: Place[State, Forces], iterates: bool) -> Correction:
        """Return the correction of the tangent, by iterations with the factors at hand or by its own."""
        matrix, rows = self.structure.linearised(*at)
        if iterates and (near := self.factor) is not None:
            iterated = self.path.solver.iterated
            step = near.solve(rows, SOLVED) if self.structure.linear else iterated(matrix, near, rows)
            if step is not None:
                return Correction(near, step, rows, self.structure.advance(*at, step))
        near = self.factor = None  # their memory is needed
        return self.structure.solved(*at, self.path.factored(matrix), rows)
