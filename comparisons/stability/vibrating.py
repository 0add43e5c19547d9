"""A sheet that vibrates by next to nothing, so that linear theory is exact: its system, its first mode.

The measured limit of velocity Verlet: from a displacement of 1e-6 of the layer distance at random, the energy
of 600 steps must not grow tenfold; bisected to 1e-3.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

import lumped
from comparisons.stability.equilibria import sheet
from lumped import Calibration, Integrator, State, StepFailed, System, watchdog
from sheetbench.scenes import Scene

STEPS, GROWTH, SHARPNESS = 600, 10.0, 1e-3
SMALL = 1e-6


def weightless(slenderness: float = 0.016, young: float = 1e7, **material: float) -> Scene:
    """A square sheet clamped at one edge, without gravity."""
    scene = sheet(slenderness, 1.0, young=young)
    changed = scene.material.replace(**material)
    return scene.replace(gravity=None, material=changed)


def system(
    scene: Scene,
    springs: Calibration,
    precision: Any = "double",
    mass: Callable[[np.ndarray], np.ndarray] | None = None,
) -> System:
    """The equations of motion. mass: changes the lumped masses (n,) [kg]."""
    problem = lumped.pose(scene, springs, precision=precision)
    equations = System(scene, problem)
    return equations if mass is None else System(scene, problem, mass(equations.lattice_mass))


def start(equations: System, u: np.ndarray) -> State:
    """At rest with displacement u (n, 3) [m]."""
    still = np.zeros_like(u)
    return State(0.0, u, still, equations.accelerate(equations.unbalanced(u, still, 0.0)))


def noise(equations: System) -> np.ndarray:
    """A random admissible displacement (n, 3) of 1e-6 of the layer distance."""
    free = np.random.default_rng(0).standard_normal(equations.moving_part.shape[1])
    return SMALL * equations.assembly.lattice.spacing[2] * equations.expand(free)


def holds(equations: System, step: float) -> bool:
    """Whether the energy stays bounded at this step of velocity Verlet [s]."""
    method = lumped.INTEGRATORS["verlet"](equations, step)
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


def measured_limit(equations: System, guess: float) -> float:
    """The largest step at which velocity Verlet holds [s], by bisection between half and twice the guess.
    Raises ArithmeticError where it is not between them."""
    low, high = 0.5 * guess, 2.0 * guess
    if not holds(equations, low) or holds(equations, high):
        raise ArithmeticError(f"no limit of stability between {low:.3g} s and {high:.3g} s")
    while high - low > SHARPNESS * guess:
        middle = 0.5 * (low + high)
        low, high = (middle, high) if holds(equations, middle) else (low, middle)
    return 0.5 * (low + high)


def energy(equations: System, state: State) -> float:
    """Kinetic and elastic energy [J]."""
    found, _ = equations.balance(state)
    return found["kinetic"] + found["elastic"]


class FirstMode:
    """The first mode of a system about rest: ω [rad/s] and the coordinate q of a motion along it."""

    def __init__(self, equations: System, springs: Calibration):
        found = lumped.modes(equations.scene, springs, 1, "tributary")
        self.omega = 2.0 * np.pi * float(found.frequencies[0])
        self.shape = found.shapes[0]
        self._weighted = (equations.mass @ self.shape.ravel()).reshape(-1, 3)
        self._size = float(np.sum(self._weighted * self.shape))

    @property
    def period(self) -> float:
        """[s]"""
        return 2.0 * np.pi / self.omega

    def coordinate(self, motion: np.ndarray) -> float:
        """The share of the mode in a displacement or velocity (n, 3)."""
        return float(np.sum(self._weighted * motion)) / self._size


def follow(method: Integrator, state: State, step: float, count: int) -> list[State]:
    """`count` steps, the start included. Raises StepFailed, also where the energy grows from nothing, by the
    measure of `lumped.watchdog`."""
    states, first, taken = [state], energy(method.system, state), 0.0
    for _ in range(count):
        advance = method.advance(states[-1], step)
        states.append(advance.state)
        taken += advance.dissipated
        gained = energy(method.system, advance.state) + taken - first
        if fault := watchdog.energy_grows(method.system, advance.state, gained, first + abs(taken)):
            raise StepFailed(fault.message)
    return states
