"""The run of the coverage study: one model's answer on one mesh; plain data in and out."""

from __future__ import annotations

from typing import Any

from comparisons.models.registry import solve_reference
from sheetbench.scenes import Scene


def answer(scene: dict[str, Any], model: str, elements: int, graded: bool = False) -> dict[str, Any]:
    """Displacement [m] at the scene's probes, and the settings of the answer.

    graded: finer towards the edges, where a model chooses.
    """
    asked = Scene.model_validate(scene)
    own: dict[str, Any] = {"graded": True} if graded else {}
    solution = solve_reference(asked, model=model, elements=elements, large=True, **own)
    return {
        "status": str(solution.status),
        "message": solution.message,
        "settings": solution.settings,
        "displacement": solution.displacement(asked.probe_points()),
    }
