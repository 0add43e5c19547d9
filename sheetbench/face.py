"""Functions of `import sheetbench`: the verbs of the command line, made from the same declarations, and one
model's answer alone.

Those with `workers` compute in processes of their own: a script calls them under `if __name__ ==
"__main__":`.
"""

from __future__ import annotations

from collections.abc import Callable
from importlib import import_module
from typing import Any

from comparisons.cli.study import module_of
from comparisons.cli.verb import as_function
from comparisons.models import solve as solvers
from comparisons.models.context import running
from comparisons.models.resolve import resolve
from comparisons.models.spec import Lattice, Spec, parse, spec_of
from sheetbench.answers.solution import Solution
from sheetbench.errors import BadInput
from sheetbench.scenes import AnyScene, Scene, scene_of
from sheetbench.scenes.meaning.plausibility import warn_of_slips


def verb(name: str) -> Callable[..., Any]:
    """Return a verb of the command line as a function."""
    return as_function(name, import_module(f"comparisons.cli.{name}").command)


def study(name: str, **options: Any) -> Any:
    """Return the answer of a study: "reproduction", and in a checkout those of `studies`; options: its own,
    as of `sheetbench study NAME --help`."""
    return as_function(name, module_of(str(name)).command)(**options)


def solve(
    scene: AnyScene,
    model: Spec | str = Lattice.NAME,
    *,
    large: bool = False,
    progress: Callable[[Any], None] | None = None,
    **settings: Any,
) -> Solution:
    """The static answer of one model: a spec, as `Lattice`, or "lumped", "plate", "shell", "solid", or a
    plug-in's name, or text as "lumped:grid=9x5,k=550".

    settings: further ones of the model; of the lattice `grid`, `grading`, `calibration`, `k`,
    `layer_distance`; of the references `elements`. Raises SceneError for a scene that could float away,
    BadInput for a model or setting that does not exist and for one that takes more memory than there is,
    unless `large = True`; a solve that fails is a status.
    """
    spec = parse(model) if isinstance(model, str) else model
    if not isinstance(spec, Spec):
        raise BadInput(f"solve: model = {model!r}: a name as 'lumped' or 'shell', or a spec, is needed")
    if settings:
        spec = spec_of(spec.model, {**spec.settings, **settings})
    if isinstance(scene, Scene):
        warn_of_slips([(f"scene '{scene.name}'", scene)], stacklevel=2)
    held: dict[str, Any] = {"large": True} if large else {}
    with running(**held, **({} if progress is None else {"progress": progress})):
        return solvers.solve(resolve(scene_of(scene), spec))
