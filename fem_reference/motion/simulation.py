"""Motion of a reference from rest: a scene in, a `History` out.

Gravity, loads and commands act from t = 0 on, loads scaled by their histories. The sheet starts flat and at
rest; with a curved support or a tilted clamp, in the shape that supports alone give it; with `[initial]` in
that of statics (`sheetbench.scenes.meaning.motion`). Steps are as long as
their error allows; samples lie within them, cubic in time between their ends.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from fem_reference.discrete.energies import SheetMotion
from fem_reference.motion.generalised_alpha import ERROR, ConstrainedAlpha
from fem_reference.motion.observer import ReferenceObserver
from fem_reference.sheets import SHEETS, division_of
from fem_reference.vibration import modes
from sheetbench.answers.history import History
from sheetbench.choices import REFERENCE, listed
from sheetbench.clock import now
from sheetbench.errors import BadInput
from sheetbench.runs.record import Recipe, parted, record
from sheetbench.runs.schedule import require_error, schedule_of
from sheetbench.scenes import AnyScene, EdgeMotion, Scene, scene_of
from sheetbench.scenes.meaning.distances import require_no_obstacles
from sheetbench.scenes.objects.quantities import require_positive


def simulate(
    scene: AnyScene,
    model: str = REFERENCE,
    duration: float = 1.0,
    *,
    step: float | None = None,
    error: float = ERROR,
    every: float | None = None,
    **options: Any,
) -> History:
    """Motion of a scene's sheet over `duration` [s] as a reference has it.

    step [s]: fixed; without it steps keep to an `error` each, of the displacement relative to the largest so
    far. every [s]: distance of samples, 1/100 of the lowest period unless given. options: the model's own,
    `elements` among them, and `store`, `frames` and `progress` (`sheetbench.runs.record`).

    Raises NoEquilibrium where the shape to start from is no stable equilibrium, BadInput for a model that
    does not move, what a model cannot move, an error not below 0.1, and for a folder that holds
    another run, that another process writes to, or whose files are damaged. A fixed step that fails is
    made again, a quarter as long.

    >>> import fem_reference
    >>> history = fem_reference.simulate("two-edges-settling", "shell", 0.01, elements=2)
    >>> history.status, float(history.time[-1])
    (<Status.CONVERGED: 'converged'>, 0.01)
    """
    keeping, options = parted(options)
    requested = scene_of(scene)
    require_moving(requested, model)
    for name, value in {"duration": duration, "step": step, "every": every}.items():
        require_positive(name, value, "s")
    require_error(error)
    began = now()
    if model == "plate":
        require_no_obstacles(requested, "the plate, which is linear,")
    moving = division_of(requested, model, **options).sheet(moving=True)
    schedule = schedule_of(
        duration, every, lambda: 1.0 / float(modes(requested, "plate", 4, count=1).frequencies[0])
    )
    method = ConstrainedAlpha(moving, step, error, 0.1 * schedule.every)
    settings = {**moving.settings, "step": step or "adaptive", "error": error}
    flat = moving.displacement(np.zeros(moving.mass.shape[0]))
    recipe: Recipe[SheetMotion] = Recipe(
        scene=requested,
        label=moving.label,
        integrator="generalised-alpha",
        settings=settings,
        key={"model": model, "settings": settings, "duration": duration, "every": every},
        schedule=schedule,
        method=method,
        observer=ReferenceObserver(moving, requested),
        start=method.start,
        rows=len(flat),
    )
    history = record(recipe, keeping, began)
    of_model = {"mesh": moving.mesh(flat), "sample": moving.sample, "unknowns": moving.unknowns}
    history.extra.update(of_model | {"axes": {}})
    return history


def require_moving(scene: Scene, model: str) -> None:
    """Raise BadInput for a model that does not move, or a scene with what no reference moves."""
    if model not in SHEETS:
        raise BadInput(f"reference = '{model}': {listed(SHEETS)} can move")
    for name, actuator in scene.named_actuators().items() if model != "shell" else ():
        if isinstance(actuator, EdgeMotion):
            raise BadInput(f"actuator {name}: the {model} in motion has no edge motions; the shell has")
