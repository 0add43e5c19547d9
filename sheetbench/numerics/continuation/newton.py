"""Newton's method with extrapolated stresses at one load, and the linear step before it.

Corrections follow Magisano, Leonetti & Garcea (2017), see `trace`. Close to the end they are computed with
old factors, as long as each leaves a tenth of the residual or less. The iteration ends without an equilibrium
at a number that is not finite, after a far too long step, and if corrections do not shrink.
"""

from dataclasses import dataclass
from math import isfinite
from typing import Generic

import numpy as np

from sheetbench.answers.solution import Status
from sheetbench.numerics.continuation.path import LoadStepFailed, Path
from sheetbench.numerics.continuation.structure import Correction, Forces, State
from sheetbench.numerics.direct import SOLVED, Factor, SingularMatrixError

VANISHING = 1e-13  # work of a step, relative to the load step's first: a smaller one is rounding
STALE = 0.1  # of a residual: factors are too old if their correction leaves more


@dataclass(frozen=True)
class Start(Generic[State]):
    """Start of Newton's method: a state, its load factor, and length and work of the step before it. factor:
    of the tangent at the start of the linear step from a path's last equilibrium."""

    state: State
    target: float
    length: float
    work: float
    factor: Factor | None = None


Place = tuple[State, Forces, float]  # state, forces and load factor at the start of a step


def _reuse(path: Path[State, Forces], at: Place[State, Forces], factor: Factor) -> Correction | None:
    """Return the correction computed with old factors, or None if the right-hand side depends on the
    tangent."""
    rows = path.structure.rows(*at)
    return None if rows is None else path.structure.solved(*at, factor, rows)


def predicted(path: Path[State, Forces], target: float, reach: float, factor: Factor | None) -> Start[State]:
    """Return the end of the first linear step from a path's last equilibrium towards a load. The step is no
    longer than `reach`. factor: of the tangent at its start, if available. Raises LoadStepFailed."""
    first = _linear_step(path, target, factor)
    if reach < first.length < np.inf:
        target = path.load_factor + (target - path.load_factor) * reach / first.length
        first = _linear_step(path, target, first.factor)
    if not first.length < path.limits.farthest:
        raise LoadStepFailed(Status.DIVERGED, "the first step is too long", path.limits.first_reach)
    return first


def _linear_step(path: Path[State, Forces], target: float, factor: Factor | None) -> Start[State]:
    structure = path.structure
    at = path.state, structure.forces(path.state, target), target
    try:
        correction = None
        if factor is not None:
            correction = _reuse(path, at, factor)
        elif not structure.prestrained:
            correction = structure.correct(*at, path.count)
        if correction is None:
            matrix, rows = structure.linearised(*at)
            if structure.prestrained:  # else stresses of the target without its displacement
                matrix = path.tangent(path.state, path.load_factor)
            if factor is None or not structure.symmetric:
                factor = path.factored(matrix)
            correction = structure.solved(*at, factor, rows)
    except SingularMatrixError as error:
        raise LoadStepFailed(Status.SINGULAR, str(error), path.limits.first_reach) from None
    length = structure.length(path.state, correction.state)
    work = abs(float(correction.step @ correction.rows))
    return Start(correction.state, target, length, work, correction.factor)


def newton(path: Path[State, Forces], first: Start[State], close: float = 0.0) -> tuple[State, Factor | None]:
    """Return the equilibrium at the load factor of a start, and the factors of its tangent or None. Factors
    are returned if they are of a nearly unchanged tangent. close: a residual small enough. Raises
    LoadStepFailed."""
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
                return run.state, run.reusable_factor()
            if run.stalls():
                raise LoadStepFailed(Status.STEP_LIMIT, "the corrections do not shrink", first.length)
            if path.factorisations >= path.limit:
                reason = f"{path.limit} factorisations were not enough"
                raise LoadStepFailed(Status.STEP_LIMIT, reason, first.length)
            run.correct(forces, imbalance, relative)
            if not run.lengths[-1] < limits.farthest:
                raise LoadStepFailed(Status.DIVERGED, "a correction is too long", first.length)
    except SingularMatrixError as error:
        raise LoadStepFailed(Status.SINGULAR, str(error), first.length) from None
    reason = f"no equilibrium in {limits.corrections} corrections"
    raise LoadStepFailed(Status.STEP_LIMIT, reason, first.length)


class _Newton(Generic[State, Forces]):
    """A state on its way to equilibrium, with the lengths and works of its steps. last_imbalance: before the
    last step. factor: the last factors. distance: moved since they were made. stress_error: of the stresses
    that they were made with. reused_last: whether the last step reused factors."""

    def __init__(self, path: Path[State, Forces], first: Start[State]):
        self.path, self.structure, self.target = path, path.structure, first.target
        self.state, self.works, self.lengths = first.state, [first.work], [first.length]
        self.factor = first.factor if path.structure.linear else None
        self.last_imbalance, self.reused_last = np.inf, False
        self.distance = self.stress_error = 0.0

    def reusable_factor(self) -> Factor | None:
        """Return the last factors if the tangent has not changed noticeably since, else None."""
        unchanged = self.structure.linear or max(self.distance, self.stress_error) <= self.path.alike
        return self.factor if unchanged else None

    def at_rest(self, imbalance: float, relative: float) -> bool:
        """Return whether the residual is within the tolerance or rounding, and the prescribed displacements
        are reached."""
        limits, last = self.path.limits, self.lengths[-1]
        rounded = self.works[-1] <= VANISHING * self.works[0] and imbalance > 0.5 * self.last_imbalance
        settled = relative <= limits.tolerance or rounded
        if not settled and (relative <= limits.refine_below or last <= limits.idle):
            settled = imbalance <= self.structure.imbalance_floor(self.state)
        return settled and self.structure.gap(self.state, self.target) <= limits.tolerance

    def stalls(self) -> bool:
        """Return whether the steps have stopped shrinking."""
        lengths, back, share = self.lengths, self.path.limits.back, self.path.limits.shrinking
        return len(lengths) > back and lengths[-1] >= max(lengths[-1 - back], share * lengths[-2])

    def correct(self, forces: Forces, imbalance: float, relative: float) -> None:
        """Take a Newton step: with the last factors, by one compiled call, or with the assembled tangent."""
        at, last = (self.state, forces, self.target), self.lengths[-1]
        refined = relative <= self.path.limits.refine_below
        stale = self.reused_last and imbalance > STALE * self.last_imbalance
        near = self.reusable_factor() if refined and not stale else None
        reused = None if near is None else _reuse(self.path, at, near)
        step = reused or self.structure.correct(*at, self.path.count)
        step = step or self._correct_assembled(at, not refined)
        if step.factor is not self.factor:
            self.distance, self.stress_error = 0.0, last**2
        self.lengths.append(self.structure.length(self.state, step.state))
        self.works.append(abs(float(step.step @ step.rows)))
        self.distance += self.lengths[-1]
        self.state, self.factor = step.state, step.factor
        self.last_imbalance, self.reused_last = imbalance, bool(reused)

    def _correct_assembled(self, at: Place[State, Forces], iterates: bool) -> Correction:
        """Return the correction of the tangent, by iterations with the last factors or by new ones."""
        matrix, rows = self.structure.linearised(*at)
        if iterates and (near := self.factor) is not None:
            iterated = self.path.solver.iterated
            step = near.solve(rows, SOLVED) if self.structure.linear else iterated(matrix, near, rows)
            if step is not None:
                return Correction(near, step, rows, self.structure.advance(*at, step))
        near = self.factor = None  # their memory is needed
        return self.structure.solved(*at, self.path.factored(matrix), rows)
