"""The trade of a motion: models, integrators and steps against error and time.

    error     the largest |component of u(t) − u_ref(t)| over the probes and samples / largest |component of
              u_ref|, against the reference: the shell with twice as many elements as the finest among the
              rows, `FINEST` at least
    of steps  the same against the same lattice, moved by the energy-conserving midpoint rule with `REFERENCE`
              steps in the period: what its steps alone miss

Period and damping are those of `comparisons.motion.measures`; cost is the solver's time per simulated second.
The reference's uncertainty is its grid convergence index from n, ¾ n and ½ n elements a side, and a third of
what steps twice as long change, for it is of second order. Steps of a lattice are the period over
`divisions`, the period being the lowest mode's about the flat sheet or about its equilibrium, the shorter of
the two: a sheet that hangs is stiffer than it was flat. Where an integrator converges with none of them its
steps are halved until it does, down to the midpoint rule's. Explicit integrators take shares of their
stability limit instead. Plate, shell and solid keep their steps to an error.
"""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import suppress
from functools import partial
from typing import TYPE_CHECKING, Unpack

import numpy as np

from comparisons.models.context import large_in_context
from comparisons.models.resolve import Resolved, resolve
from comparisons.models.spec import Elements, Lattice, Spec
from comparisons.motion.measures import largest
from comparisons.motion.run import history_of, motion_run, require_motion
from comparisons.runs.campaign import CampaignKeywords, Run, carry_out
from comparisons.runs.store import Finished, Store
from comparisons.tradeoff.motion_answer import DynamicTradeoff
from comparisons.tradeoff.motion_row import measured_row
from comparisons.tradeoff.statics import finest_shell
from fem_reference.uncertainty import coarser, estimate, mesh_size
from sheetbench.choices import INTEGRATORS
from sheetbench.errors import NoEquilibrium
from sheetbench.scenes import Scene, SceneError, Status, comparable
from sheetbench.scenes.quantities import require_positive

if TYPE_CHECKING:
    from lumped import Calibration

DIVISIONS = (20, 40, 100, 200, 400)  # steps in the lowest period
SHARES = (0.9, 0.45)  # of the explicit integrator's limit
REFERENCE = 3200
ERRORS = (1e-4, 1e-5)  # of a step of plate, shell and solid; the latter of the reference too
LONGER = 8.0  # times the error of a step: steps twice as long
FINEST = 16  # elements of the reference along the shorter side, at least
SAMPLES = 20  # in the lowest period; no step of a lattice is longer than the time between samples


@large_in_context
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
    large: bool = False,
    **how: Unpack[CampaignKeywords],
) -> DynamicTradeoff:
    """Measure every integrator at every step on every lattice, and the other models.

    others: plate, shell and solid, or models from outside that move; reference: what all are measured
    against; fine: steps of the midpoint rule in a period; large: even if it takes more memory than there is.
    Raises BadInput for an integrator that does not exist and for a model that does not move. A run that
    diverges is a row with its status.
    """
    import lumped

    require_positive("duration", duration, "s")
    for name in integrators:
        lumped.require_integrator(name)
    finest = reference or finest_shell(others, FINEST)
    for other in (*others, finest):
        require_motion(scene, other)
    meant = [resolve(scene, one, "motion") for one in lattices]
    each = [(one, shortest_period(scene, one.springs)) for one in meant]
    every = min(period for _, period in each) / SAMPLES
    run = partial(motion_run, scene, duration=duration, every=every)

    def of_lattice(one: Resolved[Lattice], name: str, step: float, timed: bool = True) -> Run:
        label = f"{one.springs.title}, {name} {step:.3g} s"
        return run(one.spec, label=label, timed=timed, integrator=name, step=step)

    finer_runs = [run(finest.but(count=n), error=ERRORS[-1]) for n in coarser(finest.elements)]
    finer_runs.append(run(finest, error=LONGER * ERRORS[-1]))
    own = [of_lattice(one, "midpoint", period / n, False) for n in (fine, fine // 2) for one, period in each]
    model_runs: list[tuple[Run, int | None]] = []  # with the number of its lattice
    for number, (one, period) in enumerate(each):
        for name in integrators:
            steps = [period / n for n in divisions]
            if lumped.INTEGRATORS[name].explicit:
                limit = explicit_limit(name, scene, one.springs)
                steps = [share * limit for share in SHARES]
            model_runs += [(of_lattice(one, name, step), number) for step in steps]
    for other in others:
        if isinstance(other, Elements):
            model_runs += [(run(other, timed=True, error=error), None) for error in ERRORS]
        else:
            model_runs.append((run(other, timed=True), None))
    found = carry_out([*finer_runs, *own, *(one for one, _ in model_runs)], store, **how)
    finer_outcomes, found = found[: len(finer_runs)], found[len(finer_runs) :]
    truths, halves, found = found[: len(each)], found[len(each) : len(own)], found[len(own) :]
    finer = 2 * max(divisions)
    while finer <= fine and (unsolved := _unsolved(model_runs, found)):
        more = [(of_lattice(each[n][0], name, each[n][1] / finer), n) for n, name in unsolved]
        found += carry_out([one for one, _ in more], store, **how)
        model_runs += more
        finer *= 2
    ordered = sorted(
        zip(model_runs, found, strict=True), key=lambda both: _place(both[0][0], both[0][1], integrators)
    )
    reasons = (why for one, _ in each for why in one.reasons.items())
    return DynamicTradeoff(
        scene,
        duration,
        min(period for _, period in each),
        tuple(
            measured_row(one, outcome, finer_outcomes[0], None if n is None else truths[n])
            for (one, n), outcome in ordered
        ),
        measured_row(finer_runs[0], finer_outcomes[0], finer_outcomes[0]),
        _uncertainty(scene, finer_runs, finer_outcomes),
        tuple(dict.fromkeys(f"{name.removesuffix('_reason')}: {why}" for name, why in reasons)),
        tuple(f"lumped {one.springs.title}" for one, _ in each),
        max((_off(half, truth) for half, truth in zip(halves, truths, strict=True)), default=0.0),
    )


def _place(run: Run, number: int | None, integrators: Sequence[str]) -> tuple[float, int]:
    """Lattices first, and the rows of each by integrator."""
    name = run.arguments["run"].get("integrator")
    return (np.inf if number is None else number, integrators.index(name) if name in integrators else 0)


def _uncertainty(scene: Scene, runs: Sequence[Run], outcomes: Sequence[Finished]) -> float | None:
    """Of the reference, by its meshes, the finest first, and the run in longer steps, the last."""
    *meshes, longer = (history_of(outcome) for outcome in outcomes)
    truth = meshes[0]
    if truth is None or longer is None:
        return None
    usable = [
        (np.concatenate(list(history.probes.values())), mesh_size(scene, _counts(one)))
        for one, history in zip(runs, meshes, strict=False)
        if history is not None
    ]
    if len({size for _, size in usable}) < 2:
        return None
    by_mesh = estimate([u for u, _ in usable], [size for _, size in usable]).error
    return by_mesh + largest(longer, truth) / 3.0


def _counts(run: Run) -> int | tuple[int, int]:
    counts = run.arguments["settings"]["elements"]
    return counts if isinstance(counts, int) else (counts[0], counts[1])


def _off(one: Finished, other: Finished) -> float:
    """The largest difference of two runs, 0 where one of them has not ended."""
    ours, theirs = history_of(one), history_of(other)
    return 0.0 if ours is None or theirs is None else largest(ours, theirs)


def _unsolved(
    model_runs: Sequence[tuple[Run, int | None]], found: Sequence[Finished]
) -> list[tuple[int, str]]:
    """Numbers of lattices and the implicit integrators that came to their end there with no step so far."""
    import lumped

    ended: dict[tuple[int, str], set[str]] = {}
    for (one, number), outcome in zip(model_runs, found, strict=True):
        if number is not None:
            ended.setdefault((number, one.arguments["run"]["integrator"]), set()).add(outcome.status)
    return [
        (number, name)
        for (number, name), statuses in ended.items()
        if not lumped.INTEGRATORS[name].explicit
        and not any(status == Status.REFUSED or comparable(status, 1.0) for status in statuses)
    ]


def shortest_period(scene: Scene, springs: Calibration) -> float:
    """The lowest mode's period [s] about the flat sheet or about its equilibrium, the shorter."""
    import lumped

    found = [lumped.modes(scene, springs, 1, springs.masses)]
    with suppress(NoEquilibrium, SceneError):  # where there is none, the flat sheet's it is
        found.append(lumped.modes(scene, springs, 1, springs.masses, "deformed"))
    return 1.0 / max(float(modes.frequencies[0]) for modes in found)


def explicit_limit(integrator: str, scene: Scene, springs: Calibration) -> float:
    """Stability limit [s] of an explicit integrator about the flat sheet."""
    import lumped

    problem = lumped.build_problem(scene, springs)
    system, flat = lumped.System(scene, problem), np.zeros_like(problem.loads.dead)
    limit = lumped.INTEGRATORS[integrator].limit(system, flat)
    assert limit is not None
    return limit.step
