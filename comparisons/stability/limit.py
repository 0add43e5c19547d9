"""The largest step at which an explicit integrator is stable, measured; and how a run with its default step
ends.

From a displacement of 1e-6 of the layer distance at random, about a flat sheet without loads, the energy of
600 steps must not grow tenfold; bisected to 1e-3.
"""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass
from typing import Any

import numpy as np

import lumped
from comparisons.models.resolve import resolve
from comparisons.models.spec import Lattice
from comparisons.sweep.campaign import Run
from comparisons.sweep.solved import Ask
from lumped import Calibration, State, StepFailed, System
from sheetbench.scenes import Clamped, Held, Hinged, Scene


@dataclass(frozen=True)
class DefaultSteps(Ask):
    """A run of an integrator with its default steps about the lowest `period` [s], and its largest step."""

    @property
    def task(self) -> Run:
        arguments = {"scene": self.scene.document(), "lattice": self.spec.settings, **self.run}
        return Run("stability.run", arguments, self.label)


STEPS, GROWTH, SHARPNESS = 600, 10.0, 1e-3
RUN_STEPS, PERIODS = 500, 2.0  # of a run: explicit steps at most, lowest periods at most
SMALL = 1e-6


def system(
    scene: Scene,
    springs: Calibration,
    precision: Any = "double",
    mass: Callable[[np.ndarray], np.ndarray] | None = None,
) -> System:
    """Return the equations of motion. mass: changes the lumped masses (n,) [kg]."""
    problem = lumped.build_problem(scene, springs, precision=precision)
    equations = System(scene, problem)
    return equations if mass is None else System(scene, problem, mass(equations.lattice_mass))


def start(equations: System, u: np.ndarray) -> State:
    """At rest with displacement u (n, 3) [m]."""
    still = np.zeros_like(u)
    return State(0.0, u, still, equations.accelerate(equations.unbalanced(u, still, 0.0)))


def noise(equations: System) -> np.ndarray:
    """Return a random admissible displacement (n, 3) of 1e-6 of the layer distance."""
    free = np.random.default_rng(0).standard_normal(equations.moving_part.shape[1])
    return SMALL * equations.assembly.lattice.spacing[2] * equations.expand(free)


def holds(equations: System, step: float, integrator: str = "verlet") -> bool:
    """Return whether the energy stays bounded at this step of an explicit integrator [s]."""
    method = lumped.INTEGRATORS[integrator](equations, step)
    state = start(equations, noise(equations))
    first = energy(equations, state)
    with np.errstate(over="ignore", invalid="ignore"):
        for number in range(STEPS):
            try:
                state = method.advance(state, step).state
            except StepFailed:
                return False
            if number % 20 == 19 and not energy(equations, state) < GROWTH * first:
                return False
    return True


def measured_limit(equations: System, guess: float, integrator: str = "verlet") -> float:
    """Return the largest step at which an integrator holds [s], by bisection between half and twice the
    guess. Raises ArithmeticError where it is not between them."""
    low, high = 0.5 * guess, 2.0 * guess
    if not holds(equations, low, integrator) or holds(equations, high, integrator):
        raise ArithmeticError(f"no limit of stability between {low:.3g} s and {high:.3g} s")
    while high - low > SHARPNESS * guess:
        middle = 0.5 * (low + high)
        low, high = (middle, high) if holds(equations, middle, integrator) else (low, middle)
    return 0.5 * (low + high)


def energy(equations: System, state: State) -> float:
    """Kinetic and elastic energy [J]."""
    balance, _ = equations.balance(state)
    return balance["kinetic"] + balance["elastic"]


def run(scene: dict[str, Any], lattice: dict[str, Any], integrator: str, period: float) -> dict[str, Any]:
    """Run an integrator with its default steps; of an explicit one the largest stable step [s] too.

    computed: from the lattice's highest frequency; measured: by bisection, None where the flat sheet is not
    at rest without loads, or where no step near the computed one is unstable. advised: the default step [s].
    """
    parsed = Scene.model_validate(scene)
    springs = resolve(parsed, Lattice(**lattice), "springs").springs
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
        duration = min(duration, RUN_STEPS * limit.advised)
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
