"""Finite-element references of the sheet on scikit-fem, which the lumped model is held against.

`solve(scene, model="shell", elements=16)` answers with a `Solution`; models are loaded when they are first
requested.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from importlib import import_module
from inspect import Parameter, signature
from typing import Any

import numpy as np

from sheetbench.answers.solution import Iteration, Solution
from sheetbench.choices import REFERENCE, REFERENCES, STRAIN_LAWS
from sheetbench.errors import BadInput, require_choice
from sheetbench.scenes import AnyScene, require_static, scene_of
from sheetbench.scenes.objects.material import WORDS

MODELS = tuple(REFERENCES)

_LATER = {"buckling": "fem_reference.linear_buckling", "modes": "fem_reference.vibration"}
_LATER |= dict.fromkeys(("simulate", "require_moving"), "fem_reference.motion.simulation")

__all__ = ["MODELS", "buckling", "check", "modes", "options", "require_moving", "simulate", "solve"]


def solve(
    scene: AnyScene,
    model: str = REFERENCE,
    *,
    near: Callable[[np.ndarray], np.ndarray] | None = None,
    progress: Callable[[Iteration], None] | None = None,
    **requested: Any,
) -> Solution:
    """The static answer of a reference model; `elements` along the shorter side, or a pair (nx, ny).

    near: of the shell, the displacement (n, 3) [m] of what lies at (n, 3) [m] in the flat sheet, in an
    equilibrium to be sought from first. progress: called once an iteration. The law of strain is the
    material's own, where it has one, unless `law` is requested.
    Raises BadInput for an unknown model or option, scenes.SceneError for a scene that no support holds.

    >>> import fem_reference
    >>> solution = fem_reference.solve("two-edges-clamped", "shell", elements=8)
    >>> solution.status, solution.displacement([[0.188, 0.188]]).round(4)
    (<Status.CONVERGED: 'converged'>, array([[-0.0004, -0.0004, -0.0135]]))
    """
    check(model, requested)
    from fem_reference import sheets, statics

    scene = scene_of(scene)
    if near is not None and model != "shell":
        raise BadInput(f"{model}: is not begun near a shape; the shell is")
    require_static(scene, "the plate, which is linear," if model == "plate" else "")
    branch = requested.pop("branch", "path")
    division = sheets.division_of(scene, model, **requested)
    return statics.solve(division, branch, near, progress)


def check(model: str, requested: Mapping[str, Any]) -> None:
    """Raise BadInput for a model that does not exist, an option it does not have, or one of another type."""
    known = options(model)
    for name, value in requested.items():
        if name == "elements":
            continue
        if name not in known:
            raise BadInput(f"{model}: no option '{name}'; it has {', '.join(['elements', *known])}")
        if isinstance(known[name], bool | int | str) and type(value) is not type(known[name]):
            raise BadInput(f"{model}: {name} = {value!r}: not a value like {known[name]!r}")
        if name == "law":
            require_choice(name, value, {**STRAIN_LAWS, **WORDS})


def options(model: str) -> dict[str, Any]:
    """A reference model's own options with their defaults. Raises BadInput for an unknown model."""
    require_choice("model", model, MODELS)
    from fem_reference.sheets import SHEETS

    _, _, *own = signature(SHEETS[model]).parameters.values()  # behind scene and elements
    found = {p.name: p.default for p in own if p.kind is not Parameter.KEYWORD_ONLY}
    return found | ({"branch": "path"} if model == "shell" else {})


def __getattr__(name: str) -> Any:
    if name in _LATER:
        return getattr(import_module(_LATER[name]), name)
    raise AttributeError(f"module 'fem_reference' has no attribute {name!r}")
