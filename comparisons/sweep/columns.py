"""Further columns of the table of solves, each computed beside the answer where it is wanted."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from comparisons.pictures.plan import inside
from comparisons.sweep.differences import error
from comparisons.sweep.model_error import model_error
from sheetbench.answers.solution import Solution
from sheetbench.scenes import Scene

GAUSS_POINTS = 24  # along each side, for norms over the sheet


def field_points(scene: Scene) -> tuple[np.ndarray, np.ndarray]:
    """Return Gauss points (n, 2) [m] of the rectangle that lie on the sheet, and their shares (n,) of its
    area."""
    at, weight = np.polynomial.legendre.leggauss(GAUSS_POINTS)
    x, y = np.meshgrid(*(0.5 * (1.0 + at) * length for length in scene.sheet.lengths), indexing="ij")
    points, weights = np.column_stack([x.ravel(), y.ravel()]), np.outer(weight, weight).ravel()
    there = inside(scene, points)
    return points[there], weights[there] / weights[there].sum()


def own_bar(scene: Scene, answer: Solution) -> float | None:
    """By how much the model says that it may be off at the probes, a fraction."""
    if answer.bar is None:
        return None
    points = scene.probe_points()
    u = answer.displacement(points)
    return error(u + answer.bar(points), u)


COLUMNS: dict[str, Callable[[Scene, Solution], Any]] = {
    "field": lambda scene, answer: answer.displacement(field_points(scene)[0]),
    "bar": own_bar,
    "model_error": lambda scene, answer: left.value if (left := model_error(scene, answer)) else None,
}
