"""Functions of `import sheetbench`: the verbs, studies, and the static answer of one model.

Verbs are made from the declarations of the command line. Functions with `workers` start processes: a script
calls them under `if __name__ == "__main__":`.
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
    """Return the answer of a study.

    Parameters
    ----------
    name : str
        Name of a study, as `sheetbench study` lists them; studies are in a checkout of the repository.
    **options
        The study's own options, listed by `sheetbench study NAME --help`.

    Returns
    -------
    Answer
        The study's tables, figures and notes.

    Raises
    ------
    BadInput
        An unknown study or option, or no checkout.
    """
    return as_function(name, module_of(str(name)).command)(**options)


def solve(
    scene: AnyScene,
    model: Spec | str = Lattice.NAME,
    *,
    large: bool = False,
    progress: Callable[[Any], None] | None = None,
    **settings: Any,
) -> Solution:
    """Solve a static scene with one model.

    Parameters
    ----------
    scene : Scene, str or Path
        A scene, a catalogue name or a path to a TOML file.
    model : Lattice, Elements, External or str
        A specification, a name ("lumped", "plate", "shell", "solid" or a plug-in's), or a text as
        "lumped:grid=9x5,k=550".
    large : bool
        Allow a solve that needs more memory than is free.
    progress : callable, optional
        Called with the progress of the solve.
    **settings
        Further settings of the model: of the lattice `grid`, `grading`, `calibration`, `k`,
        `layer_distance`; of the references `elements`.

    Returns
    -------
    Solution
        The answer; a solve that fails has the failure as its status.

    Raises
    ------
    SceneError
        A scene with a free rigid motion.
    BadInput
        An unknown model or setting, or too little memory.

    Examples
    --------
    >>> import sheetbench as sb
    >>> solution = sb.solve("two-edges-clamped", grid=5)
    >>> str(solution.status)
    'converged'
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
