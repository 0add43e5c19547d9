"""The one place that knows both solvers: a candidate in, a Solution out.

The solvers are imported when they are first used, so that asking for help stays quick. A model is warmed up
first: what a process pays once, to import and compile, counts neither as set-up nor as solving
(`sheetbench.clock`); the springs of a lattice count as set-up.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from functools import cache, partial
from typing import Any

from comparisons.models import plugins
from comparisons.models.candidate import Candidate
from comparisons.models.grading import Grading
from comparisons.models.grids import GridLike
from comparisons.models.lattice import Solve, Watch, check_settings, lattice
from comparisons.models.pair import check_pair, lattice_pair
from comparisons.models.sizes import mesh, require_room, size
from comparisons.models.springs import LatticeSpec, resolve
from comparisons.models.symmetry import by_parts, cut_axes
from comparisons.report.work import Progress, Work, silent
from sheetbench.choices import ELEMENTS, REFERENCE, REFERENCES
from sheetbench.clock import now
from sheetbench.errors import BadInput, require_choice
from sheetbench.scenes import History, Scene, Solution, load
from sheetbench.scenes.grid import near_square

LATTICES = {"lumped": check_settings, "lumped-pair": check_pair}  # what looks at their settings


def check_reference(
    model: str, elements: int | Sequence[int], options: Mapping[str, Any] | None = None
) -> None:
    """Raise BadInput for a reference model, a number of elements or an option that does not exist."""
    import fem_reference

    require_choice("reference", model, fem_reference.MODELS)
    counts = [elements] if isinstance(elements, int) else elements
    if not (_whole(counts) and len(counts) <= 2):
        raise BadInput(f"elements = {elements!r}: a number along the shorter side, or [nx, ny]")
    if min(counts) < 1:
        raise BadInput(f"elements = {elements}: at least 1")
    fem_reference.check(model, options or {})


def _whole(counts: Any) -> bool:
    return isinstance(counts, list | tuple) and len(counts) > 0 and all(type(n) is int for n in counts)


def simulate(
    scene: Scene,
    duration: float,
    *,
    grid: GridLike = None,
    calibration: str | None = None,
    k: float | None = None,
    layer_distance: float | None = None,
    grading: Grading = None,
    large: bool = False,
    **settings: Any,
) -> History:
    """The lattice's motion over `duration` [s]; settings are those of `lumped.simulate`.

    Raises BadInput for a calibration that does not exist, and as `check` does.
    """
    import lumped

    spec = LatticeSpec(grid, calibration, k, layer_distance, grading)
    check(scene, spec.candidate, large)
    springs, because = spec.springs(scene)
    history = lumped.simulate(scene, springs, duration, **settings)
    return replace(history, settings={**history.settings, **because})


def solve_reference(
    scene: Scene,
    *,
    model: str = REFERENCE,
    elements: int | Sequence[int] = ELEMENTS,
    large: bool = False,
    progress: Progress = silent,
    **options: Any,
) -> Solution:
    """A finite-element reference's static answer; `elements` along the shorter side, or along x and y.

    progress: told what is being done, and of every iteration. Raises BadInput for a model, a number of
    elements or an option that does not exist, and unless `large` for a mesh that takes more memory than there
    is.
    """
    check_reference(model, elements, options)
    asked = Candidate(model, {"elements": elements, **options})
    if not large:
        require_room(scene, asked)
    solve = reference(scene, model=model, elements=elements, **options)
    return solve(_begun(scene, asked, model, progress))


def reference(
    scene: Scene,
    *,
    model: str,
    elements: int | Sequence[int] = ELEMENTS,
    symmetry: bool = False,
    **options: Any,
) -> Solve:
    """A finite-element reference, ready to be solved.

    symmetry: solve a half or a quarter where scene and mesh allow it; of plate and shell only. options: the
    model's own, as the solid's layers.
    """
    import fem_reference

    asked = [elements] if isinstance(elements, int) else list(elements)
    along = list(near_square(scene.sheet, asked[0])) if len(asked) == 1 else asked
    axes = cut_axes(scene, along, masses=False) if symmetry else []
    if axes and model == "solid":
        raise BadInput("solid: is always solved whole; leave symmetry out")
    for axis in axes:
        along[axis] //= 2
    counts = (along[0], along[1])

    def answer(part: Scene, watch: Watch | None) -> Solution:
        return fem_reference.solve(part, model=model, elements=counts, progress=watch, **options)

    return lambda watch: by_parts(scene, axes, partial(answer, watch=watch))


MODELS: dict[str, Callable[..., Solve]] = {
    "lumped": lattice,
    "lumped-pair": lattice_pair,
    **{name: partial(reference, model=name) for name in REFERENCES},
}


def solve(
    scene: Scene, model: str, *, large: bool = False, progress: Progress = silent, **settings: Any
) -> Solution:
    """The answer of any model by its name, with that model's settings, on warm code.

    The name is one of `MODELS` or of an installed plug-in (`comparisons.models.plugins`). Settings are plain
    data. Raises BadInput as `check` does.
    """
    candidate = Candidate(model, settings)
    check(scene, candidate, large)
    return answer(scene, candidate, progress=progress)


def answer(scene: Scene, candidate: Candidate, name: str = "", progress: Progress = silent) -> Solution:
    """The answer of a candidate that `check` has let pass; name: what to call it instead of its model;
    progress: told what is being done, and of every iteration."""
    watch = _begun(scene, candidate, name or plugins.shown_name(candidate.model), progress)
    warm(candidate.model)
    started = now()
    ready = _ready(scene, candidate)
    preparing = now() - started
    solution = ready(watch)
    called = name or solution.model
    spent = solution.setup_seconds + preparing
    return replace(solution, model=called, setup_seconds=spent, points=dict(scene.probes))


def _begun(scene: Scene, candidate: Candidate, name: str, progress: Progress) -> Watch:
    """Say that a candidate is being solved; what says how far it is."""
    work = Work(", ".join(filter(None, [f"solving {name}", mesh(scene, candidate)])), size(scene, candidate))
    progress(work)
    return lambda iteration: progress(work.at(iteration.load_factor))


def _ready(scene: Scene, candidate: Candidate) -> Solve:
    if candidate.model in MODELS:
        return MODELS[candidate.model](scene, **candidate.settings)
    outside = plugins.plugin(candidate.model)
    settings = plugins.settings_of(outside, candidate.settings)
    return lambda watch: plugins.answer(outside, scene, settings)


def check(scene: Scene, candidate: Candidate, large: bool = False, option: str = "") -> None:
    """Raise BadInput for a model that does not exist, settings that it cannot use on this scene, and unless
    `large` for one that takes more memory than there is.

    option: by which its size is asked for, see `comparisons.models.sizes.require_room`.
    """
    _check_settings(scene, candidate)
    if not large:
        require_room(scene, candidate, option)
        if candidate.model in LATTICES:
            resolve(scene, LatticeSpec.of(candidate.settings)).require_room_to_fit(scene)


def _check_settings(scene: Scene, candidate: Candidate) -> None:
    model, settings = candidate.model, candidate.settings
    if model in LATTICES:
        LATTICES[model](scene, settings)
    elif model in MODELS:
        own = {name: value for name, value in settings.items() if name not in ("elements", "symmetry")}
        check_reference(model, settings.get("elements", ELEMENTS), own)
    else:
        known = [*MODELS, *plugins.names()]
        if model not in known and not plugins.is_outside(model):
            raise BadInput(f"model = '{model}': unknown, choose one of {', '.join(known)}. {plugins.OWN}")
        plugins.settings_of(plugins.plugin(model), settings)


@cache
def warm(model: str) -> None:
    """Import and compile what a model needs, once in a process: solve a coarse sheet, load a plug-in."""
    if model not in MODELS:
        plugins.plugin(model)
        return
    coarse = {"grid": (3, 3, 2)} if model in LATTICES else {"elements": 2}
    MODELS[model](load("one-edge-clamped"), **coarse)(None)
