"""The trade of a motion: models, integrators and steps against error and time.

    error     the largest |component of u(t) − u_ref(t)| over the probes and samples / largest |component of
              u_ref|, against the reference: the shell with twice as many elements as the finest among the
              rows, `FINEST` at least
    of steps  the same against the same lattice, moved by the energy-conserving midpoint rule with `REFERENCE`
              steps in the period: what its steps alone miss

Period and damping are those of `comparisons.comparison.measures`; cost is the solver's time per simulated
second. The reference's uncertainty is by n, ¾ n and ½ n elements a side and by steps twice as long
(`comparisons.sweep.limits.motion_bar`). Steps of a lattice are the period over
`divisions`, the period being the lowest mode's about the flat sheet or about its equilibrium, the shorter of
the two: a sheet that hangs is stiffer than it was flat. Explicit integrators take shares of their stability
limit instead. Plate, shell and solid keep their steps to an error.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from typing import Unpack

import numpy as np

from comparisons.comparison.measures import largest
from comparisons.comparison.motion import require_motion
from comparisons.models.resolve import resolve
from comparisons.models.spec import Elements, Lattice, Spec
from comparisons.sweep.campaign import CampaignKeywords
from comparisons.sweep.limits import in_all, motion_bar
from comparisons.sweep.solved import Ask, Solved, sweep
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
ERRORS = (1e-4, 1e-5)  # of a step of plate, shell and solid; the latter of the reference too
LONGER = 8.0  # times the error of a step: steps twice as long
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
    **how: Unpack[CampaignKeywords],
) -> DynamicTradeoff:
    """Measure every integrator at every step on every lattice, and the other models.

    others: plate, shell and solid, or models from outside that move; reference: what all are measured
    against; fine: steps of the midpoint rule in a period. Raises BadInput for an integrator
    that does not exist and for a model that does not move. A run that diverges is a row with its status.
    """
    import lumped

    require_positive("--duration", duration, "s")
    for name in integrators:
        lumped.require_integrator(name)
    finest = reference or finest_shell(others, FINEST)
    for other in (*others, finest):
        require_motion(scene, other)
    meant = [resolve(scene, one, "motion") for one in lattices]
    periods = [lumped.shortest_period(scene, one.springs) for one in meant]
    ask = partial(Ask, scene, duration=duration, every=min(periods) / SAMPLES)

    def of_lattice(number: int, name: str, step: float, repeats: int = 1) -> Ask:
        label = f"{meant[number].springs.title}, {name} {step:.3g} s"
        run, tags = {"integrator": name, "step": step}, {"lattice": number}
        return ask(meant[number].spec, repeats=repeats, run=run, tags=tags, label=label)

    finer = [ask(finest.but(count=n), run={"error": ERRORS[-1]}) for n in coarser(finest.elements)]
    finer.append(ask(finest, run={"error": LONGER * ERRORS[-1]}))
    own = [of_lattice(i, "midpoint", at / n, 0) for n in (fine, fine // 2) for i, at in enumerate(periods)]
    asks: list[Ask] = []
    for number, (one, period) in enumerate(zip(meant, periods, strict=True)):
        for name in integrators:
            steps = [period / n for n in divisions]
            if lumped.INTEGRATORS[name].explicit and not scene.chains():  # else it is refused
                largest_step = lumped.explicit_limit(name, scene, one.springs)
                steps = [share * largest_step for share in SHARES]
            asks += [of_lattice(number, name, step) for step in steps]
    for other in others:
        runs = [{"error": error} for error in ERRORS] if isinstance(other, Elements) else [{}]
        asks += [ask(other, repeats=1, run=run) for run in runs]
    found = sweep([*finer, *own, *asks], store, **how)
    finer_rows, found = found[: len(finer)], found[len(finer) :]
    truths, halves, found = found[: len(meant)], found[len(meant) : len(own)], found[len(own) :]
    found.sort(key=lambda row: _place(row.ask, integrators))
    reasons = (why for one in meant for why in one.reasons.items())
    return DynamicTradeoff(
        scene,
        tuple(
            MotionRow.of(row, finer_rows[0], truths[row.ask.tags["lattice"]] if row.ask.tags else None)
            for row in found
        ),
        MotionRow.of(finer_rows[0], finer_rows[0]),
        in_all(motion_bar(finer_rows[:-1], finer_rows[-1])),
        tuple(dict.fromkeys(f"{name.removesuffix('_reason')}: {why}" for name, why in reasons)),
        tuple(f"lumped {one.springs.title}" for one in meant),
        max(map(_off, halves, truths), default=0.0),
        duration=duration,
        lowest_period=min(periods),
    )


def _place(ask: Ask, integrators: Sequence[str]) -> tuple[float, int]:
    """Lattices first, and the rows of each by integrator."""
    name = ask.run.get("integrator")
    return (ask.tags.get("lattice", np.inf), integrators.index(name) if name in integrators else 0)


def _off(one: Solved, other: Solved) -> float:
    """The largest difference of two runs, 0 where one of them has not ended."""
    ours, theirs = one.history, other.history
    return 0.0 if ours is None or theirs is None else largest(ours, theirs)
