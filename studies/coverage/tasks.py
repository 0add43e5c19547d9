"""The run of the coverage study: one model's answer on one mesh; plain data in and out."""

from __future__ import annotations

from typing import Any

from comparisons.models.context import running
from comparisons.models.resolve import resolve
from comparisons.models.solve import solve
from comparisons.models.spec import Elements
from sheetbench.scenes import Scene


def answer(scene: dict[str, Any], model: str, elements: int, graded: bool = False) -> dict[str, Any]:
    """Displacement [m] at the scene's probes, and the settings of the answer.

    graded: finer towards the edges, where a model chooses.
    """
    parsed = Scene.model_validate(scene)
    with running(large=True):
        solution = solve(resolve(parsed, Elements(model, elements, graded=graded or None)))
    return {
        "status": str(solution.status),
        "message": solution.message,
        "settings": solution.settings,
        "displacement": solution.displacement(parsed.probe_points()),
    }
