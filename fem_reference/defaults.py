"""Options of a reference that a scene decides where nobody does: one rule for solve, modes and simulate."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from typing import Any

from fem_reference.surface.borders import borders_of
from sheetbench.scenes import Scene


def with_defaults(scene: Scene, known: Collection[str], requested: Mapping[str, Any]) -> dict[str, Any]:
    """Return the options requested and, of those that a model knows, the law of the scene's rubber, and that
    a mesh is not graded which is the user's own, or whose edges are all clamped.

    These have no layer of twist (`edge_layer`); elements finer towards them are only larger elsewhere: with 8
    a sheet bent by less than its thickness is 3 to 30 times as far off, and its error bars miss."""
    decided: dict[str, Any] = {}
    if scene.material.law is not None:
        decided["law"] = scene.material.law
    if scene.sheet.mesh is not None or not (scene.twisting_edges() or borders_of(scene)):
        decided["graded"] = False
    return {name: value for name, value in decided.items() if name in known} | dict(requested)
