"""The state that a run begins in."""

from __future__ import annotations

import numpy as np

from lumped.calibration import Calibration
from lumped.dynamics.explicit.projection import Projection
from lumped.dynamics.system import State, System
from lumped.lattice import Weights
from lumped.statics.solver import build_problem, solve_path
from sheetbench.scenes import Chain
from sheetbench.scenes.kinematics import bent_or_tilted
from sheetbench.scenes.supports import AnySupport, Motion
from sheetbench.scenes.tables import PiecewiseLinear


def _at_the_start(support: AnySupport) -> AnySupport:
    """The support where it is at t = 0."""
    if support.motion is None:
        return support
    place = PiecewiseLinear(support.motion.time, support.motion.displacement).at(0.0)
    motion = Motion(time=(0.0,), displacement=(tuple(place.tolist()),))
    return support.replace(motion=motion)


def initial_state(system: System, calibration: Calibration, weights: Weights) -> State:
    """At rest: flat, or in the shape that curved supports and tilted clamps give an unloaded sheet; with the
    acceleration that loads and commands give it at once."""
    u = system.place(0.0)
    scene = system.scene
    if bent_or_tilted(scene.supports, scene.sheet):
        slack = tuple(a.replace(curvature=0.0) if isinstance(a, Chain) else a for a in scene.actuators)
        held = tuple(_at_the_start(support) for support in scene.supports)
        unloaded = scene.replace(gravity=None, loads=(), actuators=slack, supports=held)
        u = solve_path(unloaded, build_problem(unloaded, calibration, weights)).state.u
    memory = None if system.maxwell is None else system.maxwell.at_rest(u)
    v = system.place_rate(0.0)
    v = v if system.moving else np.zeros_like(u)
    system.since(State(0.0, u, v, v, memory))
    a = system.accelerate(system.unbalanced(u, v, 0.0))
    projection = Projection(system)
    if projection.active:
        a, multipliers = projection.tangential(a, projection.jacobian(u))
        u = u + multipliers
    return State(0.0, u, v, a, memory)
