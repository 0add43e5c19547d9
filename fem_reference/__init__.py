"""Finite-element references of the sheet on scikit-fem: the judge of the lumped model.

`solve(scene, model="shell", elements=16)` answers with a `scenes.Solution`; a model is a module with
`solve(scene, elements=…, **options)`, loaded when it is first asked for.
"""

from __future__ import annotations

from importlib import import_module
from typing import Any

from sheetbench.scenes import Scene, Solution

MODELS = {
    "plate": "fem_reference.plate.statics",
    "shell": "fem_reference.shell.statics",
    "solid": "fem_reference.solid.statics",
}

__all__ = ["MODELS", "modes", "solve"]


def solve(scene: Scene, model: str = "shell", **options: Any) -> Solution:
    """The static answer of a reference model; `elements` along the shorter side, or a pair (nx, ny).

    Raises ValueError for an unknown model, scenes.SceneError for a scene that no support holds.
    """
    if model not in MODELS:
        raise ValueError(f"model = {model!r}: known are {', '.join(MODELS)}")
    return import_module(MODELS[model]).solve(scene, **options)


def __getattr__(name: str) -> Any:
    if name == "modes":
        return import_module("fem_reference.vibration").modes
    raise AttributeError(f"module 'fem_reference' has no attribute {name!r}")
