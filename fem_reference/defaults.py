"""Options of a reference that a scene decides where nobody does: one rule for solve, modes and simulate."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from typing import Any

from sheetbench.scenes import Scene


def with_defaults(scene: Scene, known: Collection[str], requested: Mapping[str, Any]) -> dict[str, Any]:
    """Return the options requested and, of those that a model knows, the law of the scene's rubber and that a
    mesh of the user's own is not graded."""
    decided: dict[str, Any] = {}
    if scene.material.law is not None:
        decided["law"] = scene.material.law
    if scene.sheet.mesh is not None:
        decided["graded"] = False
    return {name: value for name, value in decided.items() if name in known} | dict(requested)
