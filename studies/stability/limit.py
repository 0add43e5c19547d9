"""Measured largest step at which an explicit integrator is stable.

The energy of 600 steps, from a random displacement of 1e-6 of the layer distance about a flat sheet without
loads, must not grow tenfold; bisected to 1e-3.
"""

from collections.abc import Callable

import numpy as np

import lumped
from lumped import Calibration, State, StepFailed, System
from sheetbench.scenes import Scene

STEPS, GROWTH, SHARPNESS, SMALL = 600, 10.0, 1e-3, 1e-6


def system(
    scene: Scene,
    springs: Calibration,
    mass: Callable[[np.ndarray], np.ndarray] | None = None,
) -> System:
    """Return the equations of motion. mass: changes the lumped masses (n,) [kg]."""
    problem = lumped.build_problem(scene, springs)
    equations = System(scene, problem)
    return equations if mass is None else System(scene, problem, mass(equations.lattice_mass))


def start(equations: System, u: np.ndarray) -> State:
    """Return the state at rest with displacement u (n, 3) [m]."""
    still = np.zeros_like(u)
    return State(0.0, u, still, equations.accelerate(equations.unbalanced(u, still, 0.0)))


def noise(equations: System) -> np.ndarray:
    """Return a random admissible displacement (n, 3) [m] with components of 1e-6 layer distances."""
    free = np.random.default_rng(0).standard_normal(equations.moving_part.shape[1])
    return SMALL * equations.assembly.lattice.spacing[2] * equations.expand(free)


def holds(equations: System, step: float, integrator: str = "verlet") -> bool:
    """Return whether the energy stays bounded at a step [s] of an explicit integrator."""
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
    """Return the largest stable step [s] of an integrator, by bisection between half and twice the guess.
    Raises ArithmeticError where it is not between them."""
    low, high = 0.5 * guess, 2.0 * guess
    if not holds(equations, low, integrator) or holds(equations, high, integrator):
        raise ArithmeticError(f"no limit of stability between {low:.3g} s and {high:.3g} s")
    while high - low > SHARPNESS * guess:
        middle = 0.5 * (low + high)
        low, high = (middle, high) if holds(equations, middle, integrator) else (low, middle)
    return 0.5 * (low + high)


def energy(equations: System, state: State) -> float:
    """Return kinetic and elastic energy [J]."""
    balance, _ = equations.balance(state)
    return balance["kinetic"] + balance["elastic"]
