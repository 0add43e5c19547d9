"""Prescribed motion g(t) of a lattice: what supports, bindings and actuators put in place, and its rates."""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache

import numpy as np

from lumped.actuators import Drive
from lumped.statics.problem import Problem
from sheetbench.scenes import Scene, held_axes, tilt_axes
from sheetbench.scenes.objects.supports import named
from sheetbench.scenes.objects.tables import PiecewiseCurve

ROUNDED = 1e-9  # of a velocity, that slopes on both sides of a moment may differ by


class PrescribedMotion:
    """g(t) of a scene, (size, 3) [m]. by_supports: masses, axis and displacement (3,) [m] of what supports
    move, an axis at a time; moving: whether g changes over time."""

    def __init__(self, scene: Scene, problem: Problem):
        self._coupling = problem.assembly.coupling
        # integrators ask for the same two moments several times a step
        self.place, self.rate = lru_cache(16)(self._place), lru_cache(16)(self._rate)
        self.by_supports = _by_supports(scene, problem)
        self.moving = bool(self.by_supports or (self._coupling is not None and self._coupling.moved.any()))
        self._still = problem.constraints.turned(1.0)

    @property
    def components(self) -> np.ndarray:
        """Components (size, 3) bool that g(t) moves."""
        driven = self._of_supports(lambda course: np.ones(3)) > 0.0
        if self._coupling is not None:
            driven[: self._coupling.masses][self._coupling.moved] = True
        return driven

    def _of_supports(self, value: Callable[[PiecewiseCurve], np.ndarray]) -> np.ndarray:
        """What a value (3,) of each support's course is for its masses, (size, 3), zero elsewhere."""
        g = np.zeros_like(self._still)
        for moved, axis, course in self.by_supports:
            g[moved, axis] = value(course)[axis]
        return g

    def _place(self, time: float) -> np.ndarray:
        """Return g(t), (size, 3) [m]; not to be written to."""
        if not self.moving:
            return self._still
        g = self._still + self._of_supports(lambda course: course.at(time))
        return g if self._coupling is None else g + self._coupling.driven(Drive(1.0, time))

    def _rate(self, time: float, before: bool = False) -> np.ndarray:
        """Return the velocity of g from this moment on, or until then, (size, 3) [m/s]; not to be written
        to."""
        g = self._of_supports(lambda course: course.slope(time, before))
        if self._coupling is None or not self.moving:
            return g
        return g + self._coupling.driven_velocity(time)

    def support_acceleration(self, time: float) -> np.ndarray:
        """Return the acceleration from this moment on of what supports move, (size, 3) [m/s²]."""
        return self._of_supports(lambda course: course.bend(time))

    def jumps(self, time: float) -> bool:
        """Return whether g changes its velocity at once."""
        if not self.moving:
            return False
        after = self.rate(time)
        jump = np.abs(after - self.rate(time, before=True)).max()
        return bool(jump > ROUNDED * np.abs(after).max())


def _by_supports(scene: Scene, problem: Problem) -> list[tuple[np.ndarray, int, PiecewiseCurve]]:
    found = []
    for name, support in named(scene.supports).items():
        if support.motion is not None:
            course = support.motion.course
            row = problem.constraints.holders[name][0].ravel()
            for axis in held_axes(support):
                free = ~problem.constraints.fixed[row, axis]
                found.append((row if axis in tilt_axes(support) else row[free], axis, course))
    return found
