"""Verbs in Python where what stands behind them wants more than a scene: springs, a campaign to keep rows in.

The other verbs of `sheetbench` are the functions of the packages below, as they are.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import ExitStack
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Any, overload

from comparisons.models import registry, springs
from comparisons.models.candidate import Candidate, lattices
from comparisons.models.grading import Grading
from comparisons.models.grids import GridLike
from comparisons.report.work import silent
from sheetbench.choices import CALIBRATION, REFERENCE, REFERENCES
from sheetbench.scenes import AnyScene, History, Solution, scene_of

if TYPE_CHECKING:
    from comparisons.comparison.answer import Comparison
    from comparisons.motion.comparison import MotionComparison
    from comparisons.runs.campaign import Progress
    from comparisons.tradeoff.answer import Tradeoff
    from lumped import Calibration


def calibrate(
    scene: AnyScene | None = None,
    *,
    young: float | str | None = None,
    poisson: float | None = None,
    thickness: float | str | None = None,
    side: float | str | Sequence[float | str] | None = None,
    density: float | str | None = None,
    grid: GridLike = None,
    method: str | None = None,
    k: float | None = None,
    layer_distance: float | None = None,
    grading: Grading = None,
    large: bool = False,
) -> Calibration:
    """Return the spring constants of a lattice for a sheet and material, with the moduli that they meet.

    The sheet and material are the scene's, with young [Pa], poisson, thickness [m], side [m] (one number, or
    along x and y) and density [kg/m³] in place of its own; without a scene those alone, 1000 kg/m³ unless
    given. Text may have a unit, as "2 mm".
    grid: 9 along the shorter side with near-square cells unless given; (nx, ny), (nx, ny, layers). method: a
    name of `lumped.CALIBRATIONS`, consistent unless given, or "auto", as the scene's edges and load have it
    and as goes with the grading "auto"; the fitted ones train on the scene. k [N/m] and layer_distance [m]
    are for the methods that take them. grading: 0, cells of one size, to 1, finest at the edges, or "auto",
    as the scene's layers need. Raises BadInput for what does not exist or go together, and unless `large` for
    a fit that takes more memory than there is.
    """
    from comparisons.calibration.calibrate import calibrate, subject

    sides = [side] if isinstance(side, float | int | str | None) else side
    values = {"young": young, "poisson": poisson, "thickness": thickness, "density": density}
    of = subject(scene, {**values, "length_x": sides[0], "length_y": sides[-1]})
    spec = springs.LatticeSpec(grid, method, k, layer_distance, grading)
    return calibrate(of, spec, named=scene is not None, large=large)


def solve(scene: AnyScene, model: str = "lumped", **settings: Any) -> Solution:
    """The static answer of one model: "lumped", "plate", "shell", "solid", or a plug-in's name.

    settings: of the lattice `grid`, `grading`, `calibration`, `k`, `layer_distance`; of the references
    `elements`. Raises SceneError for a scene that could float away, BadInput for a model or setting that does
    not exist and for one that takes more memory than there is, unless `large = True`; a solve that fails is a
    status.
    """
    return registry.solve(scene_of(scene), model, **settings)


def simulate(
    scene: AnyScene,
    duration: float,
    *,
    grid: GridLike = None,
    calibration: str | None = None,
    k: float | None = None,
    layer_distance: float | None = None,
    grading: Grading = None,
    **settings: Any,
) -> History:
    """The lattice's motion from rest over `duration` [s], loads and weight on at t = 0.

    settings: those of `lumped.simulate`, as `integrator`, `step` [s], `every` [s].
    """
    lattice = vars(springs.LatticeSpec(grid, calibration, k, layer_distance, grading))
    return registry.simulate(scene_of(scene), duration, **lattice, **settings)


@overload
def compare(scene: AnyScene, *, duration: None = None, **settings: Any) -> Comparison: ...


@overload
def compare(scene: AnyScene, *, duration: float, **settings: Any) -> MotionComparison: ...


def compare(
    scene: AnyScene,
    *,
    duration: float | None = None,
    grid: GridLike = None,
    calibration: str | None = None,
    reference: str = REFERENCE,
    elements: int | tuple[int, int] | None = None,
    **settings: Any,
) -> Comparison | MotionComparison:
    """The lattice beside a reference, "plate", "shell" or "solid": at rest, or over `duration` [s] of motion.

    grid: masses, 9 along the shorter side unless given; elements: the reference's likewise, 16 unless given
    and 8 in motion. settings: further ones of `comparisons.comparison.comparison.compare` (`k`, `grading`,
    `law`, `uncertainty`, `branch` …) or, with a duration, of `comparisons.motion.comparison.compare_motion`
    (`every`, `frames` …). Raises SceneError for a scene without an answer, BadInput for choices that do not
    exist; a solve that fails is a status.
    """
    settings |= {"grid": grid, "calibration": calibration, "reference": reference}
    settings |= {} if elements is None else {"elements": elements}
    if duration is not None:
        from comparisons.motion.comparison import compare_motion

        return compare_motion(scene, duration, **settings)
    from comparisons.comparison.comparison import compare

    return compare(scene, **settings)


def tradeoff(
    scene: AnyScene,
    *,
    lumped: Sequence[GridLike] = (3, 5, 9, 17),
    calibration: Sequence[str] = (CALIBRATION,),
    grading: Grading = None,
    plate: Sequence[int] = (),
    shell: Sequence[int] = (4, 8, 16),
    solid: Sequence[int] = (),
    models: Sequence[Candidate] = (),
    repeats: int = 5,
    workers: int = 1,
    out: Path | str | None = None,
    large: bool = False,
    progress: Callable[[Progress], None] = silent,
) -> Tradeoff:
    """Error against time over lattices (grids), references (elements along the shorter side) and others.

    grading: of the lattices whose calibration takes one. models: further ones, plug-ins too. repeats: timed
    solves of every row, at least. out: a folder that keeps the rows, so that the same call goes on where an
    earlier one was stopped. large: even where a model takes more memory than there is. Rows are computed in
    processes of their own: a script calls this under `if __name__ == "__main__":`.
    """
    from comparisons.runs.campaign import campaign
    from comparisons.tradeoff.statics import tradeoff

    loaded = scene_of(scene)
    candidates, reasons = springs.resolve_each(loaded, lattices(loaded, lumped, calibration), grading)
    for name, meshes in zip(REFERENCES, (plate, shell, solid), strict=True):
        candidates += [Candidate(name, {"elements": count}) for count in meshes]
    with ExitStack() as stack:
        folder = Path(stack.enter_context(TemporaryDirectory()) if out is None else out)
        folder.mkdir(parents=True, exist_ok=True)
        store = stack.enter_context(campaign(folder))
        return tradeoff(
            loaded,
            [*candidates, *models],
            store,
            repeats=repeats,
            workers=workers,
            large=large,
            reasons=reasons,
            progress=progress,
        )
