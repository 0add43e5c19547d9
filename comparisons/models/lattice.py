"""The lattice of a scene, ready to be solved, and what of its settings is looked at before."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import partial
from inspect import Parameter, signature
from typing import Any

from comparisons.models.springs import LatticeSpec, resolve
from comparisons.models.symmetry import by_parts, cut_axes
from sheetbench.choices import BRANCHES
from sheetbench.errors import BadInput, require_choice
from sheetbench.scenes import Iteration, Scene, Solution
from sheetbench.scenes.grading import mirrored

Watch = Callable[[Iteration], None]  # called once an iteration
Solve = Callable[[Watch | None], Solution]


def lattice(
    scene: Scene, *, linear: bool = False, symmetry: bool = False, branch: str = "path", **settings: Any
) -> Solve:
    """The lattice with the settings of a `LatticeSpec`, ready to be solved.

    linear: one step with the flat sheet's tangent. symmetry: solve a half or a quarter where scene and grid
    allow it (see `comparisons.models.symmetry`). branch: one of `choices.BRANCHES`.
    """
    import lumped

    springs, because = LatticeSpec(**settings).springs(scene)
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
    require_known("lumped", settings, LatticeSpec, lattice)
    require_choice("branch", settings.get("branch", "path"), BRANCHES)
    meant = resolve(scene, LatticeSpec.of(settings))
    if meant.calibration is None:
        meant.springs(scene)


def require_known(model: str, settings: Mapping[str, Any], *functions: Callable[..., Any]) -> None:
    """Raise BadInput for a setting that none of the functions takes beside a scene."""
    takes = {name: one.kind for function in functions for name, one in signature(function).parameters.items()}
    known = [name for name, kind in takes.items() if name != "scene" and kind is not Parameter.VAR_KEYWORD]
    for name in settings:
        if name not in known:
            raise BadInput(f"{model}: no setting '{name}'; it has {', '.join(known)}")
