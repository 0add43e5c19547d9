"""How what acts on a sheet grows: with the load factor, from 0 to 1, in statics; over time in a motion.

A sheet is made discrete for the one or for the other, and all that it is made of takes one number, `at`: the
load factor or the time [s]. Statics take the last factor of every history and the last pose of every motion.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

from sheetbench.scenes import Chain, Scene
from sheetbench.scenes.meaning.motion import let_go
from sheetbench.scenes.objects.actuators import CurvatureTable
from sheetbench.scenes.objects.sheet import Gravity
from sheetbench.scenes.objects.tables import PiecewiseCurve

Factor = Callable[[float], Any] | None  # of a time [s] or load factor; None: constant


def factor_at(factor: Factor, at: float) -> float:
    """The factor at a time [s] or load factor."""
    return 1.0 if factor is None else float(factor(at))


def loads_of(scene: Scene, moving: bool) -> Iterator[tuple[Scene, Factor]]:
    """Scenes with a part of the loads each, and the factor that it has: all of them in statics, in a motion
    one by one, without their histories and without those let go at the start."""
    if not moving:
        yield scene, float  # the load factor itself
        return
    scene = let_go(scene)
    bare = scene.replace(loads=(), gravity=None)
    for load in (scene.gravity, *scene.loads):
        if load is not None:
            constant = load.replace(history=None)
            alone = {"gravity": constant} if isinstance(load, Gravity) else {"loads": (constant,)}
            table = load.history
            yield bare.replace(**alone), PiecewiseCurve(table.time, table.factor).at if table else None


def commands_of(scene: Scene, moving: bool) -> Iterator[tuple[Scene, Factor]]:
    """Scenes with a part of the chains' commands each, and the factor that the part has."""
    if not moving:
        yield scene, float  # the load factor itself
        return
    still = [a.replace(curvature=0.0) if isinstance(a, Chain) else a for a in scene.actuators]
    # one commanded, the others straight
    for number, chain in enumerate(scene.actuators):
        if isinstance(chain, Chain):
            over_time = chain.curvature if isinstance(chain.curvature, CurvatureTable) else None
            bent = chain.replace(curvature=1.0) if over_time else chain
            actuators = (*still[:number], bent, *still[number + 1 :])
            factor = PiecewiseCurve(over_time.time, over_time.value).at if over_time else None
            yield scene.replace(actuators=actuators), factor
