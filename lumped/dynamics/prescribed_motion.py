"""Prescribed motion g(t) of a lattice by supports, bindings and actuators, and its rates."""

from collections.abc import Callable
from functools import lru_cache

import numpy as np

from lumped.actuators import Drive
from lumped.statics.problem import Problem
from sheetbench.scenes import Scene, held_axes, tilt_axes
from sheetbench.scenes.objects.supports import named
from sheetbench.scenes.objects.tables import PiecewiseCurve

ROUNDED = 1e-9  # relative difference up to which the slopes on both sides of a time are equal


class PrescribedMotion:
    """Prescribed motion g(t) of a scene, (size, 3) [m]. by_supports: masses that a support moves, an axis of
    the motion, and the course of its displacement (3,) [m]; moving: whether g changes over time."""

    def __init__(self, scene: Scene, problem: Problem):
        self._coupling = problem.assembly.coupling
        # integrators need g at two times several times a step
        self.place, self.rate = lru_cache(16)(self._displacement), lru_cache(16)(self._velocity)
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
        """Return a value (3,) of each support's course for the masses that it moves, (size, 3), else 0."""
        g = np.zeros_like(self._still)
        for moved, axis, course in self.by_supports:
            g[moved, axis] = value(course)[axis]
        return g

    def _displacement(self, time: float) -> np.ndarray:
        """Return g(t), (size, 3) [m]; not to be written to."""
        if not self.moving:
            return self._still
        g = self._still + self._of_supports(lambda course: course.at(time))
        return g if self._coupling is None else g + self._coupling.prescribed_displacement(Drive(1.0, time))

    def _velocity(self, time: float, before: bool = False) -> np.ndarray:
        """Return the velocity of g just after a time, or just before, (size, 3) [m/s]; not to be written
        to."""
        g = self._of_supports(lambda course: course.slope(time, before))
        if self._coupling is None or not self.moving:
            return g
        return g + self._coupling.prescribed_velocity(time)

    def support_acceleration(self, time: float) -> np.ndarray:
        """Return the acceleration of g by supports just after a time, (size, 3) [m/s²]."""
        return self._of_supports(lambda course: course.bend(time))

    def jumps(self, time: float) -> bool:
        """Return whether the velocity of g is discontinuous at a time."""
        if not self.moving:
            return False
        after = self.rate(time)
        jump = np.abs(after - self.rate(time, before=True)).max()
        return bool(jump > ROUNDED * np.abs(after).max())


def _by_supports(scene: Scene, problem: Problem) -> list[tuple[np.ndarray, int, PiecewiseCurve]]:
    motions = []
    for name, support in named(scene.supports).items():
        if support.motion is not None:
            course = support.motion.course
            row = problem.constraints.holders[name][0].ravel()
            for axis in held_axes(support):
                free = ~problem.constraints.fixed[row, axis]
                motions.append((row if axis in tilt_axes(support) else row[free], axis, course))
    return motions
