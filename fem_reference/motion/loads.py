"""Loads over time: a scene's loads one by one, each with the factor that its history gives it."""

from __future__ import annotations

from collections.abc import Iterator

from sheetbench.scenes import Scene
from sheetbench.scenes.sheet import Gravity
from sheetbench.scenes.tables import Loading, OverTime, PiecewiseLinear

Factor = PiecewiseLinear | None  # over time; None: constant


def single_loads(scene: Scene) -> Iterator[tuple[Scene, Factor]]:
    """Scenes with one load each, without its history, and the factor over time that the history gives."""
    bare = scene.replace(loads=(), gravity=None)
    for load in (scene.gravity, *scene.loads):
        if load is not None:
            constant = load.replace(history=None)
            alone = {"gravity": constant} if isinstance(load, Gravity) else {"loads": (constant,)}
            yield bare.replace(**alone), _factor(load)


def factor_at(factor: Factor, time: float) -> float:
    """The factor at a time [s]."""
    return 1.0 if factor is None else float(factor.at(time))


def kinks(scene: Scene) -> list[float]:
    """The times [s] after 0 at which a history or a motion bends, increasing."""
    tables: list[OverTime | None] = [
        load.history for load in (scene.gravity, *scene.loads) if load is not None
    ]
    tables += [*(support.motion for support in scene.supports), *scene.motions().values()]
    commands = (getattr(actuator, "curvature", None) for actuator in scene.actuators)
    tables += [command for command in commands if isinstance(command, OverTime)]
    return sorted({time for table in tables if table is not None for time in table.time if time > 0.0})


def _factor(load: Loading) -> Factor:
    return None if load.history is None else PiecewiseLinear(load.history.time, load.history.factor)
