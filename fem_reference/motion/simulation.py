"""Motion of a reference from rest: a scene in, a `History` out.

Gravity, loads and commands act from t = 0 on, loads scaled by their histories. The sheet starts flat and at
rest; with a curved support or a tilted clamp, in the shape given by the supports alone; with `[initial]`, in
its static equilibrium (`sheetbench.scenes.meaning.motion`). Steps are as long as their error allows; samples
lie within them, cubic in time between their ends.
"""

from typing import Any

import numpy as np

from fem_reference.discrete.energies import SheetMotion
from fem_reference.motion.generalised_alpha import ERROR, ConstrainedAlpha
from fem_reference.motion.observer import ReferenceObserver
from fem_reference.sheets import SHEETS, division_of
from fem_reference.vibration import modes
from sheetbench.answers.history import History
from sheetbench.choices import REFERENCE
from sheetbench.clock import now
from sheetbench.errors import BadInput
from sheetbench.runs.record import Recipe, record, split_options
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
    """Return the motion of a scene's sheet by a reference model.

    Parameters
    ----------
    scene : Scene, str or path
        A scene, the name of one in the catalogue, or a scene file.
    model : {"plate", "shell", "solid"}
        The reference model.
    duration : float
        Length of the motion [s].
    step : float, optional
        Fixed step [s]; without it steps keep to `error`. A fixed step that fails is repeated, a quarter as
        long.
    error : float
        Error of a step, of the displacement relative to the largest so far; below 0.1.
    every : float, optional
        Distance of samples [s], by default 1/100 of the lowest period.
    **options : any
        The model's own options, `elements` among them, and `store`, `frames` and `progress` of
        `sheetbench.runs.record`.

    Returns
    -------
    History
        Samples of energies [J], probes [m] and forces [N] over time [s], frames and status.

    Raises
    ------
    NoEquilibrium
        Where the shape to start from is no stable equilibrium.
    BadInput
        For an unknown model, a scene that the model cannot move, an error of 0.1 or more, and a folder that
        holds another run, that another process writes to, or whose files are damaged.

    Notes
    -----
    Generalised-α (`fem_reference.motion.generalised_alpha`).

    Examples
    --------
    >>> import fem_reference
    >>> history = fem_reference.simulate("two-edges-settling", "shell", 0.01, elements=2)
    >>> history.status, float(history.time[-1])
    (<Status.CONVERGED: 'converged'>, 0.01)
    """
    recording, options = split_options(options)
    moving_scene = scene_of(scene)
    require_moving(moving_scene, model)
    for name, value in {"duration": duration, "step": step, "every": every}.items():
        require_positive(name, value, "s")
    require_error(error)
    started = now()
    if model == "plate":
        require_no_obstacles(moving_scene, "the plate, which is linear,")
    sheet = division_of(moving_scene, model, **options).sheet(moving=True)
    schedule = schedule_of(
        duration, every, lambda: 1.0 / float(modes(moving_scene, "plate", 4, count=1).frequencies[0])
    )
    method = ConstrainedAlpha(sheet, step, error, 0.1 * schedule.every)
    settings = {**sheet.settings, "step": step or "adaptive", "error": error}
    flat = sheet.displacement(np.zeros(sheet.mass.shape[0]))
    recipe: Recipe[SheetMotion] = Recipe(
        scene=moving_scene,
        label=sheet.label,
        integrator="generalised-alpha",
        settings=settings,
        key={"model": model, "settings": settings, "duration": duration, "every": every},
        schedule=schedule,
        method=method,
        observer=ReferenceObserver(sheet, moving_scene),
        start=method.start,
        rows=len(flat),
    )
    history = record(recipe, recording, started)
    of_model = {"mesh": sheet.mesh(flat), "sample": sheet.sample, "unknowns": sheet.unknowns}
    history.extra.update(of_model | {"axes": {}})
    return history


def require_moving(scene: Scene, model: str) -> None:
    """Raise BadInput for a model or a scene that the references cannot move.

    Parameters
    ----------
    scene : Scene
        The scene.
    model : str
        Name of a reference model.

    Raises
    ------
    BadInput
        For an unknown model, and for edge motions of another model than the shell.

    Examples
    --------
    >>> import fem_reference
    >>> from sheetbench.scenes import load
    >>> fem_reference.require_moving(load("two-edges-settling"), "shell")
    """
    if model not in SHEETS:
        raise BadInput(f"reference = '{model}': has no motion; choose from {', '.join(SHEETS)}")
    for name, actuator in scene.named_actuators().items() if model != "shell" else ():
        if isinstance(actuator, EdgeMotion):
            raise BadInput(f"actuator {name}: the {model} has no edge motions in a run; the shell has")
