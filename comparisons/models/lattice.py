"""The lattice of a scene, ready to be solved, and what of its settings is looked at before."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import partial
from inspect import Parameter, signature
from typing import Any

from comparisons.models.grading import fixed
from comparisons.models.grids import scene_grid
from comparisons.models.springs import calibrate, check_lattice, has_own_springs, scene_springs
from comparisons.models.symmetry import by_parts, cut_axes
from sheetbench.choices import BRANCHES
from sheetbench.scenes import Iteration, Scene, Solution
from sheetbench.scenes.errors import BadInput, require_choice
from sheetbench.scenes.grading import mirrored

ASIDE = ("training", "large", "progress")  # of `calibrate`, but no settings

Watch = Callable[[Iteration], None]  # called once an iteration
Solve = Callable[[Watch | None], Solution]


def lattice(
    scene: Scene, *, linear: bool = False, symmetry: bool = False, branch: str = "path", **settings: Any
) -> Solve:
    """The lattice with the settings of `scene_springs`, ready to be solved.

    linear: one step with the flat sheet's tangent. symmetry: solve a half or a quarter where scene and grid
    allow it (see `comparisons.models.symmetry`). branch: one of `choices.BRANCHES`.
    """
    import lumped

    springs, because = scene_springs(scene, **settings)
    axes = cut_axes(scene, springs.grid, masses=True) if symmetry and branch == "path" else []
    axes = [axis for axis in axes if mirrored(springs.grading, axis)]
    for axis in axes:
        springs = springs.halved(axis)

    def answer(part: Scene, watch: Watch | None) -> Solution:
        solution = lumped.solve(
            part, springs, linear=linear, branch="stable" if branch == "buckled" else "path", progress=watch
        )
        return replace(solution, settings={**solution.settings, **because})

    return lambda watch: by_parts(scene, axes, partial(answer, watch=watch))


def check_settings(scene: Scene, settings: Mapping[str, Any]) -> None:
    """Raise BadInput for settings of a lattice that it does not have or cannot use on this scene."""
    require_known("lumped", settings, calibrate, lattice)
    require_choice("branch", settings.get("branch", "path"), BRANCHES)
    check_lattice(*(settings.get(name) for name in ("calibration", "k", "layer_distance", "grading")))
    grid = scene_grid(scene, settings.get("grid"))
    if has_own_springs(scene, **settings):
        import lumped

        lumped.given(scene, grid, fixed(settings.get("grading")))


def require_known(model: str, settings: Mapping[str, Any], *functions: Callable[..., Any]) -> None:
    """Raise BadInput for a setting that is none of the functions' keywords."""
    known = [
        parameter.name
        for function in functions
        for parameter in signature(function).parameters.values()
        if parameter.kind is Parameter.KEYWORD_ONLY and parameter.name not in ASIDE
    ]
    for name in settings:
        if name not in known:
            raise BadInput(f"{model}: no setting '{name}'; it has {', '.join(known)}")
