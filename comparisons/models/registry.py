"""The one place that knows both solvers: a candidate in, a Solution out.

The solvers are imported when they are first used, so that asking for help stays quick. A model is warmed up
first: what a process pays once, to import and compile, counts as set-up and not as solving, and so do the
springs of a lattice.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from functools import cache, partial
from inspect import Parameter, signature
from math import isfinite
from time import perf_counter
from typing import TYPE_CHECKING, Any
from warnings import warn

from comparisons.models import plugins
from comparisons.models.candidate import Candidate
from comparisons.models.grids import Asked, scene_grid
from comparisons.models.sizes import require_room
from comparisons.models.symmetry import cut_axes, half, whole
from sheetbench.choices import CALIBRATION, CALIBRATIONS, ELEMENTS, REFERENCE, REFERENCES
from sheetbench.scenes import History, Material, Scene, Sheet, Solution, load
from sheetbench.scenes.errors import BadInput, Implausible, require_choice
from sheetbench.scenes.grid import MASSES, grid_of, near_square
from sheetbench.scenes.plausibility import layer_slips

if TYPE_CHECKING:
    from lumped import Calibration


def calibrate(
    sheet: Sheet,
    material: Material,
    *,
    grid: int | Sequence[int] = MASSES,
    calibration: str | None = None,
    k: float | None = None,
    layer_distance: float | None = None,
    grading: float = 0.0,
    training: Sequence[Scene] | None = None,
    large: bool = False,
) -> Calibration:
    """Springs of a lattice; by default consistent ones for nine masses along the shorter side.

    grid: a number is along the shorter side, with near-square cells; or (nx, ny), (nx, ny, layers).

    k [N/m] and layer_distance [m] are the calibration's own options; grading: from 0, cells of one size,
    to 1, cells finest at the edges (`lumped.grid_lines`); training: the scenes that a fitted one is fitted
    to, see `comparisons.models.training`. Raises BadInput for a name that is not a calibration or lengths
    that are not above zero, for options it does not take, and unless `large` for a fit that takes more memory
    than there is; warns of a layer distance that is hardly meant.
    """
    check_lattice(calibration, k, layer_distance, grading)
    if not large and k is None and _is_fitted(calibration):
        from comparisons.models.training import training_scenes

        for scene in training_scenes(sheet, material) if training is None else training:
            _require_room_to_fit(scene, grid)
    return _calibrate(sheet, material, grid, calibration, k, layer_distance, grading, training)


def _calibrate(
    sheet: Sheet,
    material: Material,
    grid: int | Sequence[int],
    calibration: str | None = None,
    k: float | None = None,
    layer_distance: float | None = None,
    grading: float = 0.0,
    training: Sequence[Scene] | None = None,
) -> Calibration:
    import lumped

    if layer_distance is not None:
        for said in layer_slips(sheet, layer_distance, "layer-distance"):
            warn(Implausible(said), stacklevel=2)
    method = calibration or CALIBRATION
    if k is None and _is_fitted(calibration):
        from comparisons.models.training import fitted

        return fitted(sheet, material, grid_of(sheet, grid), method, layer_distance, grading, training)
    own: dict[str, Any] = {"k": k, "layer_distance": layer_distance, "grading": grading}
    return lumped.calibrate(sheet, material, grid=grid, method=method, **own)


def _is_fitted(calibration: str | None) -> bool:
    return CALIBRATIONS[calibration or CALIBRATION].fitted


def _require_room_to_fit(scene: Scene, grid: int | Sequence[int]) -> None:
    """Raise BadInput where there is too little memory for a lattice or for the shell that it is fitted to."""
    from comparisons.models.training import ELEMENTS

    require_room(scene, Candidate("lumped", {"grid": grid}))
    instead = "take a calibration that is not fitted"
    require_room(scene, Candidate("shell", {"elements": ELEMENTS}), instead=instead)


def check_lattice(
    calibration: str | None, k: float | None, layer_distance: float | None, grading: float | None = None
) -> None:
    """Raise BadInput for a calibration that does not exist, k or layer_distance not above zero, or a grading
    that is not from 0 to 1."""
    import lumped

    if grading is not None and not (isinstance(grading, int | float) and 0.0 <= grading <= 1.0):
        raise BadInput(f"grading = {grading}: a number from 0 (cells of one size) to 1 (finest at the edges)")

    if calibration is not None:
        require_choice("calibration", calibration, lumped.CALIBRATIONS)
    for name, value, unit in (("k", k, "N/m"), ("layer-distance", layer_distance, "m")):
        if value is not None and not (value > 0 and isfinite(value)):
            raise BadInput(f"{name} = {value:g} {unit}: must be greater than 0 and finite")


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


def has_own_springs(scene: Scene, **settings: Any) -> bool:
    """Whether the scene's own [springs] are to be used: it has them and nothing else is asked for."""
    chosen = (settings.get(name) for name in ("calibration", "k", "layer_distance"))
    return scene.springs is not None and all(choice is None for choice in chosen)


def scene_springs(
    scene: Scene, *, grid: Asked = None, grading: float | None = None, **settings: Any
) -> Calibration:
    """Springs of a lattice for a scene, with settings of `calibrate` that `check` has seen: its own [springs]
    if it has them and no calibration, k or layer distance is given, on their own grid and grading. grid: as
    `comparisons.models.grids` reads it; grading: 0 unless given."""
    import lumped

    masses = scene_grid(scene, grid)
    if has_own_springs(scene, **settings):
        return lumped.given(scene, masses, grading)
    return _calibrate(scene.sheet, scene.material, masses, grading=grading or 0.0, **settings)


Solve = Callable[[], Solution]


def lattice(scene: Scene, *, linear: bool = False, symmetry: bool = False, **settings: Any) -> Solve:
    """The lattice with the settings of `scene_springs`, ready to be solved.

    linear: one step with the flat sheet's tangent. symmetry: solve a half or a quarter where scene and grid
    allow it (see `comparisons.models.symmetry`).
    """
    import lumped

    springs = scene_springs(scene, **settings)
    axes = cut_axes(scene, springs.grid, masses=True) if symmetry else []
    for axis in axes:
        springs = springs.halved(axis)
    return lambda: _by_parts(scene, axes, lambda part: lumped.solve(part, springs, linear=linear))


def simulate(
    scene: Scene,
    duration: float,
    *,
    grid: Asked = None,
    grading: float | None = None,
    calibration: str | None = None,
    large: bool = False,
    **settings: Any,
) -> History:
    """The lattice's motion over `duration` [s]; settings are those of `lumped.simulate`.

    Raises BadInput for a calibration that does not exist, and as `check` does.
    """
    import lumped

    check(scene, Candidate("lumped", {"grid": grid, "calibration": calibration, "grading": grading}), large)
    springs = scene_springs(scene, grid=grid, grading=grading, calibration=calibration)
    return lumped.simulate(scene, springs, duration, **settings)


def solve_reference(
    scene: Scene,
    *,
    model: str = REFERENCE,
    elements: int | Sequence[int] = ELEMENTS,
    large: bool = False,
    **options: Any,
) -> Solution:
    """A finite-element reference's static answer; `elements` along the shorter side, or along x and y.

    Raises BadInput for a model, a number of elements or an option that does not exist, and unless `large` for
    a mesh that takes more memory than there is.
    """
    check_reference(model, elements, options)
    if not large:
        require_room(scene, Candidate(model, {"elements": elements, **options}))
    return reference(scene, model=model, elements=elements, **options)()


def reference(
    scene: Scene,
    *,
    model: str,
    elements: int | Sequence[int] = 16,
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

    def answer(part: Scene) -> Solution:
        return fem_reference.solve(part, model=model, elements=counts, **options)

    return lambda: _by_parts(scene, axes, answer)


def _by_parts(scene: Scene, axes: Sequence[int], answer: Callable[[Scene], Solution]) -> Solution:
    """The answer for the whole scene from that for the part left after halving across `axes`."""
    if not axes:
        return answer(scene)
    scenes = [scene]
    for axis in axes:
        scenes.append(half(scenes[-1], axis))
    solution = answer(scenes[-1])
    for axis, of in zip(reversed(axes), reversed(scenes[:-1]), strict=True):
        solution = whole(solution, of, axis)
    cut = "half" if len(axes) == 1 else "quarter"
    settings: dict[str, Any] = {**solution.settings, "symmetry": ["xy"[axis] for axis in axes]}
    for name in {"grid", "elements"} & set(settings):
        size = list(settings[name])
        for axis in axes:
            size[axis] = 2 * size[axis] - (name == "grid")
        settings[name] = size
    return replace(solution, label=f"{solution.label}, a {cut} of the sheet", settings=settings)


MODELS: dict[str, Callable[..., Solve]] = {
    "lumped": lattice,
    **{name: partial(reference, model=name) for name in REFERENCES},
}


def solve(scene: Scene, model: str, *, large: bool = False, **settings: Any) -> Solution:
    """The answer of any model by its name, with that model's settings, on warm code.

    The name is one of `MODELS` or of an installed plug-in (`comparisons.models.plugins`). Settings are plain
    data. Raises BadInput as `check` does.
    """
    candidate = Candidate(model, settings)
    check(scene, candidate, large)
    return answer(scene, candidate)


def answer(scene: Scene, candidate: Candidate, name: str = "") -> Solution:
    """The answer of a candidate that `check` has let pass; name: what to call it instead of its model."""
    started = perf_counter()
    warm(candidate.model)
    ready = _ready(scene, candidate)
    preparing = perf_counter() - started
    solution = ready()
    called = name or solution.model
    return replace(solution, model=called, setup_seconds=solution.setup_seconds + preparing)


def _ready(scene: Scene, candidate: Candidate) -> Solve:
    if candidate.model in MODELS:
        return MODELS[candidate.model](scene, **candidate.settings)
    outside = plugins.plugin(candidate.model)
    return partial(outside.solve, scene, plugins.settings_of(outside, candidate.settings))


def check(scene: Scene, candidate: Candidate, large: bool = False, option: str = "") -> None:
    """Raise BadInput for a model that does not exist, settings that it cannot use on this scene, and unless
    `large` for one that takes more memory than there is.

    option: by which its size is asked for, see `comparisons.models.sizes.require_room`.
    """
    _check_settings(scene, candidate)
    if not large:
        require_room(scene, candidate, option)
        fitted = candidate.model == "lumped" and _is_fitted(candidate.settings.get("calibration"))
        if fitted and candidate.settings.get("k") is None:
            _require_room_to_fit(scene, scene_grid(scene, candidate.settings.get("grid")))


def _check_settings(scene: Scene, candidate: Candidate) -> None:
    model, settings = candidate.model, candidate.settings
    if model == "lumped":
        known = [*_keywords(calibrate), *_keywords(lattice)]
        unknown = [name for name in settings if name not in known]
        if unknown:
            raise BadInput(f"lumped: no setting '{unknown[0]}'; it has {', '.join(known)}")
        check_lattice(*(settings.get(name) for name in ("calibration", "k", "layer_distance", "grading")))
        grid = scene_grid(scene, settings.get("grid"))
        if has_own_springs(scene, **settings):
            import lumped

            lumped.given(scene, grid, settings.get("grading"))
    elif model in MODELS:
        own = {name: value for name, value in settings.items() if name not in ("elements", "symmetry")}
        check_reference(model, settings.get("elements", 16), own)
    else:
        known = [*MODELS, *plugins.names()]
        if model not in known and plugins.from_file(model) is None:
            raise BadInput(f"model = '{model}': unknown, choose one of {', '.join(known)}. {plugins.OWN}")
        plugins.settings_of(plugins.plugin(model), settings)


def _keywords(function: Callable[..., Any]) -> list[str]:
    parameters = signature(function).parameters.values()
    return [parameter.name for parameter in parameters if parameter.kind is Parameter.KEYWORD_ONLY]


@cache
def warm(model: str) -> None:
    """Import and compile what a model needs, once in a process: solve a coarse sheet, load a plug-in."""
    if model not in MODELS:
        plugins.plugin(model)
        return
    coarse = {"grid": (3, 3, 2)} if model == "lumped" else {"elements": 2}
    MODELS[model](load("one-edge-clamped"), **coarse)()
