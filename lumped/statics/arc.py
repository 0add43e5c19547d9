"""Steps of prescribed arc length along the path of equilibria, which pass limit points of the load.

With the load factor λ one more unknown, a step goes along the path's tangent, δu = Δλ K⁻¹ f, and is corrected
at right angles to it (Riks 1979, Ramm 1981):

    K(u, N*) δ = λ f − f_int + δλ f,      v·δ = 0,

with the extrapolated tensions N* of `lumped.statics.equilibrium`. Arc length is that of the displacement
alone, so a limit point in λ is nothing special.
"""

from __future__ import annotations

import numpy as np

from lumped.statics.equilibrium import State, StepFailed, all_rounding, follow
from lumped.statics.limits import REFINE_BELOW
from lumped.statics.problem import Problem
from sheetbench.numerics.reduced import Factor, SingularMatrixError

CORRECTIONS = 10
TOLERANCE = 1e-9  # residual relative to the forces
LIMIT_ARC = 0.02  # sides of the sheet: the first steps towards a limit point
LIMIT_STEPS = 40
LIMIT_WITHIN = 1e-3  # of the load


def limit_point(problem: Problem, start: State) -> tuple[float, float] | None:
    """Return load factors between which the load stops growing past a stable equilibrium; None where it goes
    on, or is not followed. The upper one is on the path's tangent: what softens stays below that."""
    if start.negative != 0 or not problem.conservative:
        return None
    arc, before = LIMIT_ARC * problem.size, None
    for _ in range(LIMIT_STEPS):
        try:
            end, predicted = arc_step(problem, start, before, arc, np.inf)
        except (StepFailed, SingularMatrixError):
            arc /= 2.0
            continue
        if end.load_factor > start.load_factor and end.negative == 0:
            before, start = end.u - start.u, end
        elif predicted - start.load_factor < LIMIT_WITHIN * predicted:
            return start.load_factor, predicted
        else:
            arc /= 4.0
    return None


def arc_step(
    problem: Problem, start: State, before: np.ndarray | None, arc: float, load_limit: float
) -> tuple[State, float]:
    """The next equilibrium on the path and its predicted load. Raises StepFailed, SingularMatrixError."""
    tangent = per_load(problem, start, start.blocks)
    forward = 1.0 if before is None or np.sum(tangent * before) > 0.0 else -1.0
    change = forward * arc / float(np.abs(tangent).max())
    if abs(start.load_factor + change) > load_limit:  # the end is near: go there by load
        end = float(np.sign(change)) * load_limit
        state, why = follow(problem, start, end)
        if why or np.abs(state.u - start.u).max() > 3.0 * arc:
            raise StepFailed(why or "the load step leaves the path")
        return state, end
    move = change * tangent
    load_factor = start.load_factor + change
    stresses = problem.assembly.all_families.extrapolated(start.u, move)
    u = np.where(problem.constraints.fixed, problem.prescribed(load_factor), start.u + move)
    for count in range(CORRECTIONS):
        residual = problem.residual(u, load_factor)
        problem.note(load_factor, residual.relative, float(np.abs(move).max()))
        if not np.isfinite(residual.relative) or np.abs(u - start.u).max() > 3.0 * arc:
            raise StepFailed("the corrections grow")
        rounded = all_rounding(problem, u, residual, float(np.abs(move).max()))
        close = rounded or residual.relative < REFINE_BELOW
        blocks, factor = problem.linearise(u, load_factor, None if close else stresses)
        if rounded or residual.relative < TOLERANCE:
            state = State(u, load_factor, blocks, factor, problem.negative(factor))
            return state, start.load_factor + change
        free = problem.expand(factor.solve(residual.reduced))
        loaded = problem.expand(factor.solve(problem.reduce(problem.growing(u))))
        loaded = loaded + _prescribed_rate(problem, load_factor, factor, blocks)
        correction = -float(np.sum(tangent * free)) / float(np.sum(tangent * loaded))
        move = free + correction * loaded
        stresses = problem.assembly.all_families.extrapolated(u, move)
        u, load_factor = u + move, load_factor + correction
        u = np.where(problem.constraints.fixed, problem.prescribed(load_factor), u)
        if count == CORRECTIONS - 1:
            break
    raise StepFailed(f"no equilibrium in {CORRECTIONS} corrections")


def per_load(problem: Problem, state: State, blocks: np.ndarray) -> np.ndarray:
    """Displacement per unit of load factor at an equilibrium, (n, 3) [m]."""
    loaded = problem.expand(state.factor.solve(problem.reduce(problem.growing(state.u))))
    return loaded + _prescribed_rate(problem, state.load_factor, state.factor, blocks)


def _prescribed_rate(problem: Problem, load_factor: float, factor: Factor, blocks: np.ndarray) -> np.ndarray:
    """What the supports' own movement adds to the displacement per unit of load factor, (n, 3) [m]."""
    h = 1e-6
    rate = (problem.prescribed(load_factor + h) - problem.prescribed(load_factor - h)) / (2.0 * h)
    if not rate.any():
        return rate
    return rate - problem.expand(factor.solve(problem.reduce(problem.system.apply(blocks, rate))))
