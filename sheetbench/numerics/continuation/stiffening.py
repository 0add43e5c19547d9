"""An equilibrium with penalties of obstacles, soft first and then stiff.

Along a load path of stiff penalties row after row of points comes to act, each a few corrections: Newton's
method on a quadratic penalty is the primal–dual active-set method, whose set bending moves slowly. With soft
ones the usual path leads to the full load, where they are raised in stages of equal factors, each Newton's
method from the last shape with the stresses that it extrapolated: 30 factorisations in place of 292 on a
strip of 41 masses laid on a plane. Only the last stage is brought to the tolerance; one before ends at a
small residual, of a correction that has left the same points in contact: while points come and go residuals
are small now and then, and lead nowhere. One that fails takes the square root of its factor. What is said of
the end is that of the last stage. Where soft penalties lead nowhere, or through an obstacle, `settle` begins
again from rest with stiff ones, in so many load steps that no obstacle moves by more than a quarter of its
radius in one.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Generic, Protocol

import numpy as np

from sheetbench.answers.solution import Status
from sheetbench.numerics.continuation.limits import Limits
from sheetbench.numerics.continuation.newton import Start, newton
from sheetbench.numerics.continuation.path import Fault, Inspect, LoadStepFailed, Path, Settle
from sheetbench.numerics.continuation.structure import Forces, State
from sheetbench.numerics.continuation.trace import conclude
from sheetbench.numerics.threads import one_blas_thread

LARGEST_FACTOR, SMALLEST_FACTOR = 100.0, 1.05  # of the penalties, from stage to stage
LOOSE = 0.1  # residual at which soft load steps end, and stages but the last
DEPTH = 0.005  # of the size, or of a fifth of the radius: that soft penalties let the load sink in


class Penalty(Protocol):
    """The penalty of an obstacle. share: of its stiffness; full (…) [Pa/m], thickness (…) [m] and area (…)
    [m²] of its points; radius [m], infinite of a plane; moved [m], how far the obstacle goes in all."""

    share: float
    full: np.ndarray
    thickness: np.ndarray
    area: np.ndarray
    radius: float
    moved: float


@dataclass(frozen=True)
class Penalties(Generic[State]):
    """The penalties of a structure. force: sum of the loads [N]; travel: of what is moved [m]; size: of the
    structure [m]; thin: whether soft ones would be walked through; passes: whether a straight way between two
    states at two load factors leads through an obstacle; restart: what Newton's method starts from at full
    load, without forces that were computed with other penalties; touching: which points touch
    at full load."""

    each: Sequence[Penalty]
    force: float
    travel: float
    size: float
    thin: bool
    passes: Callable[[State, float, State, float], bool]
    restart: Callable[[State], Start[State]]
    touching: Callable[[State], np.ndarray]

    @property
    def soft(self) -> float:
        """The share of the stiffness to begin with: with it the load, or the pressure that bends a plate of
        this size by what is moved (8 D per size⁴), leaves points DEPTH deep."""
        shares = [1.0]
        for one in self.each:
            bending = float((one.full * one.thickness**4).max()) / 12.0
            bent = 8.0 * bending * max(self.travel, one.moved) / self.size**4
            deep = DEPTH * min(self.size, 0.2 * one.radius) * float(one.full.min())
            shares.append(max(self.force / float(one.area.sum()), bent) / deep)
        return min(share for share in shares if share > 0.0)

    @property
    def load_steps(self) -> int:
        """How many load steps from rest obstacles and supports come in, a quarter of a radius in each."""
        ways = (4.0 * (one.moved + self.travel) / one.radius for one in self.each)
        return max(1, *map(math.ceil, ways))

    def same(self, before: State, state: State) -> bool:
        """Whether the same points touch in two states."""
        return np.array_equal(self.touching(before), self.touching(state))

    def soften(self, share: float) -> None:
        """Give the penalties a share of their stiffness, 1 for all of it."""
        for one in self.each:
            one.share = share


def trace_stiffening(
    penalties: Penalties[State],
    path: Path[State, Forces],
    trace: Callable[[Limits, Inspect[State, Forces]], Path[State, Forces]],
    inspect: Inspect[State, Forces],
    settle: Settle[State, Forces] | None,
    buckled: bool = False,
) -> Path[State, Forces]:
    """Return the path to the equilibrium at full load and with stiff penalties, or to the last one on the
    way.

    path: at rest; trace: the usual path; settle, buckled: as of `trace_path`.
    """
    limits, rest = path.limits, path.structure.rest()
    loose = replace(limits.direct, tolerance=LOOSE)
    last = rest, 0.0

    def kept_out(path: Path[State, Forces]) -> Fault | None:
        nonlocal last
        start = last if last[1] <= path.load_factor else (rest, 0.0)
        last = path.state, path.load_factor
        if penalties.passes(*start, *last):
            return Fault(Status.STEP_LIMIT, "a step led through an obstacle")
        return inspect(path)

    settles = settle is not None and path.structure.symmetric
    share = 1.0 if penalties.thin else penalties.soft
    ended: Fault | None = None
    while not (penalties.thin and settles):  # what leads nowhere is too soft, where nothing else is left
        penalties.soften(share)
        spent, last = path.factorisations, (rest, 0.0)
        path = trace(loose, kept_out)
        path.factorisations, path.limits = path.factorisations + spent, limits
        ended = path.fault
        if ended is None:
            path.snaps.clear()
            path.notes.clear()
            with one_blas_thread():
                ended = _stiffened(path, penalties, share, kept_out)
        if ended is None or share == 1.0 or settles:
            break
        share = min(1.0, 30.0 * share)
    penalties.soften(1.0)
    with one_blas_thread():
        if settle is not None and settles and (penalties.thin or ended is not None):
            last = rest, 0.0
            ended = _settled(path, penalties.load_steps, kept_out, settle)
        conclude(path, ended, settle, buckled)
        return path


def _settled(
    path: Path[State, Forces], load_steps: int, inspect: Inspect[State, Forces], settle: Settle[State, Forces]
) -> Fault | None:
    """Lead a path from rest by descents, load step by load step: what has ended it before, if anything."""
    path.state, path.load_factor, path.factor = path.structure.rest(), 0.0, None
    path.snaps.clear()
    path.notes.clear()
    for step in range(1, load_steps + 1):
        path.limit = path.factorisations + path.limits.factorisations
        try:
            path.state, path.load_factor = settle(path, step / load_steps), step / load_steps
        except LoadStepFailed as failure:
            return Fault(failure.status, f"descent with the contact as stiff as it is: {failure}")
        path.factor = None
        if (fault := inspect(path)) is not None:
            return fault
    return None


def _stiffened(
    path: Path[State, Forces], penalties: Penalties[State], share: float, inspect: Inspect[State, Forces]
) -> Fault | None:
    """Raise the penalties from a share to all of them: what has ended it before, if anything."""
    factor = LARGEST_FACTOR
    path.limit = path.factorisations + path.limits.factorisations
    while True:
        target = share ** (1.0 - 1.0 / max(1, math.ceil(-math.log(share) / math.log(factor))))
        penalties.soften(target)
        close = LOOSE if target < 1.0 else 0.0
        try:
            path.state, path.factor = newton(path, penalties.restart(path.state), close, penalties.same)
        except LoadStepFailed as failure:
            factor = (target / share) ** 0.5
            if factor < SMALLEST_FACTOR or failure.status is Status.NON_FINITE:
                return Fault(failure.status, f"contact could not be stiffened: {failure}")
            continue
        if (fault := inspect(path)) is not None or target == 1.0:
            return fault
        share = target
