"""What a scene's words mean for a motion: when something changes its course."""

from __future__ import annotations

from sheetbench.scenes.scene import Scene
from sheetbench.scenes.tables import OverTime


def kinks(scene: Scene) -> list[float]:
    """The times [s] at which a history, a command or a motion has a sample, increasing: between them all that
    is prescribed is smooth."""
    tables: list[OverTime | None] = [
        load.history for load in (scene.gravity, *scene.loads) if load is not None
    ]
    tables += [*(support.motion for support in scene.supports), *scene.motions().values()]
    commands = (getattr(actuator, "curvature", None) for actuator in scene.actuators)
    tables += [command for command in commands if isinstance(command, OverTime)]
    return sorted({time for table in tables if table is not None for time in table.time})
