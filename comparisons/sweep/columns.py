"""Further columns of the table of solves, each computed beside the answer where it is wanted."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from comparisons.sweep.differences import error
from comparisons.sweep.model_error import model_error
from sheetbench.answers.solution import Solution
from sheetbench.scenes import Scene


def own_bar(scene: Scene, answer: Solution) -> float | None:
    """By how much the model says that it may be off at the probes, a fraction."""
    if answer.bar is None:
        return None
    points = scene.probe_points()
    u = answer.displacement(points)
    return error(u + answer.bar(points), u)


COLUMNS: dict[str, Callable[[Scene, Solution], Any]] = {
    "bar": own_bar,
    "model_error": lambda scene, answer: left.value if (left := model_error(scene, answer)) else None,
}
