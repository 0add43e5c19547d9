"""Loads over time: a scene's loads one by one, each with the factor that its history gives it."""

from __future__ import annotations

from collections.abc import Iterator

from sheetbench.scenes import Scene
from sheetbench.scenes.sheet import Gravity
from sheetbench.scenes.tables import Loading, PiecewiseLinear

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


def _factor(load: Loading) -> Factor:
    return None if load.history is None else PiecewiseLinear(load.history.time, load.history.factor)
