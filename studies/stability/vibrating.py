"""A sheet that vibrates by next to nothing, so that linear theory is exact: its first mode."""

from __future__ import annotations

import numpy as np

import lumped
from comparisons.stability.limit import energy
from lumped import Calibration, Integrator, State, StepFailed, System
from sheetbench.scenes import Scene
from studies.stability.equilibria import sheet


def weightless(slenderness: float = 0.016, young: float = 1e7, **material: float) -> Scene:
    """A square sheet clamped at one edge, without gravity."""
    scene = sheet(slenderness, 1.0, young=young)
    changed = scene.material.replace(**material)
    return scene.replace(gravity=None, material=changed)


class FirstMode:
    """The first mode of a system about rest: ω [rad/s] and the coordinate q of a motion along it."""

    def __init__(self, equations: System, springs: Calibration):
        modes = lumped.modes(equations.scene, springs, 1, equations.assembly.inertia)
        self.omega = 2.0 * np.pi * float(modes.frequencies[0])
        self.shape = modes.shapes[0]
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
    """`count` steps, the start included. Raises StepFailed, also where as much energy comes from nothing as
    there is."""
    states, first, taken = [state], energy(method.system, state), 0.0
    for _ in range(count):
        advance = method.advance(states[-1], step)
        states.append(advance.state)
        taken += advance.dissipated
        gained = energy(method.system, advance.state) + taken - first
        if gained > first + abs(taken):
            raise StepFailed(f"at {advance.state.time:.6g} s the energy has doubled out of nothing")
    return states
