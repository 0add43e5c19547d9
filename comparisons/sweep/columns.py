"""Optional columns of the table of solves, computed from the answer on request."""

from collections.abc import Callable
from typing import Any

from comparisons.sweep.differences import field_points
from comparisons.sweep.model_error import model_error
from sheetbench.answers.solution import Solution
from sheetbench.scenes import Scene

COLUMNS: dict[str, Callable[[Scene, Solution], Any]] = {
    "field": lambda scene, answer: answer.displacement(field_points(scene)),
    "model_error": lambda scene, answer: bound.value if (bound := model_error(scene, answer)) else None,
}
