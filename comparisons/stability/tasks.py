"""The run of an integrator on a scene's lattice: its largest stable step, and how a run ends; plain data."""

from __future__ import annotations

from contextlib import suppress
from typing import Any

import numpy as np

from comparisons.models.resolve import resolve
from comparisons.models.spec import Lattice
from comparisons.stability.limit import measured_limit, system
from sheetbench.scenes import Clamped, Held, Hinged, Scene

STEPS, PERIODS = 500, 2.0  # of a run: explicit steps at most, lowest periods at most


def run(scene: dict[str, Any], lattice: dict[str, Any], integrator: str, period: float) -> dict[str, Any]:
    """Run an integrator with its default steps; of an explicit one the largest stable step [s] too.

    computed: from the lattice's highest frequency; measured: by bisection, None where the flat sheet is not
    at rest without loads, or where no step near the computed one is unstable. advised: the default step [s].
    """
    import lumped

    parsed = Scene.model_validate(scene)
    springs = resolve(parsed, Lattice.given(None, lattice), "springs").springs
    duration, limits = PERIODS * period, dict.fromkeys(("computed", "measured", "advised"))
    if lumped.INTEGRATORS[integrator].explicit:
        equations = system(parsed.replace(gravity=None, loads=()), springs)
        kind = lumped.INTEGRATORS[integrator]
        limit = kind.limit(equations, np.zeros_like(equations.problem.loads.dead))
        assert limit is not None
        limits |= {"computed": limit.step, "advised": limit.advised}
        if rests_flat(parsed):
            with suppress(ArithmeticError):  # damped so much that the energy of no step grows
                limits["measured"] = measured_limit(equations, limit.step, integrator)
        duration = min(duration, STEPS * limit.advised)
    history = lumped.simulate(parsed, springs, duration, integrator=integrator, every=duration)
    return {
        **limits,
        "status": str(history.status),
        "message": history.message,
        "iterations": history.steps,
    }


def rests_flat(scene: Scene) -> bool:
    """Return whether the flat sheet is an equilibrium of the scene without its loads."""
    return not scene.actuators and all(
        isinstance(support, Clamped | Hinged | Held)
        and support.motion is None
        and not getattr(support, "tilt", 0)
        for support in scene.supports
    )
