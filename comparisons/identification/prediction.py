"""Predictions of a model at the measured points, and their slopes by the unknowns.

statics through the lattice     exact derivatives (`lumped.sensitivity`)
statics through a reference     central differences of whole solutions
motion from rest                central differences of whole runs, of the lattice or of a reference, cubic in
                                time between samples

A predictor is called with unknowns, their x (see `comparisons.identification.unknowns`) and plan points (n,
2) [m], and answers with displacements (n, 3) [m] and their slopes by x. It raises NotReached where the model
has no stable equilibrium, or its run ended early.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from comparisons.identification.unknowns import Unknown, put
from comparisons.models.resolve import Resolved
from comparisons.models.solve import solve
from comparisons.models.spec import Elements
from sheetbench.answers.history import History
from sheetbench.answers.solution import Status
from sheetbench.errors import BadInput, NoEquilibrium
from sheetbench.scenes import Scene

if TYPE_CHECKING:
    from lumped import Calibration

STATIC_STEP = 1e-3  # in x, for differences of solutions that are accurate to about 1e-9
MOTION_STEP = 1e-2  # in x, for differences of runs, accurate to about 1e-5


class NotReached(NoEquilibrium):
    """The model has no answer here; the text says how it ended."""


@dataclass(frozen=True)
class Prediction:
    """displacement: (n, 3) [m]; slopes: by x of each unknown, (n, 3) [m], in their order."""

    displacement: np.ndarray
    slopes: list[np.ndarray]


Predictor = Callable[[Sequence[Unknown], np.ndarray, np.ndarray], Prediction]


def set_in(scene: Scene, unknowns: Sequence[Unknown], x: np.ndarray) -> Scene:
    """Return the scene with every unknown at its x."""
    for one, at in zip(unknowns, x, strict=True):
        scene = put(scene, one.name, one.value(at))
    return scene


def lattice(scene: Scene, springs_of: Callable[[Scene], Calibration]) -> Predictor:
    """Statics through the lattice; springs_of: the springs of a scene with other values of the unknowns."""
    import lumped

    def predict(unknowns: Sequence[Unknown], x: np.ndarray, points: np.ndarray) -> Prediction:
        here = set_in(scene, unknowns, x)
        springs = springs_of(here)
        try:
            found = lumped.sensitivity(here, springs, [u.name for u in unknowns], points, springs_of)
        except (BadInput, NoEquilibrium) as error:
            raise NotReached(str(error)) from None
        slopes = [found.derivatives[u.name] * u.slope(at) for u, at in zip(unknowns, x, strict=True)]
        return Prediction(found.displacement, slopes)

    return predict


def reference(model: Resolved[Elements]) -> Predictor:
    """Statics through a finite-element reference."""

    def displacement(here: Scene, points: np.ndarray) -> np.ndarray:
        solution = solve(model.on(here))
        if solution.status is not Status.CONVERGED:
            raise NotReached(f"{solution.label}: {solution.status}: {solution.status.advice}")
        return solution.displacement(points)

    return _by_differences(model.scene, displacement, STATIC_STEP)


def motion(scene: Scene, run_of: Callable[[Scene, float], History], time: np.ndarray) -> Predictor:
    """Motion from rest; row i of the points is evaluated at time[i] [s]; run_of: a scene's motion so long
    [s]."""
    from scipy.interpolate import CubicSpline

    def displacement(here: Scene, points: np.ndarray) -> np.ndarray:
        places, which = np.unique(points, axis=0, return_inverse=True)
        probes = {f"m{i}": (float(x), float(y)) for i, (x, y) in enumerate(places)}
        here = here.replace(probes=probes)
        run = run_of(here, float(time.max()))
        if run.status is not Status.CONVERGED:
            raise NotReached(f"{run.label}: {run.status}: {run.message}")
        moved = CubicSpline(run.time, np.stack([run.probes[name] for name in probes], axis=1))(time)
        rows: np.ndarray = moved[np.arange(len(time)), which.ravel()]
        return rows

    return _by_differences(scene, displacement, MOTION_STEP)


def _by_differences(
    scene: Scene, displacement: Callable[[Scene, np.ndarray], np.ndarray], step: float
) -> Predictor:
    def predict(unknowns: Sequence[Unknown], x: np.ndarray, points: np.ndarray) -> Prediction:
        slopes: list[Any] = []
        for i, one in enumerate(unknowns):
            ends = np.clip([x[i] - step, x[i] + step], *one.bounds())
            sides = []
            for end in ends:
                moved = x.copy()
                moved[i] = end
                sides.append(displacement(set_in(scene, unknowns, moved), points))
            slopes.append((sides[1] - sides[0]) / (ends[1] - ends[0]))
        return Prediction(displacement(set_in(scene, unknowns, x), points), slopes)

    return predict
