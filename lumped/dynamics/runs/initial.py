"""The state that a run begins in."""

from __future__ import annotations

import numpy as np

from lumped.calibration import Calibration
from lumped.dynamics.explicit.projection import Projection
from lumped.dynamics.system import State, System
from lumped.lattice import Weights
from lumped.statics.solver import build_problem, stable_equilibrium
from sheetbench.errors import NoEquilibrium
from sheetbench.scenes import Scene
from sheetbench.scenes.meaning.motion import NO_START, at_start, starts_flat


def initial_state(
    system: System, calibration: Calibration, weights: Weights, scene: Scene | None = None
) -> State:
    """At rest, flat or in the equilibrium that the scene starts from (`scenes.meaning.motion`), with the
    acceleration that loads and commands give it at once. scene: the system's with the loads that it lets go.

    Raises NoEquilibrium where there is no stable one.
    """
    u, scene = system.prescribed.place(0.0), system.scene if scene is None else scene
    if not starts_flat(scene):
        still = at_start(scene)
        try:
            u = stable_equilibrium(still, build_problem(still, calibration, weights)).u
        except NoEquilibrium as error:
            raise NoEquilibrium(f"{NO_START}: {error}") from None
    system.assembly.grow(time=0.0)
    memory = None if system.maxwell is None else system.maxwell.at_rest(u)
    v = system.prescribed.rate(0.0)
    v = v if system.prescribed.moving else np.zeros_like(u)
    a = system.accelerate(system.within(State(0.0, u, v, v, memory)).unbalanced(u, v, 0.0))
    projection = Projection(system)
    if projection.active:
        a, multipliers = projection.tangential(a, projection.jacobian(u))
        u = u + multipliers
    return State(0.0, u, v, a, memory)
