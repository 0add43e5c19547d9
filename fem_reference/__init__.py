"""Finite-element references of a sheet on scikit-fem, to which the lumped model is compared.

`solve(scene, model="shell", elements=16)` answers with a `Solution`; models are loaded when first requested.
"""

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
    """Return the static equilibrium of a scene by a reference model.

    Parameters
    ----------
    scene : Scene, str or path
        A scene, the name of one in the catalogue, or a scene file.
    model : {"plate", "shell", "solid"}
        The reference model.
    near : callable, optional
        For the shell: a function from points (n, 3) [m] of the flat sheet to their displacement (n, 3) [m] in
        an estimate of the shape. The equilibrium is sought from there first.
    progress : callable, optional
        Called with an `Iteration` after each iteration.
    **requested : int, tuple, float, bool or str
        `elements`: number along the shorter side, or a pair (nx, ny); 16 by default. Other names: see
        `options`. The law of strain is the material's own, where it has one, unless `law` is given.

    Returns
    -------
    Solution
        Displacements [m], reactions [N], energies [J], status and history.

    Raises
    ------
    BadInput
        For an unknown model or option.
    scenes.SceneError
        For a scene whose supports leave a rigid motion free.

    Notes
    -----
    The shell's path to the full load begins at the equilibrium of a coarser mesh (`shell.coarse_start`).

    Examples
    --------
    >>> import fem_reference
    >>> solution = fem_reference.solve("two-edges-clamped", "shell", elements=8)
    >>> solution.status, solution.displacement([[0.188, 0.188]]).round(4)
    (<Status.CONVERGED: 'converged'>, array([[-0.0004, -0.0004, -0.0135]]))
    """
    check(model, requested)
    from fem_reference import sheets, statics

    scene = scene_of(scene)
    if near is not None and model != "shell":
        raise BadInput(f"{model}: cannot start from a given shape; the shell can")
    require_static(scene, "the plate, which is linear," if model == "plate" else "")
    branch = requested.pop("branch", "path")
    division = sheets.division_of(scene, model, **requested)
    return statics.solve(division, branch, near, progress)


def check(model: str, requested: Mapping[str, Any]) -> None:
    """Raise BadInput for an unknown model, an option that it does not have, or a value of another type.

    Parameters
    ----------
    model : str
        Name of a reference model.
    requested : mapping
        Options by name, `elements` among them or not.

    Raises
    ------
    BadInput
        Names the model's options, or a value of the right type.

    Examples
    --------
    >>> import fem_reference
    >>> fem_reference.check("shell", {"graded": False})
    """
    defaults = options(model)
    for name, value in requested.items():
        if name == "elements":
            continue
        if name not in defaults:
            raise BadInput(f"{model}: no option '{name}'; it has {', '.join(['elements', *defaults])}")
        if isinstance(defaults[name], bool | int | str) and type(value) is not type(defaults[name]):
            raise BadInput(f"{model}: {name} = {value!r}: not a value like {defaults[name]!r}")
        if name == "law":
            require_choice(name, value, {**STRAIN_LAWS, **WORDS})


def options(model: str) -> dict[str, Any]:
    """Return the options of a reference model with their defaults.

    Parameters
    ----------
    model : str
        Name of a reference model.

    Returns
    -------
    dict
        Default values by name, without `elements`.

    Raises
    ------
    BadInput
        For an unknown model.

    Examples
    --------
    >>> import fem_reference
    >>> fem_reference.options("shell")["graded"]
    True
    """
    require_choice("model", model, MODELS)
    from fem_reference.sheets import SHEETS

    _, _, *parameters = signature(SHEETS[model]).parameters.values()  # after scene and elements
    defaults = {p.name: p.default for p in parameters if p.kind is not Parameter.KEYWORD_ONLY}
    return defaults | ({"branch": "path"} if model == "shell" else {})


def __getattr__(name: str) -> Any:
    if name in _LATER:
        return getattr(import_module(_LATER[name]), name)
    raise AttributeError(f"module 'fem_reference' has no attribute {name!r}")
