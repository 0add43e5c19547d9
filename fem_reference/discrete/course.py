"""Growth of loads and commands: with the load factor, from 0 to 1, in statics; over time in a motion.

A sheet is discretised for one of both, and all its parts take one number, `at`: the load factor or the time
[s]. Statics take the last factor of every history and the last pose of every motion.
"""

from collections.abc import Callable, Iterator
from typing import Any

from sheetbench.scenes import Chain, Scene
from sheetbench.scenes.meaning.motion import without_held_loads
from sheetbench.scenes.objects.actuators import CurvatureTable
from sheetbench.scenes.objects.sheet import Gravity
from sheetbench.scenes.objects.tables import PiecewiseCurve

Factor = Callable[[float], Any] | None  # of a time [s] or load factor; None: constant


def factor_at(factor: Factor, at: float) -> float:
    """Return the factor at a time [s] or load factor."""
    return 1.0 if factor is None else float(factor(at))


def loads_of(scene: Scene, moving: bool) -> Iterator[tuple[Scene, Factor]]:
    """Yield scenes with a part of the loads each, and the factor of that part. Statics have one part with all
    loads; a motion has one part a load, without their histories and without the loads let go at the start."""
    if not moving:
        yield scene, float  # the load factor itself
        return
    scene = without_held_loads(scene)
    bare = scene.replace(loads=(), gravity=None)
    for load in (scene.gravity, *scene.loads):
        if load is not None:
            constant = load.replace(history=None)
            single_load = {"gravity": constant} if isinstance(load, Gravity) else {"loads": (constant,)}
            table = load.history
            yield bare.replace(**single_load), PiecewiseCurve(table.time, table.factor).at if table else None


def commands_of(scene: Scene, moving: bool) -> tuple[Scene, list[Factor]]:
    """Return a scene, and for each of its actuators the factor of its curvature. A motion's chain with a
    curvature table has the curvature 1 1/m in that scene, and the table as its factor."""
    if not moving:
        return scene, [float] * len(scene.actuators)  # the load factor itself
    actuators, factors = list(scene.actuators), list[Factor]()
    for number, chain in enumerate(scene.actuators):
        factors.append(None)
        if isinstance(chain, Chain) and isinstance(course := chain.curvature, CurvatureTable):
            actuators[number] = chain.replace(curvature=1.0)
            factors[number] = PiecewiseCurve(course.time, course.value).at
    return scene.replace(actuators=tuple(actuators)), factors
