"""A scene's motion by lattice, references and external codes, against the shell: `crosscheck --duration`."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

from comparisons.external.installed import InstalledCode
from comparisons.models.context import large_in_context
from comparisons.models.resolve import resolve
from comparisons.models.spec import Lattice, Spec
from comparisons.motion.comparison_answer import MotionComparison
from comparisons.motion.measures import largest
from comparisons.motion.run import history_of, motion_run, require_motion
from comparisons.runs.campaign import Progress, carry_out
from comparisons.runs.executors import Pool, processes
from comparisons.runs.store import Store
from comparisons.tradeoff.motion import SAMPLES, shortest_period
from sheetbench.choices import REFERENCE
from sheetbench.errors import BadInput, NoEquilibrium
from sheetbench.scenes import History, Scene, Status
from sheetbench.scenes.quantities import require_positive


@large_in_context
def crosscheck_motion(
    scene: Scene,
    duration: float,
    store: Store,
    *,
    models: Mapping[str, Sequence[Spec]],
    codes: Sequence[InstalledCode] = (),
    workers: int = 1,
    pool: Pool = processes,
    retry: bool = False,
    large: bool = False,
    progress: Callable[[Progress], None] = lambda progress: None,
) -> MotionComparison:
    """Move a scene for `duration` [s] with every model on the finest of its meshes, through a store.

    The shell is what the others are measured against, and moves on its mesh before the finest too. A model
    that does not move the scene is left out and said. Raises BadInput without a shell and for a lattice that
    cannot be; NoEquilibrium where no model beside the shell has moved to the end.
    """
    require_positive("duration", duration, "s")
    left_out, asked = [], {}
    for name, of in models.items():
        try:
            require_motion(scene, of[-1])
            asked[name] = of[-1]
        except BadInput as error:
            if isinstance(of[-1], Lattice):
                raise
            left_out.append(f"{name} is left out: {error}")
    if REFERENCE not in asked:
        raise BadInput(
            "--shell: with --duration the shell is what others are measured against; give it meshes"
        )
    lattice = next((of for of in asked.values() if isinstance(of, Lattice)), Lattice())
    every = shortest_period(scene, resolve(scene, lattice, "motion").springs) / (5 * SAMPLES)
    asked[REFERENCE] = asked.pop(REFERENCE)  # the last is the reference
    coarser = models[REFERENCE][-2]
    runs = [motion_run(scene, spec, duration, every) for spec in (*asked.values(), coarser)]
    *found, rough = carry_out(runs, store, workers=workers, pool=pool, retry=retry, progress=progress)
    histories: dict[str, History] = {}
    failed: list[str] = []
    for name, outcome in zip(asked, found, strict=True):
        if (history := history_of(outcome)) is not None:
            histories[name] = history
        else:
            (left_out if outcome.status == Status.REFUSED else failed).append(
                f"{name} is left out: {outcome.message}"
            )
    if REFERENCE not in histories or len(histories) < 2:
        raise NoEquilibrium("; ".join([*left_out, *failed]))
    other = history_of(rough)
    mesh = None if other is None else largest(other, histories[REFERENCE])
    versions = {one.code.name: one.version for one in codes if one.version and one.code.name in histories}
    return MotionComparison(
        scene, histories, {"finer": mesh}, codes=versions, left_out=tuple(left_out), failed=tuple(failed)
    )
