"""Steps of prescribed arc length along the path of equilibria, which show where its load stops growing.

With the load factor λ one more unknown, a step goes along the path's tangent, δq = Δλ K⁻¹ r', r' the change
of the right-hand side r by λ, and is corrected at right angles to it (Riks 1979, Ramm 1981):

    K δ = r + δλ r',      v·δ = 0,

with the extrapolated stresses of `newton`. Arc length is that of the unknowns alone, so a limit point in λ is
nothing special.
"""

from __future__ import annotations

from typing import Generic, NamedTuple

import numpy as np

from sheetbench.answers.solution import Status
from sheetbench.numerics.continuation.path import LoadStepFailed, Path
from sheetbench.numerics.continuation.structure import Forces, State, Structure
from sheetbench.numerics.direct import Factor, SingularMatrixError

CORRECTIONS = 10
TOLERANCE, CLOSE = 1e-9, 1e-5  # residual relative to the forces; that from which on stresses are their own
FIRST_ARC = 0.02  # sizes of the structure: the first steps towards a limit point
STEPS = 40
WITHIN = 1e-3  # of the load
CHANGE = 1e-5  # of the load factor, for the derivative by it


class _Point(NamedTuple, Generic[State]):
    """An equilibrium, the factors of its tangent and the step per unit of the load factor."""

    state: State
    load_factor: float
    factor: Factor
    along: np.ndarray


def limit_point(path: Path[State, Forces]) -> tuple[float, float] | None:
    """Return load factors between which the load stops growing past a path's last equilibrium, where that is
    stable; None where it goes on, or is not followed. The upper one is on the path's tangent: what softens
    stays below that."""
    structure, arc = path.structure, FIRST_ARC
    if not structure.symmetric or structure.multipliers:
        return None
    try:
        matrix, rows = structure.system(
            path.state, structure.forces(path.state, path.load_factor), path.load_factor, mixed=False
        )
        factor = path.factored(matrix)
        along = factor.solve(_per_load(structure, path.state, path.load_factor, rows, False))
    except SingularMatrixError:
        return None
    start = _Point(path.state, path.load_factor, factor, along)
    # a natural strain may move nothing before it buckles what is held
    moves = not structure.prestrained or structure.length(structure.rest(), path.state) > path.limits.idle
    for _ in range(STEPS if factor.negative == 0 and moves else 0):
        try:
            end, predicted = _arc_step(path, start, arc)
        except (LoadStepFailed, SingularMatrixError):
            arc /= 2.0
            continue
        if end.load_factor > start.load_factor and end.factor.negative == 0:
            start = end
        elif predicted - start.load_factor < WITHIN * predicted:
            return start.load_factor, predicted
        else:
            arc /= 4.0
    return None


def _arc_step(path: Path[State, Forces], start: _Point[State], arc: float) -> tuple[_Point[State], float]:
    """The next equilibrium on the path and its predicted load. Raises StepFailed, SingularMatrixError."""
    structure = path.structure

    def moved(state: State, to: float, step: np.ndarray) -> State:
        return structure.advance(state, structure.forces(state, to), to, step)

    trial = moved(start.state, start.load_factor + CHANGE, CHANGE * start.along)
    change = arc * CHANGE / structure.length(start.state, trial)
    predicted = load_factor = start.load_factor + change
    state = moved(start.state, load_factor, change * start.along)
    for _ in range(CORRECTIONS):
        forces = structure.forces(state, load_factor)
        imbalance, length = structure.imbalance(state, forces), structure.length(start.state, state)
        relative = imbalance / forces.size
        path.note(load_factor, relative, length)
        if not np.isfinite(relative) or length > 3.0 * arc:
            break
        mixed = relative > CLOSE
        matrix, rows = structure.system(state, forces, load_factor, mixed)
        factor = path.factored(matrix)
        along = factor.solve(_per_load(structure, state, load_factor, rows, mixed))
        aim = max(TOLERANCE, path.limits.tolerance) * forces.size
        if imbalance <= max(aim, structure.imbalance_floor(state, forces)):
            return _Point(state, load_factor, factor, along), predicted
        free = factor.solve(rows)
        correction = -float(start.along @ free) / float(start.along @ along)
        load_factor += correction
        state = moved(state, load_factor, free + correction * along)
    raise LoadStepFailed(Status.STEP_LIMIT, "no equilibrium at this arc length", arc)


def _per_load(
    structure: Structure[State, Forces], state: State, load_factor: float, rows: np.ndarray, mixed: bool
) -> np.ndarray:
    """Derivative of the right-hand side by the load factor at a state, rows being that at this one."""
    to = load_factor + CHANGE
    ahead = structure.system(state, structure.forces(state, to), to, mixed)[1]
    found: np.ndarray = (ahead - rows) / CHANGE
    return found
