"""Arc-length continuation (`lumped.statics.arc`): a lattice's load–displacement path through limit points.

The inertia of the true tangent at every point says which parts of the path are stable.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from lumped.calibration import Calibration
from lumped.loads import Loads
from lumped.mid_surface import MidSurface
from lumped.statics.arc import arc_step, per_load
from lumped.statics.equilibrium import State, StepFailed, at_rest
from lumped.statics.problem import Problem
from lumped.statics.solver import Branch, build_problem, solve_path
from sheetbench.numerics.reduced import SingularMatrixError
from sheetbench.scenes import AnyScene, Iteration, Load, Status, require_static, scene_of

STRAIGHT = 0.9  # cosine between a step and the path's tangent at its end, below which the step is too long
BENT = 0.5  # share by which a step's load may miss its prediction
SHORTEST = 2.0**-10  # of the longest arc


@dataclass(frozen=True)
class Path:
    """A load–displacement path of n points.

    load_factors: (n,); displacements: probe → (n, 3) [m]; negative: (n,) eigenvalues of the tangent below
    zero (0: stable, −1: not known); status: CONVERGED when the requested end was reached; message: why not.
    """

    load_factors: np.ndarray
    displacements: dict[str, np.ndarray]
    negative: np.ndarray
    status: Status
    factorisations: int
    message: str = ""

    @property
    def stable(self) -> np.ndarray:
        """Which points are stable equilibria, (n,)."""
        stable: np.ndarray = self.negative == 0
        return stable


def trace(
    scene: AnyScene,
    calibration: Calibration,
    *,
    vary: Sequence[Load] = (),
    branch: Branch = "path",
    until: Callable[[float, dict[str, np.ndarray]], bool] | None = None,
    load_limit: float = 1.0,
    points: int = 200,
    step: float | None = None,
    progress: Callable[[Iteration], None] | None = None,
) -> Path:
    """The equilibrium path of a scene, past limit points.

    Without `vary` the scene's own loads, curved supports and tilted clamps grow from zero. With it the scene
    is first solved (on the requested `branch`), then these loads are added and scaled. The path ends when |λ|
    reaches load_limit, when until(λ, probe displacements [m]) holds, or after `points` points. step: longest
    arc [m] of the largest mass displacement; default a fiftieth of the longer side.

    Raises scenes.SceneError when nothing stops a rigid motion, SingularMatrixError at a singular start.
    """
    scene = scene_of(scene)
    require_static(scene)
    problem = build_problem(scene, calibration)
    if vary:
        outcome = solve_path(scene, problem, branch)
        start = outcome.state
        added = scene.replace(gravity=None, loads=tuple(vary))
        problem = Problem(
            problem.assembly,
            problem.constraints,
            Loads(added, problem.assembly),
            problem.size,
            base=problem.loads,
            factorisations=problem.factorisations,
        )
        start = State(start.u, 0.0, start.blocks, start.factor, start.negative)
    else:
        start = at_rest(problem)
    problem.progress = progress
    longest = step if step is not None else problem.size / 50.0

    at_probes = MidSurface(problem.assembly.lattice, scene.probe_points())

    def probed(state: State) -> dict[str, np.ndarray]:
        return dict(zip(scene.probes, at_probes.of(state.u), strict=True))

    arc, message, status = longest, "", Status.STEP_LIMIT
    before, highest = None, 0.0
    found = [(start.load_factor, probed(start), start.negative)]
    while len(found) < points:
        try:
            state, predicted = arc_step(problem, start, before, arc, load_limit)
            if arc > SHORTEST * longest and _bends(problem, start, state, predicted, highest):
                raise StepFailed("the path bends")
        except (StepFailed, SingularMatrixError) as failure:
            arc /= 2.0
            if arc < SHORTEST * longest / 4.0:
                status, message = Status.DIVERGED, str(failure)
                break
            continue
        before, start = state.u - start.u, state
        highest = max(highest, abs(state.load_factor))
        found.append((state.load_factor, probed(state), state.negative))
        arc = min(longest, 1.5 * arc)
        if abs(abs(state.load_factor) - load_limit) < 1e-9 or (until and until(*found[-1][:2])):
            status = Status.CONVERGED
            break
    return Path(
        load_factors=np.array([row[0] for row in found]),
        displacements={name: np.array([row[1][name] for row in found]) for name in scene.probes},
        negative=np.array([-1 if row[2] is None else row[2] for row in found]),
        status=status,
        factorisations=problem.factorisations,
        message=message,
    )


def _bends(problem: Problem, start: State, end: State, predicted: float, highest: float) -> bool:
    """Whether a step cuts a corner: it misses the load predicted, or the path's direction at its end."""
    miss = abs(end.load_factor - predicted)
    if miss > max(BENT * abs(predicted - start.load_factor), 0.05 * highest):
        return True
    step, tangent = end.u - start.u, per_load(problem, end, end.blocks)
    return bool(abs(np.sum(tangent * step)) < STRAIGHT * np.linalg.norm(tangent) * np.linalg.norm(step))
