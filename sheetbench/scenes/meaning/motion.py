"""Start of a motion, loads that are let go, and times at which something prescribed changes its course.

A motion starts at rest. Without `[initial]` nothing but the supports has acted on the sheet: it is flat, or
shaped by bent and tilted supports. It starts with `shape = "static"` in the equilibrium under all loads at
t = 0, and the loads with `hold = true` are let go at that time.
"""

from typing import TypeVar

from sheetbench.scenes.meaning.kinematics import bent_or_tilted
from sheetbench.scenes.objects.actuators import Chain, EdgeMotion
from sheetbench.scenes.objects.fields import AScene, SceneFields
from sheetbench.scenes.objects.quantities import Frozen
from sheetbench.scenes.objects.tables import Loading, OverTime

Part = TypeVar("Part", bound=Frozen)
State = TypeVar("State", bound=Loading)
NO_START = "the motion would start from no stable equilibrium"


def kinks(scene: SceneFields) -> list[float]:
    """Return the times [s], rising, of the samples of histories, commands and motions. All prescribed values
    are smooth between the times."""
    parts = [scene.gravity, *scene.loads, *scene.natural_states.values(), *scene.supports, *scene.obstacles]
    values = (value for part in (*parts, *scene.actuators) if part for _, value in part)
    tables = [*scene.motions().values(), *(value for value in values if isinstance(value, OverTime))]
    return sorted({time for table in tables for time in table.time})


def without_held_loads(scene: AScene) -> AScene:
    """Return the scene without the loads that hold the sheet until the motion starts."""
    return scene.replace(loads=tuple(load for load in scene.loads if not load.hold))


def starts_flat(scene: SceneFields) -> bool:
    """Return whether a motion starts from the flat sheet, without a computed equilibrium."""
    return scene.initial is None and not bent_or_tilted(scene.supports, scene.sheet)


def at_start(scene: AScene) -> AScene:
    """Return the static scene in whose equilibrium a motion starts, with supports and moved edges at t = 0.
    It has the loads, commands and natural states of t = 0 if the scene has `[initial]`, else none."""
    static = scene.initial is not None
    return scene.replace(
        initial=None,
        gravity=scene.gravity and _at_start(scene.gravity) if static else None,
        natural=_state_at_start(scene.natural, static),
        temperature=_state_at_start(scene.temperature, static),
        patches=tuple(one.replace(natural=_state_at_start(one.natural, static)) for one in scene.patches),
        loads=tuple(_at_start(load).replace(hold=False) for load in scene.loads) if static else (),
        supports=tuple(_at_start(support) for support in scene.supports),
        obstacles=tuple(_at_start(one).replace(friction=0.0) for one in scene.obstacles),
        actuators=tuple(_actuator_at_start(one, static) for one in scene.actuators),
    )


def _at_start(part: Part) -> Part:
    """Return an object of a scene with the constant values of t = 0 in place of its tables over time."""
    return part.replace(**{key: table.still() for key, table in part if isinstance(table, OverTime)})


def _state_at_start(state: State | None, static: bool) -> State | None:
    return state and (_at_start(state) if static else type(state)())


def _actuator_at_start(actuator: Chain | EdgeMotion, static: bool) -> Chain | EdgeMotion:
    if isinstance(actuator, EdgeMotion):
        return actuator.still()
    return _at_start(actuator) if static else actuator.replace(curvature=0.0)
