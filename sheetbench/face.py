"""Functions of `import sheetbench` that need extra set-up: springs, a campaign to keep rows in.

The other verbs of `sheetbench` are the functions of the packages below, as they are.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, Unpack, overload

from comparisons.models import solve as solvers
from comparisons.models.context import in_context, large_in_context
from comparisons.models.grids import Elements as Count
from comparisons.models.grids import GridLike
from comparisons.models.keywords import LatticeKeywords, SpringKeywords, StaticKeywords
from comparisons.models.resolve import resolve
from comparisons.models.spec import Elements, Lattice, Spec, parse, spec_of
from comparisons.report.work import silent
from sheetbench.choices import INTEGRATOR, REFERENCE, REFERENCES
from sheetbench.errors import BadInput, require_effect
from sheetbench.scenes import AnyScene, History, Solution, scene_of
from sheetbench.scenes.units import amount

if TYPE_CHECKING:
    from comparisons.comparison.answer import Comparison
    from comparisons.motion.comparison_answer import MotionComparison
    from comparisons.runs.campaign import Progress
    from comparisons.tradeoff.answer import DynamicTradeoff, Tradeoff
    from lumped import Calibration


@in_context
def calibrate(
    scene: AnyScene | None = None,
    lattice: Lattice | None = None,
    *,
    young: float | str | None = None,
    poisson: float | None = None,
    thickness: float | str | None = None,
    side: float | str | Sequence[float | str] | None = None,
    density: float | str | None = None,
    large: bool = False,
    **keywords: Unpack[LatticeKeywords],
) -> Calibration:
    """Return the spring constants of a lattice for a sheet and material, with the moduli that they meet.

    The sheet and material are the scene's, with young [Pa], poisson, thickness [m], side [m] (one number, or
    along x and y) and density [kg/m³] in place of its own; without a scene those alone, 1000 kg/m³ unless
    given. Text may have a unit, as "2 mm".
    lattice, or its flat keywords: grid, 9 along the shorter side with near-square cells unless given;
    (nx, ny), (nx, ny, layers). calibration: a name of `lumped.CALIBRATIONS`, consistent unless given, or
    "auto", as the scene's edges and load have it and as goes with the grading "auto"; the fitted ones train
    on the scene. k [N/m] and layer_distance [m] are for
    the calibrations that take them. grading: 0, cells of one size, to 1, finest at the edges, or "auto", as
    the scene's layers need. Raises BadInput for what does not exist or go together, and unless `large` for a
    fit that takes more memory than there is.
    """
    from comparisons.calibration.calibrate import calibrate, subject

    sides = [side] if isinstance(side, float | int | str | None) else side
    values = {"young": young, "poisson": poisson, "thickness": thickness, "density": density}
    of = subject(scene, {**values, "length_x": sides[0], "length_y": sides[-1]})
    return calibrate(of, Lattice.given(lattice, keywords), named=scene is not None)


@in_context
def solve(
    scene: AnyScene,
    model: Spec | str = Lattice.NAME,
    *,
    large: bool = False,
    progress: Callable[[Any], None] = silent,
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
    return solvers.solve(resolve(scene_of(scene), spec))


@large_in_context
def simulate(
    scene: AnyScene,
    duration: float | str,
    lattice: Lattice | None = None,
    *,
    integrator: str = INTEGRATOR,
    step: float | str | None = None,
    every: float | str | None = None,
    store: Path | None = None,
    frames: int = 0,
    progress: Callable[[float], None] | None = None,
    precision: str = "double",
    error: float | None = None,
    radius: float | None = None,
    large: bool = False,
    **keywords: Unpack[LatticeKeywords],
) -> History:
    """The lattice's motion from rest over `duration` [s], loads and weight on at t = 0.

    integrator to frames, and precision: as of `lumped.simulate`; error, radius: of the integrators that have
    them; progress: called with the time reached.
    """
    model = resolve(scene_of(scene), Lattice.given(lattice, keywords), "motion")
    duration = amount("duration", duration, "s")
    step, every = (value and amount(name, value, "s") for name, value in (("step", step), ("every", every)))
    run: dict[str, Any] = {"integrator": integrator, "step": step, "every": every, "store": store}
    run |= {name: value for name, value in (("error", error), ("radius", radius)) if value is not None}
    return solvers.simulate(model, duration, **run, frames=frames, precision=precision, progress=progress)


@overload
def compare(
    scene: AnyScene,
    lattice: Lattice | None = None,
    reference: Elements | str = REFERENCE,
    *,
    duration: None = None,
    **settings: Any,
) -> Comparison: ...


@overload
def compare(
    scene: AnyScene,
    lattice: Lattice | None = None,
    reference: Elements | str = REFERENCE,
    *,
    duration: float | str,
    **settings: Any,
) -> MotionComparison: ...


@in_context  # type: ignore[misc]  # the overloads leave their keywords to this signature
def compare(
    scene: AnyScene,
    lattice: Lattice | None = None,
    reference: Elements | str = REFERENCE,
    *,
    duration: float | str | None = None,
    elements: Count | None = None,
    law: str | None = None,
    uncertainty: bool | None = None,
    companion: bool = True,
    models: Sequence[Spec | str] = (),
    every: float | None = None,
    frames: int = 0,
    large: bool = False,
    progress: Callable[[Any], None] = silent,
    **keywords: Unpack[StaticKeywords],
) -> Comparison | MotionComparison:
    """The lattice beside a reference: at rest, or over `duration` [s] of motion.

    lattice: a `Lattice`, or its flat keywords: 9 masses along the shorter side unless given. reference: an
    `Elements`, or "plate", "shell" or "solid" with elements, 16 unless given and 8 in motion, and law of
    strain. uncertainty: find the reference's error bar too. models: shown beside both. At rest:
    companion, and symmetry, branch and linear of the lattice, as of
    `comparisons.comparison.comparison.compare`; in motion: every, frames, as of
    `comparisons.motion.comparison.compare_motion`. Raises SceneError for a scene without an answer, BadInput
    for choices that do not exist or contradict each other; a solve that fails is a status.
    """
    both: dict[str, Any] = {"elements": elements, "law": law, **keywords}
    if duration is not None:
        from comparisons.motion.comparison import compare_motion

        statics = {name: keywords.get(name) for name in ("linear", "symmetry", "branch")}
        require_effect("with a duration", {"companion": None if companion else "off", **statics})
        both |= {"uncertainty": uncertainty is not False, "every": every, "frames": frames}
        both |= {"models": models}
        return compare_motion(scene, amount("duration", duration, "s"), lattice, reference, **both)
    from comparisons.comparison.comparison import compare

    require_effect("without a duration", {"every": every, "frames": frames or None})
    both |= {"uncertainty": uncertainty, "companion": companion, "models": models}
    return compare(scene, lattice, reference, **both)


@large_in_context
def tradeoff(
    scene: AnyScene,
    lattice: Lattice | None = None,
    *,
    grid: Sequence[GridLike] | str | None = None,
    lumped_pair: Sequence[str] | str | None = None,
    calibration: Sequence[str] | str | None = None,
    plate: Sequence[Count] | str | None = None,
    shell: Sequence[Count] | str | None = None,
    solid: Sequence[Count] | str | None = None,
    models: Sequence[Spec | str] = (),
    symmetry: bool = False,
    elements: Count | str | None = None,
    repeats: int | None = None,
    duration: float | str | None = None,
    integrator: Sequence[str] | str | None = None,
    workers: int = 1,
    out: Path | str | None = None,
    large: bool = False,
    progress: Callable[[Progress], None] = silent,
    **keywords: Unpack[SpringKeywords],
) -> Tradeoff | DynamicTradeoff:
    """Error against time over lattices (grids), references (elements along the shorter side) and others: at
    rest, or of the motion over `duration` [s].

    Lists are as the command has them, and have its defaults (`comparisons.tradeoff.usual`): sequences, or
    text as "3,5,9"; an empty one leaves a model out. lumped_pair: pairs of grids, "5:9", extrapolated.
    lattice, k, layer_distance: what all lattices have; grading: likewise, where the calibration takes one.
    models: further ones, plug-ins too. symmetry: solve a half or a quarter where scene and grid allow it.
    elements: of the reference. repeats: timed solves of every row at rest, 5 at least. integrator: of the
    motion, all unless some are named. out: a folder that keeps the rows, so that the same call goes on where
    an earlier one was stopped. large: even where a model takes more memory than there is. Rows are computed
    in processes of their own: a script calls this under `if __name__ == "__main__":`.
    """
    from comparisons.runs.campaign import campaign
    from comparisons.tradeoff.choices import trade

    _, measure = trade(
        scene,
        Lattice.given(lattice, keywords),
        grid=grid,
        lumped_pair=lumped_pair,
        calibration=calibration,
        meshes=dict(zip(REFERENCES, (plate, shell, solid), strict=True)),
        models=models,
        symmetry=symmetry,
        elements=elements,
        repeats=repeats,
        duration=None if duration is None else amount("duration", duration, "s"),
        integrator=integrator,
    )
    with campaign(out) as store:
        return measure(store=store, workers=workers, progress=progress)
