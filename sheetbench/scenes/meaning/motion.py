"""What a scene's words mean for a motion: where it starts, what is let go then, when something changes its
course.

A motion starts at rest. Unless `[initial]` says otherwise nothing but the supports has acted on the sheet: it
is flat, or as bent and tilted supports shape it. With `shape = "static"` it is in the equilibrium under all
that acts at t = 0, and the loads with `hold = true` are let go then.
"""

from __future__ import annotations

from typing import TypeVar

from sheetbench.scenes.meaning.kinematics import bent_or_tilted
from sheetbench.scenes.objects.actuators import Chain, EdgeMotion
from sheetbench.scenes.objects.fields import AScene, SceneFields
from sheetbench.scenes.objects.obstacles import AnyObstacle
from sheetbench.scenes.objects.supports import AnySupport
from sheetbench.scenes.objects.tables import Loading, OverTime

Loaded = TypeVar("Loaded", bound=Loading)
Held = TypeVar("Held", bound=AnySupport | AnyObstacle)
NO_START = "the motion would start from no stable equilibrium"


def kinks(scene: SceneFields) -> list[float]:
    """The times [s] at which a history, a command or a motion has a sample, increasing: between them all that
    is prescribed is smooth."""
    tables: list[OverTime | None] = [
        one.history for one in (scene.gravity, *scene.loads, *scene.natural_states.values()) if one
    ]
    tables += [*(one.motion for one in (*scene.supports, *scene.obstacles)), *scene.motions().values()]
    commands = (getattr(actuator, "curvature", None) for actuator in scene.actuators)
    tables += [command for command in commands if isinstance(command, OverTime)]
    return sorted({time for table in tables if table is not None for time in table.time})


def let_go(scene: AScene) -> AScene:
    """The scene without the loads that hold the sheet until the motion starts."""
    return scene.replace(loads=tuple(load for load in scene.loads if not load.hold))


def starts_flat(scene: SceneFields) -> bool:
    """Whether no equilibrium has to be found for the start."""
    return scene.initial is None and not bent_or_tilted(scene.supports, scene.sheet)


def at_start(scene: AScene) -> AScene:
    """The statics in whose equilibrium a motion starts: supports and moved edges where they are at t = 0;
    with `[initial]` loads, commands and natural states as they are then, else none."""
    static = scene.initial is not None
    return scene.replace(
        initial=None,
        gravity=scene.gravity and _now(scene.gravity) if static else None,
        natural=_state_now(scene.natural, static),
        temperature=_state_now(scene.temperature, static),
        patches=tuple(one.replace(natural=_state_now(one.natural, static)) for one in scene.patches),
        loads=tuple(_now(load).replace(hold=False) for load in scene.loads) if static else (),
        supports=tuple(_placed(support) for support in scene.supports),
        obstacles=tuple(_placed(one).replace(friction=0.0) for one in scene.obstacles),
        actuators=tuple(_commanded(one, static) for one in scene.actuators),
    )


def _now(load: Loaded) -> Loaded:
    return load.replace(history=load.history.still()) if load.history else load


def _state_now(state: Loaded | None, static: bool) -> Loaded | None:
    return state and (_now(state) if static else type(state)())


def _placed(held: Held) -> Held:
    return held.replace(motion=held.motion.still()) if held.motion else held  # type: ignore[return-value]


def _commanded(actuator: Chain | EdgeMotion, static: bool) -> Chain | EdgeMotion:
    if isinstance(actuator, EdgeMotion):
        return actuator.still()
    bent = actuator.curvature if static else 0.0
    return actuator.replace(curvature=bent.still() if isinstance(bent, OverTime) else bent)
