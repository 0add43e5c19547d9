"""Motion of a scene on a lattice from rest.

Gravity, loads and commands act from t = 0 on, loads scaled by their histories. The sheet starts flat and at
rest; with a curved support or a tilted clamp it starts in the equilibrium under the supports alone, with
`[initial]` in the static equilibrium (`scenes.meaning.motion`). Samples are evenly spaced; steps divide their
distance.
"""

from collections.abc import Sequence
from functools import partial
from typing import Any

import numpy as np

from lumped.calibration import Calibration, default
from lumped.dynamics.implicit.sensitivities import ParameterSystems, SensitiveEsdirk, require_differentiable
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
from sheetbench.runs.record import Recipe, record, split_options
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
    """Return the motion of a scene's sheet from rest.

    Parameters
    ----------
    scene : Scene, str or Path
        Scene, the name of one in the catalogue, or the path of its file.
    calibration : Calibration, optional
        Springs; by default the scene's, or consistent ones on nine masses along the shorter side.
    duration : float, default 1
        Length of the motion [s].
    step : float, optional
        Largest step [s]; by default 0.9 of the limit of explicit integrators and 1/200 of the lowest period
        for "midpoint"; "generalised-alpha" and "esdirk" adapt to their error.
    integrator : str, default "auto"
        Name of `INTEGRATORS`, or "auto", the fastest at equal error that the scene permits.
    every : float, optional
        Distance of samples [s]; by default 1/100 of the lowest period. No step is longer, except adaptive
        steps of "esdirk", which end at the kinks of histories; other integrators may step over kinks.
    weights : {"tributary", "full"}, default "tributary"
        Shares of boundary links and masses: by tributary area, or full ones (Habibi et al.).
    sensitivities : sequence of str, optional
        At most 20 parameters, of "esdirk" alone (`lumped.dynamics.implicit.sensitivities`):
        `extra["sensitivities"]` has by parameter and probe the derivatives of the samples, (k, 3).
    **options
        Options of the integrator (`radius`, `error`), and `store`, `frames` and `progress` of
        `sheetbench.runs.record`.

    Returns
    -------
    History
        Times (k,) [s], displacements of the probes [m], reactions [N], energies [J] and status.

    Raises
    ------
    NoEquilibrium
        If the motion starts from an equilibrium and there is no stable one.
    BadInput
        If the integrator is unknown, its step exceeds the limit of stability, the default takes more than ten
        million steps, or the folder `store` cannot be written to, is in use, holds another run or damaged
        files.

    Notes
    -----
    The equations of motion are in `lumped.dynamics.system`, each integrator's source in its module.

    Examples
    --------
    >>> import lumped
    >>> from sheetbench.scenes import load
    >>> scene = load("two-edges-settling")
    >>> springs = lumped.calibrate(scene.sheet, scene.material, grid=3)
    >>> history = lumped.simulate(scene, springs, 0.02)
    >>> history.status, float(history.time[-1])
    (<Status.CONVERGED: 'converged'>, 0.02)
    """
    keeping, options = split_options(options)
    require_integrator(integrator)
    for name, value in {"duration": duration, "step": step, "every": every}.items():
        require_positive(name, value, "s")
    start_time = now()
    scene = scene_of(scene)
    calibration = calibration or default(scene)
    system, start = in_motion(scene, calibration, weights)
    integrator, reason = resolve_integrator(integrator, system, options)
    require_differentiable(sensitivities, integrator, keeping)
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
    sides = [ParameterSystems(scene, calibration, weights, name) for name in sensitivities]
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
    history = record(recipe, keeping, start_time)
    history.settings.update({"largest_step": limit.step} if limit is not None else {})
    history.settings.update({"integrator_reason": reason} if reason else {})
    if sides:
        probes, count = MidSurface(system.assembly.lattice, scene.probe_points()), len(history.time)
        rates = np.concatenate([block for _, block in method.found], axis=1)[:, :count]
        at = [np.array([probes.of(u) for u in by]).swapaxes(0, 1) for by in rates]
        by_probe = (dict(zip(scene.probes, values, strict=True)) for values in at)
        history.extra["sensitivities"] = dict(zip(sensitivities, by_probe, strict=True))
    frames = history.extra["frames"]
    along = {edge: (rest, frames[:, np.searchsorted(drawn, rows)]) for edge, (rows, rest) in axes.items()}
    history.extra.update(
        frames=frames[:, :masses],
        axes=along,
        sample=lambda u, plan: MidSurface(system.assembly.lattice, plan).of(u),
        mesh=field_mesh(system.problem.assembly, start.u, np.zeros_like(start.u)),
    )
    return history
