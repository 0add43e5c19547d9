"""An equilibrium with penalties, soft first and then stiff.

Along a load path of stiff penalties row after row of points comes to act, each a few corrections: Newton's
method on a quadratic penalty is the primal–dual active-set method, whose set bending moves slowly. With soft
ones the usual path leads to the full load; there they are raised, each stage Newton's method from the last
shape (2 to 6 factorisations): 34 in place of 292 on a strip of 41 masses laid on a plane. A stage that fails
takes the square root of its factor. What is said of the end is that of the last stage; where soft penalties
lead nowhere, or through an obstacle, `settle` begins again from rest with stiff ones.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Protocol

from sheetbench.answers.solution import Status
from sheetbench.numerics.continuation.newton import Start, newton
from sheetbench.numerics.continuation.path import Fault, Inspect, LoadStepFailed, Path, Settle
from sheetbench.numerics.continuation.structure import Forces, State
from sheetbench.numerics.continuation.trace import conclude
from sheetbench.numerics.threads import one_blas_thread

FIRST_FACTOR, LARGEST_FACTOR, SMALLEST_FACTOR = 30.0, 1e4, 1.05  # of the penalties, from stage to stage
EASIER = 3.0  # by which a stage's factor grows after one that went well


class Penalties(Protocol):
    """Penalties of a structure. soft: the share of their stiffness to begin with, None where soft ones would
    not hold."""

    @property
    def soft(self) -> float | None: ...

    def soften(self, share: float) -> None:
        """Give the penalties a share of their stiffness, 1 for all of it."""


def trace_stiffening(
    penalties: Penalties,
    path: Path[State, Forces],
    trace: Callable[[], Path[State, Forces]],
    inspect: Inspect[State, Forces],
    settle: Settle[State, Forces] | None,
    restart: Callable[[State], Start[State]],
    buckled: bool = False,
) -> Path[State, Forces]:
    """Return the path to the equilibrium at full load and with stiff penalties, or to the last one on the
    way.

    path: at rest; trace: the usual path, without a careful second run; restart: from a state, without
    forces that were computed with other penalties; settle, buckled: as of `trace_path`.
    """
    soft = penalties.soft
    settles = settle is not None and path.structure.symmetric
    ended: LoadStepFailed | Fault | None = None
    if soft is not None or not settles:
        share, spent = soft or 1.0, 0
        while True:  # what leads through an obstacle is too soft, where nothing else is left
            penalties.soften(share)
            path = trace()
            path.factorisations, spent = path.factorisations + spent, path.factorisations + spent
            penalties.soften(1.0)
            ended = path.fault
            if ended is None or share == 1.0 or settles:
                break
            share = min(1.0, FIRST_FACTOR * share)
        soft = share if soft is not None else None
    with one_blas_thread():
        if soft is not None and ended is None:
            path.snaps.clear()
            path.notes.clear()
            ended = _stiffened(path, penalties, soft, inspect, restart)
            penalties.soften(1.0)
        if settle is not None and settles and (soft is None or ended is not None):
            path.state, path.load_factor, path.factor = path.structure.rest(), 0.0, None
            path.limit = path.factorisations + path.limits.factorisations
            path.snaps.clear()
            path.notes.clear()
            try:
                path.state, path.load_factor, path.factor, ended = settle(path, 1.0), 1.0, None, None
            except LoadStepFailed as failure:
                ended = Fault(failure.status, f"descent with the contact as stiff as it is: {failure}")
        if isinstance(ended, LoadStepFailed):
            ended = Fault(ended.status, f"contact could not be stiffened: {ended}")
        conclude(path, ended, settle, buckled)
        return path


def _stiffened(
    path: Path[State, Forces],
    penalties: Penalties,
    share: float,
    inspect: Inspect[State, Forces],
    restart: Callable[[State], Start[State]],
) -> LoadStepFailed | Fault | None:
    """Raise the penalties from a share to all of them: what has ended it before, if anything."""
    factor = FIRST_FACTOR
    path.limit = path.factorisations + path.limits.factorisations
    while share < 1.0:
        target = min(1.0, share * factor)
        penalties.soften(target)
        try:
            path.state, path.factor = newton(path, restart(path.state))
        except LoadStepFailed as failure:
            factor **= 0.5
            if factor < SMALLEST_FACTOR or failure.status is Status.NON_FINITE:
                return failure
            continue
        share, factor = target, min(EASIER * factor, LARGEST_FACTOR)
        if (fault := inspect(path)) is not None:
            return fault
    return None
