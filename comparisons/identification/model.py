"""Fitted models: displacements at the measured points, and their slopes by the unknowns.

statics                         derivatives of the equilibrium, a solution with its factors each; of the
                                solid, which has none, central differences of whole solutions
motion from rest                derivatives along the run of a lattice without obstacles and actuators, by
                                unknowns that do not move supports; else central differences of whole runs;
                                cubic in time between samples
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cache, partial
from typing import Any

import numpy as np

from comparisons.identification import surface
from comparisons.identification.unknowns import Unknown, put
from comparisons.models.grading import fixed, lines_on_shapes
from comparisons.models.resolve import Resolved, resolve
from comparisons.models.solve import solve
from comparisons.models.spec import Elements, Lattice
from sheetbench.answers.history import History
from sheetbench.answers.solution import Solution, Status
from sheetbench.errors import BadInput, NoEquilibrium
from sheetbench.scenes import Scene
from sheetbench.scenes.objects.grading import as_settings

STATIC_STEP = 1e-3  # in x, for differences of solutions that are accurate to about 1e-9
MOTION_STEP = 1e-2  # in x, for differences of runs, accurate to about 1e-5
FOLLOWED_ERROR = 1e-6  # of the step of a lattice whose run has the derivatives
OF_SUPPORTS = ("tilt_", "curvature_", "support", "actuator")
MOTION_ERROR = 1e-7  # of a lattice's step, which changes with the unknowns: differences must not see it
STEPS_PER_PERIOD = 100  # of a reference, fixed: frequencies within (2π/100)²/12, E within twice that, 0.07 %


class NoAnswer(NoEquilibrium):
    """No equilibrium at an x of the unknowns, or a run that ended early; the text is its status."""


@dataclass(frozen=True)
class Prediction:
    """Displacements (n, 3) [m] at the measured points, and their slopes (n, 3) [m] by x of each unknown."""

    displacement: np.ndarray
    slopes: list[np.ndarray]


Predictor = Callable[[Sequence[Unknown], np.ndarray, np.ndarray, np.ndarray | None], Prediction]


@dataclass(frozen=True)
class Model:
    """A model to fit. axes: the plan grid of its whole surface; predict: called with unknowns, their x (see
    `comparisons.identification.unknowns`), plan points (n, 2) [m] and the times (n,) [s] of a motion, None at
    rest. It raises NoAnswer where the model has no stable equilibrium, or its run ended early."""

    settings: dict[str, Any]
    axes: tuple[np.ndarray, np.ndarray]
    predict: Predictor


def lattice_model(scene: Scene, lattice: Lattice) -> Model:
    """Return the requested lattice as a model to fit, open settings chosen by the scene's own values."""
    import lumped

    resolved = resolve(scene, lattice, scene_springs=False)
    grading = fixed(resolved.spec.grading) or lines_on_shapes(scene, resolved.grid, resolved.spec)

    def run(varied: Scene, end: float, names: Sequence[str] = ()) -> History:
        error = FOLLOWED_ERROR if names else MOTION_ERROR
        return lumped.simulate(varied, resolved.on(varied).springs, end, error=error, sensitivities=names)

    axes = surface.plan_grid(scene.sheet.lengths, resolved.grid[:2])
    return Model({**resolved.settings, **as_settings(grading)}, axes, partial(_predict, resolved, run))


def reference_model(model: Resolved[Elements]) -> Model:
    """Return a finite-element reference as a model to fit."""
    import fem_reference

    scene, options = model.scene, model.spec.options
    along_x, along_y = model.spec.counts(scene)[:2]

    @cache
    def step() -> float:
        lowest = fem_reference.modes(scene, "plate", elements=2, count=1).frequencies[0]
        return float(1.0 / (STEPS_PER_PERIOD * lowest))

    def run(varied: Scene, end: float) -> History:
        steps = {"step": step(), "every": step()}
        return fem_reference.simulate(
            varied, model.spec.model, end, elements=(along_x, along_y), **steps, **options
        )

    axes = surface.plan_grid(scene.sheet.lengths, (2 * along_x + 1, 2 * along_y + 1))
    return Model({"elements": [along_x, along_y], **options}, axes, partial(_predict, model, run))


def _predict(
    model: Resolved[Any],
    run: Callable[..., History],
    unknowns: Sequence[Unknown],
    x: np.ndarray,
    points: np.ndarray,
    time: np.ndarray | None,
) -> Prediction:
    names = [u.name for u in unknowns]
    if time is not None:
        direct = isinstance(model.spec, Lattice) and not (model.scene.actuators or model.scene.obstacles)
        if direct and not any(name.startswith(OF_SUPPORTS) for name in names):
            varied = set_in(model.scene, unknowns, x)
            displacement, *slopes = _sample_motion(partial(run, names=names), time, varied, points)
            slopes = [slope * u.slope(z) for slope, u, z in zip(slopes, unknowns, x, strict=True)]
            return Prediction(displacement, slopes)
        return _predict_by_differences(
            model.scene, lambda *case: _sample_motion(run, time, *case)[0], MOTION_STEP, unknowns, x, points
        )
    solution = _solve_statics(model, set_in(model.scene, unknowns, x))
    if solution.sensitivity is None:
        at_rest = lambda varied, points: _solve_statics(model, varied).displacement(points)  # noqa: E731
        return _predict_by_differences(model.scene, at_rest, STATIC_STEP, unknowns, x, points)
    try:
        sensitivity = solution.sensitivity()
        slopes = [
            sensitivity.displacement_rate(points, u.name) * u.slope(z)
            for u, z in zip(unknowns, x, strict=True)
        ]
    except (BadInput, NoEquilibrium) as error:
        raise NoAnswer(str(error)) from None
    return Prediction(solution.displacement(points), slopes)


def _solve_statics(model: Resolved[Any], varied: Scene) -> Solution:
    """Return the model's equilibrium of a scene with other values. Raises NoAnswer without a stable one."""
    try:
        solution = solve(model.on(varied))
    except (BadInput, NoEquilibrium) as error:
        raise NoAnswer(str(error)) from None
    if solution.status is not Status.CONVERGED:
        raise NoAnswer(f"{solution.label}: {solution.status}: {solution.status.advice}")
    return solution


def set_in(scene: Scene, unknowns: Sequence[Unknown], x: np.ndarray) -> Scene:
    """Return the scene with every unknown at its x."""
    for one, at in zip(unknowns, x, strict=True):
        scene = put(scene, one.name, one.value(at))
    return scene


def _sample_motion(
    simulate: Callable[[Scene, float], History], time: np.ndarray, varied: Scene, points: np.ndarray
) -> np.ndarray:
    """Return displacements (n, 3) [m] of a motion from rest, row i of the points at time[i] [s], and
    derivatives of the run, (1 + parameters, n, 3)."""
    from scipy.interpolate import CubicSpline

    places, probe_of_row = np.unique(points, axis=0, return_inverse=True)
    probes = {f"m{i}": (float(x), float(y)) for i, (x, y) in enumerate(places)}
    run = simulate(varied.replace(probes=probes), float(time.max()))
    if run.status is not Status.CONVERGED:
        raise NoAnswer(f"{run.label}: {run.status}: {run.message}")
    series = [run.probes, *run.extra.get("sensitivities", {}).values()]
    histories = np.array([[history[name] for name in probes] for history in series])
    samples = CubicSpline(run.time, histories, axis=2)(time)
    return np.asarray(samples[:, probe_of_row.ravel(), np.arange(len(time))])


def _predict_by_differences(
    scene: Scene,
    displacement: Callable[[Scene, np.ndarray], np.ndarray],
    step: float,
    unknowns: Sequence[Unknown],
    x: np.ndarray,
    points: np.ndarray,
) -> Prediction:
    slopes: list[np.ndarray] = []
    for i, unknown in enumerate(unknowns):
        ends = np.clip([x[i] - step, x[i] + step], *unknown.bounds())
        low, high = (
            displacement(set_in(scene, unknowns, np.where(np.arange(len(x)) == i, end, x)), points)
            for end in ends
        )
        slopes.append((high - low) / (ends[1] - ends[0]))
    return Prediction(displacement(set_in(scene, unknowns, x), points), slopes)
