"""Trade-off of a motion: models, integrators and steps against error and time.

    error       largest |component of u(t) − u_ref(t)| over the probes and samples / largest |component of
                u_ref|, from the reference: the shell with twice as many elements as the finest shell among
                the rows, at least `FINEST`
    step error  the error from a run of the lattice itself by the energy-conserving midpoint rule with
                `REFERENCE` steps per period

Period and damping are defined in `comparisons.comparison.measures`; cost is the solver's time per simulated
second. The reference's uncertainty follows from n, ¾ n and ½ n elements per side and from steps twice as long
(`comparisons.sweep.limits.motion_bar`). Steps of a lattice are its lowest period over `divisions`, about the
flat sheet or the equilibrium, whichever is shorter: a hanging sheet is stiffer than a flat one. Explicit
integrators take fractions of their stability limit instead. Plate, shell and solid control their steps by an
error.
"""

from collections.abc import Sequence
from functools import partial
from typing import Unpack

import numpy as np

from comparisons.comparison.measures import largest
from comparisons.comparison.motion import require_motion
from comparisons.models.resolve import resolve
from comparisons.models.spec import Elements, Lattice, Spec
from comparisons.sweep.campaign import CampaignKeywords
from comparisons.sweep.limits import motion_bar, total_bar
from comparisons.sweep.solved import Request, Solved, sweep
from comparisons.sweep.store import Store
from comparisons.tradeoff.answer import DynamicTradeoff
from comparisons.tradeoff.row import MotionRow
from comparisons.tradeoff.statics import finest_shell
from fem_reference.uncertainty import coarser
from sheetbench.choices import INTEGRATORS
from sheetbench.scenes import Scene
from sheetbench.scenes.objects.quantities import require_positive

DIVISIONS = (20, 40, 100, 200, 400)  # steps in the lowest period
SHARES = (0.9, 0.45)  # of the explicit integrator's limit
REFERENCE = 3200
ERRORS = (1e-4, 1e-5)  # step errors of plate, shell and solid; the reference has the latter
LONGER = 8.0  # factor of the step error that doubles the steps
FINEST = 16  # elements of the reference along the shorter side, at least
SAMPLES = 20  # in the lowest period; no step of a lattice is longer than the time between samples


def dynamic_tradeoff(
    scene: Scene,
    duration: float,
    store: Store,
    *,
    lattices: Sequence[Lattice] = (Lattice(),),
    others: Sequence[Spec] = (),
    reference: Elements | None = None,
    integrators: Sequence[str] = tuple(sorted(INTEGRATORS)),
    divisions: Sequence[int] = DIVISIONS,
    fine: int = REFERENCE,
    **campaign: Unpack[CampaignKeywords],
) -> DynamicTradeoff:
    """Measure every integrator with every step on every lattice, and the other models.

    others: plate, shell, solid, or external models with motion; reference: of the errors; fine: midpoint
    steps per period for step errors. Raises BadInput for an unknown integrator and a model without motion. A
    run that diverges is a row with its status.
    """
    import lumped

    require_positive("--duration", duration, "s")
    for name in integrators:
        lumped.require_integrator(name)
    finest = reference or finest_shell(others, FINEST)
    for other in (*others, finest):
        require_motion(scene, other)
    models = [resolve(scene, lattice, "motion") for lattice in lattices]
    periods = [lumped.shortest_period(scene, model.springs) for model in models]
    request = partial(Request, scene, duration=duration, every=min(periods) / SAMPLES)

    def of_lattice(number: int, name: str, step: float, repeats: int = 1) -> Request:
        label = f"{models[number].springs.title}, {name} {step:.3g} s"
        run, tags = {"integrator": name, "step": step}, {"lattice": number}
        return request(models[number].spec, repeats=repeats, run=run, tags=tags, label=label)

    meshes = [request(finest.but(count=n), run={"error": ERRORS[-1]}) for n in coarser(finest.elements)]
    meshes.append(request(finest, run={"error": LONGER * ERRORS[-1]}))
    fine_runs = [
        of_lattice(i, "midpoint", period / n, 0)
        for n in (fine, fine // 2)
        for i, period in enumerate(periods)
    ]
    requests: list[Request] = []
    for number, (model, period) in enumerate(zip(models, periods, strict=True)):
        for name in integrators:
            steps = [period / n for n in divisions]
            if lumped.INTEGRATORS[name].explicit and not scene.chains():  # explicit integrators refuse chains
                largest_step = lumped.explicit_limit(name, scene, model.springs)
                steps = [share * largest_step for share in SHARES]
            requests += [of_lattice(number, name, step) for step in steps]
    for other in others:
        runs = [{"error": error} for error in ERRORS] if isinstance(other, Elements) else [{}]
        requests += [request(other, repeats=1, run=run) for run in runs]
    solved = iter(sweep([*meshes, *fine_runs, *requests], store, **campaign))
    *by_mesh, longer_steps = [next(solved) for _ in meshes]
    truths, halves = ([next(solved) for _ in models] for _ in range(2))
    rows = sorted(solved, key=lambda row: _sort_key(row.request, integrators))
    reasons = (reason for model in models for reason in model.reasons.items())
    return DynamicTradeoff(
        scene,
        tuple(
            MotionRow.of(row, by_mesh[0], truths[row.request.tags["lattice"]] if row.request.tags else None)
            for row in rows
        ),
        MotionRow.of(by_mesh[0], by_mesh[0]),
        total_bar(motion_bar(by_mesh, longer_steps)),
        tuple(dict.fromkeys(f"{name.removesuffix('_reason')}: {text}" for name, text in reasons)),
        tuple(f"lumped {model.springs.title}" for model in models),
        max(map(_largest_difference, halves, truths), default=0.0),
        duration=duration,
        lowest_period=min(periods),
    )


def _sort_key(request: Request, integrators: Sequence[str]) -> tuple[float, int]:
    """Return the sort key of a run: lattices first, ordered by integrator."""
    name = request.run.get("integrator")
    return (request.tags.get("lattice", np.inf), integrators.index(name) if name in integrators else 0)


def _largest_difference(first: Solved, second: Solved) -> float:
    """Return the largest difference of two runs, 0 if either has no answer."""
    histories = first.history, second.history
    return 0.0 if histories[0] is None or histories[1] is None else largest(histories[0], histories[1])
