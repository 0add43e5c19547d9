"""Equilibrium of a structure under a load that grows from 0 to 1: mixed Newton with adaptive steps.

Strains are quadratic in the unknowns: after a large rotation Newton's method on the displacements has
membrane stresses that are only the error of its own linear step, and does not converge well. Magisano,
Leonetti & Garcea (2017, "mixed integration point") use for the geometric stiffness the stress that the last
linear step extrapolated, σ* = C (ε + B δu), and do not change the residual: the equilibrium is unchanged, and
the path from the flat sheet takes a few iterations. Supports move in the first linear step.

Load steps adapt. The first linear step towards a load is no longer than a reach of a few sizes of the
structure: a longer one is cut to the reach, with its load, without new factors. A load step whose corrections
stop shrinking (`newton`) fails at once and halves the reach; an easy one raises it. `inspect` may end the
path at an equilibrium beyond the structure's validity. If the path ends before the full load, the inertia of
the last equilibrium's tangent shows whether it has lost its uniqueness.

If corrections stop shrinking in the shortest steps, the path is at a limit point. A path with a `settle`
continues from the stable equilibrium a little beyond (see `pseudo_transient`): the structure snaps.

The inertia of the true tangent decides at the end whether the equilibrium is stable; under follower loads,
whose tangent is not symmetric, its real eigenvalues do (collapse; flutter belongs to dynamics).
"""

from typing import NamedTuple

from sheetbench.answers.solution import Status
from sheetbench.numerics.continuation.limits import Limits
from sheetbench.numerics.continuation.newton import Start, newton, predicted
from sheetbench.numerics.continuation.path import Fault, Inspect, LoadStepFailed, Path, Progress, Settle
from sheetbench.numerics.continuation.stability import stability
from sheetbench.numerics.continuation.stiffening import require_free_step, trace_with_penalties, within_reach
from sheetbench.numerics.continuation.structure import Forces, Solver, State, Structure
from sheetbench.numerics.direct import Factor, SingularMatrixError
from sheetbench.numerics.threads import one_blas_thread

SAME_TANGENT = 1e-2  # of (thickness/size)², the strain that buckles a sheet: smaller changes are negligible


def trace_path(
    structure: Structure[State, Forces],
    solver: Solver,
    inspect: Inspect[State, Forces] = lambda path: None,
    settle: Settle[State, Forces] | None = None,
    progress: Progress | None = None,
    near: Start[State] | None = None,
    slenderness: float = 0.0,
    limits: Limits | None = None,
    buckled: bool = False,
) -> Path[State, Forces]:
    """Return the path to the equilibrium at load factor 1, or to the last one, with the reason of its end.

    inspect, settle: as in `Path`. progress: called at every iteration. near: a start close to the
    equilibrium; if it leads to no stable one, the path begins at rest. slenderness: thickness over size; if
    given, the factors before a negligible last correction are used for stability. buckled: leave an unstable
    equilibrium for the stable one of `settle`.
    """
    with one_blas_thread():
        path = Path(structure, solver, structure.rest(), limits=limits or Limits(), progress=progress)
        path.alike, path.inspect, path.settle = SAME_TANGENT * slenderness**2, inspect, settle
        touching = structure.contacts and within_reach(structure)
        fault = trace_with_penalties(path, _trace, near) if touching else _trace(path, near)
        path.fault = fault
        path.status, note = fault or stability(path)
        if buckled and settle is not None and fault is None and path.status is Status.UNSTABLE:
            try:
                path.limit = path.factorisations + path.limits.factorisations
                path.put(settle(path, 1.0), 1.0)
                path.notes.append("started along the buckling mode of an unstable equilibrium")
                path.status, note = stability(path)
            except LoadStepFailed as failure:
                note = f"{note}; from its buckling mode: {failure}"
        path.notes.extend([note] if note else [])
        return path


class Ending(NamedTuple):
    """End of a run. reason: why it ended before load factor 1, else None. careful: limit of factorisations of
    small load steps, 0 after large ones alone."""

    reason: LoadStepFailed | Fault | None
    careful: int = 0


def _trace(path: Path[State, Forces], near: Start[State] | None = None) -> Fault | None:
    """Trace a path from rest, or from a start near the end, to load factor 1; return the fault if it ends
    earlier."""
    if near is not None and _trace_near(path, near):
        return None
    plain = _take_load_steps(path)
    reached = path.state if plain is None else None
    ended = _trace_carefully(path, plain)
    fault = _trace_snaps(path, ended)
    if fault is None or reached is None:
        return fault
    if path.load_factor > 0.0:
        limited = f", after {ended.careful} factorisations" if path.factorisations >= path.limit else ""
        path.notes.append(
            f"small load steps end at load factor {path.load_factor:.4g}{limited}: this equilibrium, "
            "reached by large ones, may be on another branch"
        )
    path.put(reached, 1.0)
    return None


def _trace_near(path: Path[State, Forces], near: Start[State]) -> bool:
    """Move a path to a stable equilibrium close to a start; return False, with the path unchanged, if there
    is none."""
    before = path.state, path.load_factor, path.factor
    try:
        state, factor = newton(path, near)
    except LoadStepFailed:
        return False
    path.put(state, near.target, factor)
    close = path.structure.length(near.state, state) <= path.limits.same_branch * near.length
    if close and path.inspect(path) is None and stability(path) == (Status.CONVERGED, ""):
        return True
    path.put(*before)
    return False


def _trace_carefully(path: Path[State, Forces], plain: LoadStepFailed | Fault | None) -> Ending:
    """Trace a path again from rest, by small load steps, if large ones may have left its branch. plain: end
    of the large steps, which is returned if no small one succeeds."""
    budget = 0 if isinstance(plain, Fault) else _careful_budget(path)
    if not budget:
        return Ending(plain)
    stuck = path.state, path.load_factor
    path.rest()
    path.limit = path.factorisations + budget
    ended = _take_load_steps(path, careful=True)
    if plain is not None:
        path.limit = max(path.limit, path.limits.factorisations)  # the rest is for snaps
        if path.load_factor == 0.0:
            path.put(*stuck)
            return Ending(plain)
    return Ending(ended, budget)


def _trace_snaps(path: Path[State, Forces], ending: Ending) -> Fault | None:
    """Continue a path beyond the limit points at which it ends; return the fault if it ends before load
    factor 1."""
    limits, reason = path.limits, ending.reason
    while isinstance(reason, LoadStepFailed):
        halted = reason.status is Status.STEP_LIMIT and path.load_factor > 0.0  # at a limit point
        allowed = path.factorisations < path.limit and len(path.snaps) < limits.snaps
        if path.settle is None or not (path.structure.symmetric and halted and allowed):
            return _fault_at_end(path, reason)
        left_at, (before, reservation) = path.load_factor, stability(path)
        beyond = min(1.0, left_at + limits.snap_step)
        path.limit = min(path.factorisations + limits.factorisations, limits.in_all)
        try:
            state = path.settle(path, beyond)
            if path.structure.contacts:
                require_free_step(path, state, beyond)
            path.put(state, beyond)
        except LoadStepFailed as failure:
            tried = f"; relaxed at a load factor {limits.snap_step:g} higher, {failure}"
            return _fault_at_end(path, reason, tried)
        path.limit = min(path.factorisations + limits.factorisations, limits.in_all)
        reason = path.inspect(path) or _take_load_steps(path, ending.careful > 0)
        path.snaps.append(left_at)
        begin = "" if before is Status.CONVERGED else "unstable "
        snapped = f"{begin}before it snapped at load factor {left_at:.4g}: {reservation}"
        path.notes.extend([snapped] if reservation else [])
    return reason


def _take_load_steps(path: Path[State, Forces], careful: bool = False) -> LoadStepFailed | Fault | None:
    """Continue a path to load factor 1; return the reason of an earlier end, else None. careful: no load step
    may leave the branch of its start."""
    limits, size = path.limits, 1.0
    reach = limits.careful_reach if careful else limits.first_reach
    factor: Factor | None = None
    while path.load_factor < 1.0:
        before = path.factorisations
        try:
            first = predicted(path, min(1.0, path.load_factor + size), reach, factor)
            factor = first.factor if path.structure.symmetric else None
            close = limits.careful_tolerance if careful and first.target < 1.0 else 0.0
            state, last = newton(path, first, close)
            if path.structure.contacts:
                require_free_step(path, state, first.target)
            if careful:
                last, longest = _require_continuous(path, first, state, last)
        except LoadStepFailed as failure:
            size, reach = 0.5 * size, 0.5 * min(reach, failure.length)
            rested = path.load_factor == 0.0  # rest is no limit point, however long the first step
            shortest = size < limits.smallest_step and (reach < limits.shortest or not (careful or rested))
            if shortest or path.factorisations >= path.limit:
                if careful and path.load_factor > 0.0:
                    _refine(path)
                return failure
            continue
        grown = first.target - path.load_factor
        path.put(state, first.target, last)
        if (fault := path.inspect(path)) is not None:
            return fault
        if careful:
            factor, size, reach = last, limits.growth * grown, longest
            continue
        # with elements the last correction's factors are too inaccurate for a step: a thin sheet's path halts
        factor = last if limits.steps_with_last_factors else None
        easy = path.factorisations - before <= limits.lengthen_up_to
        size, reach = (limits.growth * grown, limits.reach_growth * reach) if easy else (grown, reach)
    return None


def _refine(path: Path[State, Forces]) -> None:
    """Bring the end of a careful path to the tolerance, if necessary at a slightly lower load."""
    for lower in (0.0, 1.0, 2.0, 4.0):
        target = (1.0 - lower * path.limits.careful_tolerance) * path.load_factor
        try:
            path.state = newton(path, Start(path.state, target, 1.0, 0.0))[0]
        except LoadStepFailed:
            continue
        path.load_factor = target
        return


def _fault_at_end(path: Path[State, Forces], failure: LoadStepFailed, tried: str = "") -> Fault:
    """Return the fault at a path's end, with the load factor, the attempts to go beyond, and a bifurcation
    before it. The last equilibrium's tangent shows whether the path had branched."""
    message = f"no equilibrium found beyond load factor {path.load_factor:.4g}: {failure}{tried}"
    if path.load_factor > 0.0:
        status, note = stability(path)
        if status is not Status.CONVERGED:
            message += f"; {note} there: the answer is not unique on this grid"
    return Fault(failure.status, message)


def _careful_budget(path: Path[State, Forces]) -> int:
    """Return the number of factorisations for a second, careful run, 0 if it is not necessary. The run
    searches for a branch that large load steps may have left. It is not necessary if the equilibrium is
    stable and was found quickly, or if the path is a single linear step without a correction."""
    one_step = path.factorisations == 1 and not path.structure.prestrained
    if not path.structure.symmetric or path.load_factor == 0.0 or one_step:
        return 0
    taken, limits = path.factorisations, path.limits
    unstable = stability(path)[0] is Status.UNSTABLE
    if unstable and path.structure.has_meaning(path.state):
        return limits.factorisations
    budget = min(limits.careful_budget_factor * taken, limits.factorisations)
    return budget if unstable or taken > limits.careful_after else 0


def _require_continuous(
    path: Path[State, Forces], first: Start[State], state: State, factor: Factor | None
) -> tuple[Factor, float]:
    """Return the factors of the tangent at an equilibrium, and the largest length of the next linear step.

    Raises LoadStepFailed if the equilibrium is on another branch than the start of the step: if it is far
    from the end of the linear step, or stability has been lost in a step that is not short or under a natural
    strain, which may act without displacement. factor: the factors, if available.
    """
    assert first.factor is not None
    limits, miss = path.limits, path.structure.length(first.state, state)
    if miss > max(min(limits.continuous * first.length, limits.miss), max(limits.idle, limits.tolerance)):
        raise LoadStepFailed(Status.STEP_LIMIT, "the path folds", first.length)
    try:
        factor = factor or path.factored(path.tangent(state, first.target))
    except SingularMatrixError as error:
        raise LoadStepFailed(Status.SINGULAR, str(error), first.length) from None
    short = first.length <= limits.branching and not path.structure.prestrained
    if factor.negative > first.factor.negative and not short:
        raise LoadStepFailed(Status.STEP_LIMIT, "the path loses stability", first.length)
    longest = limits.growth * first.length
    if miss > 0.0:  # it grows with the square of the step
        square = first.length**2 / miss
        longest = min(
            longest, limits.safe * limits.continuous * square, (limits.safe * limits.miss * square) ** 0.5
        )
    return factor, longest
