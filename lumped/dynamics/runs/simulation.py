"""Dynamics of a lattice from rest: a scene and springs in, a `History` out.

Gravity, loads and commands act from t = 0 on, loads scaled by their histories. The sheet starts flat and at
rest; with a curved support or a tilted clamp it starts in the shape that the supports alone give it, with
`[initial]` in that of statics (`scenes.meaning.motion`). Samples are evenly spaced; steps divide their
distance.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from typing import Any

import numpy as np

from lumped.calibration import Calibration, default
from lumped.dynamics.implicit.sensitivities import SensitiveEsdirk, Sided, require_followed
from lumped.dynamics.integrators import INTEGRATORS, require_integrator, resolve_integrator
from lumped.dynamics.runs.initial import in_motion
from lumped.dynamics.runs.observer import LatticeObserver
from lumped.dynamics.runs.plan import plan_run
from lumped.lattice import Weights
from lumped.mid_surface import MidSurface
from lumped.statics.fields import field_mesh
from sheetbench.answers.history import History
from sheetbench.choices import INTEGRATOR
from sheetbench.clock import now
from sheetbench.numerics.time.method import Advance
from sheetbench.runs.record import Recipe, parted, record
from sheetbench.scenes import AnyScene, scene_of
from sheetbench.scenes.objects.quantities import require_positive


def simulate(
    scene: AnyScene,
    calibration: Calibration | None = None,
    duration: float = 1.0,
    *,
    step: float | None = None,
    integrator: str = INTEGRATOR,
    every: float | None = None,
    weights: Weights = "tributary",
    sensitivities: Sequence[str] = (),
    **options: Any,
) -> History:
    """Motion of the scene's sheet over `duration` [s].

    integrator: a name of `INTEGRATORS`, or "auto": the quickest at its error that this run can have
    (`lumped.dynamics.integrators`). step [s]: never exceeded; without it the explicit ones take 0.9 of their
    limit, `generalised-alpha` and `esdirk` adapt to their error, `midpoint` takes 1/200 of the lowest period.
    every [s]: distance of samples, 1/100 of the lowest period unless given; no step is longer, and what a
    load's history does within a step may go unseen, but for `esdirk`, whose adaptive steps may be longer and
    end where a history bends. sensitivities: parameters by which the run has derivatives too, at most 20, of
    `esdirk` alone (`lumped.dynamics.implicit.sensitivities`): `extra["sensitivities"]` has by parameter and
    probe those of the samples (n, 3). options: the integrator's own (`radius`, `error`), and `store`,
    `frames` and `progress` (`sheetbench.runs.record`).

    Raises NoEquilibrium where the shape to start from is no stable equilibrium, BadInput for an unknown
    integrator, a step above the limit of an explicit one, more than ten
    million default steps of it; for a folder that cannot be written to, that another process writes to, that
    holds another run, or whose files are damaged.

    >>> import lumped
    >>> from sheetbench.scenes import load
    >>> scene = load("two-edges-settling")
    >>> springs = lumped.calibrate(scene.sheet, scene.material, grid=3)
    >>> history = lumped.simulate(scene, springs, 0.02)
    >>> history.status, float(history.time[-1])
    (<Status.CONVERGED: 'converged'>, 0.02)
    """
    keeping, options = parted(options)
    require_integrator(integrator)
    for name, value in {"duration": duration, "step": step, "every": every}.items():
        require_positive(name, value, "s")
    began = now()
    scene = scene_of(scene)
    calibration = calibration or default(scene)
    system, start = in_motion(scene, calibration, weights)
    integrator, why = resolve_integrator(integrator, system, options)
    require_followed(sensitivities, integrator, keeping)
    limit = INTEGRATORS[integrator].limit(system, start.u)
    schedule, length = plan_run(system, calibration, limit, duration, step, integrator, every)
    settings = calibration.settings | {"layer_distance": calibration.layer_distance} | options
    masses = system.assembly.lattice.mass_count
    axes = system.coupling.axes() if system.coupling is not None else {}
    drawn = np.concatenate([np.arange(masses), *(rows for rows, _ in axes.values())])
    key = {
        "springs": calibration.document()["springs"],
        **{"duration": duration, "step": step, "every": every},
        "settings": settings,
        "weights": weights,
        "axes": {edge: len(rows) for edge, (rows, _) in axes.items()},
    }
    kind: Any = INTEGRATORS[integrator]
    sides = [Sided(scene, calibration, weights, name) for name in sensitivities]
    if sides:
        kind = partial(SensitiveEsdirk, sides)
    extra: dict[str, Any] = {"fixed": step is not None} if INTEGRATORS[integrator].adaptive else {}
    recipe = Recipe(
        scene=scene,
        label=f"lumped {calibration.title}",
        integrator=integrator,
        settings=settings,
        key=key,
        schedule=schedule,
        method=(method := kind(system, length, **options, **extra)),
        observer=LatticeObserver(system, drawn),
        start=lambda: Advance(start, 0.0, 0.0),
        rows=len(drawn),
    )
    history = record(recipe, keeping, began)
    history.settings.update({"largest_step": limit.step} if limit is not None else {})
    history.settings.update({"integrator_reason": why} if why else {})
    if sides:
        probes, times = MidSurface(system.assembly.lattice, scene.probe_points()), len(history.time)
        found = np.concatenate([of for _, of in method.found], axis=1)[:, :times]
        at = [np.array([probes.of(u) for u in of]).swapaxes(0, 1) for of in found]
        by = (dict(zip(scene.probes, of, strict=True)) for of in at)
        history.extra["sensitivities"] = dict(zip(sensitivities, by, strict=True))
    whole = history.extra["frames"]
    history.extra.update(
        {
            "frames": whole[:, :masses],
            "axes": {
                edge: (rest, whole[:, np.searchsorted(drawn, rows)]) for edge, (rows, rest) in axes.items()
            },
            "sample": lambda u, plan: MidSurface(system.assembly.lattice, plan).of(u),
            "mesh": field_mesh(system.problem.assembly, start.u, np.zeros_like(start.u)),
        }
    )
    return history
