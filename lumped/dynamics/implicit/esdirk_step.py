"""A step of `esdirk`: its stages, and the motion between its ends.

Between the ends the motion is the polynomial of fifth degree û, v̂, â through the displacements, velocities
and accelerations of both ends, corrected, since stiff springs magnify its error, to the solution of

    M (â + c₂ (u − û)) + f(u, v̂ + c₁ (u − û), t) = 0,   c₁ = 1/(γh),   c₂ = c₁²,

which lies in equilibrium along stiff directions and on the polynomial along soft ones, where the polynomial
alone would have too much energy. Energies are polynomials through the stages' powers (`tableau.CUMULATIVE`).
"""

from contextlib import suppress

import numpy as np

from lumped.dynamics.implicit.compiled_stages import Stages, polynomials
from lumped.dynamics.implicit.newton import STALE, Newton, StepEquation
from lumped.dynamics.implicit.tableau import ABSCISSAE, CUMULATIVE, ERRORS, GAMMA, STAGES
from lumped.dynamics.integrator import LatticeSamples
from lumped.dynamics.system import State, System
from lumped.dynamics.work import kinetic_of
from sheetbench.numerics.reduced_system import SingularMatrixError
from sheetbench.numerics.time.method import StepFailed

POWERS = np.arange(len(CUMULATIVE))
SMALL = 0.1  # of the excess energy allowed, up to which the middle's speaks for all samples of a step


class EsdirkStep:
    """A step of length h [s] from a state. stages: their tables, the first row the start; memories: of the
    material's branches at each stage."""

    def __init__(self, system: System, start: State, h: float):
        self.system, self.h, times = system, h, start.time + h * ABSCISSAE
        u, v, a = np.empty((3, len(times), *start.u.shape))
        u[0], v[0], a[0] = start.u, start.v, start.a
        self.stages = Stages(times, u, v, a, np.zeros((len(times), 2)))
        self.memories = [start.memory] * len(times)

    def state(self, i: int) -> State:
        """Return stage i."""
        of = self.stages
        return State(float(of.time[i]), of.u[i], of.v[i], of.a[i], self.memories[i])

    def _weighted_memory(self, weights: np.ndarray) -> np.ndarray:
        """Return a weighted sum of the branches' memories at the first stages."""
        parts = zip(weights, self.memories, strict=False)
        return np.sum([weight * memory[1:] for weight, memory in parts if memory is not None], axis=0)

    def in_stage(self, i: int) -> System:
        """Return the equations of stage i."""
        if self.system.maxwell is None:
            return self.system
        return self._with_branches(self.h * self._weighted_memory(STAGES[i, : max(i, 1)]), GAMMA * self.h)

    def _with_branches(self, relaxed: np.ndarray, h_gamma: float) -> System:
        """Return the equations of motion with branches by `Maxwell.stage`."""
        if self.system.maxwell is None or (start := self.memories[0]) is None:
            return self.system
        return self.system.with_branches(self.system.maxwell.stage(start, relaxed, h_gamma))

    def error_of_branches(self) -> float:
        """Return the error of the strains in the branches' springs, relative to the largest one."""
        maxwell, start = self.system.maxwell, self.memories[0]
        if maxwell is None or start is None:
            return 0.0
        strains = [np.abs(memory[0, 1]).max() for memory in self.memories if memory is not None]
        largest = float(max(strains))
        missed = self._weighted_memory(self.h * ERRORS)[:, 1] / maxwell.times[:, None]
        return float(np.abs(missed).max()) / largest if largest else 0.0

    def at(
        self, times: np.ndarray, end: State, newton: Newton, tolerance: float | None, enough: float
    ) -> LatticeSamples:
        """Return the states at times (k,) [s] within the step, which may take its end; energies since it
        began. tolerance: as of `Newton.solve_equation`; enough: excess energy [J] (`Newton.excess`) up to
        which the polynomial serves."""
        stages, h = self.stages, self.h
        theta = (times - stages.time[0]) / h
        u, v, a = self._within(theta)
        weights = h * (np.power.outer(theta, POWERS) @ CUMULATIVE)
        taken, put_in = (weights @ stages.power).T
        system, motion, start = self.system, self.system.prescribed, self.memories[0]
        memories: list[np.ndarray | None] = [None] * len(times)
        inside = [system] * len(times)
        if system.maxwell is not None:
            inside = [self._with_branches(self._weighted_memory(weight), 0.0) for weight in weights]
        c1, reaches_end = 1.0 / (GAMMA * h), end.time == times[-1]
        by, middle = (c1**2, c1), int(np.abs(theta - 0.5).argmin())

        def excess(i: int) -> float:
            return newton.excess(inside[i], State(float(times[i]), u[i], v[i], a[i]), by)

        # another sample had six times the excess of the one next to the middle
        for i in range(len(times) - reaches_end) if excess(middle) > SMALL * enough else ():
            if excess(i) <= enough:
                continue
            base = u[i] - a[i] / c1**2, v[i] - a[i] / c1
            equation = StepEquation(inside[i], float(times[i]), *base, by)
            corrected = u[i]  # the polynomial's stays where there is no solution
            for stale in (None, STALE):  # with the step's factors, or anew with the best
                with suppress(StepFailed, SingularMatrixError):
                    corrected = newton.solve_equation(equation, u[i], tolerance, stale)
                    break
            a[i] += c1**2 * (corrected - u[i])
            u[i] = corrected
        if reaches_end:
            u[-1], v[-1], a[-1] = end.u, end.v, end.a
        for i, one in enumerate(inside if start is not None else ()):
            if (maxwell := one.maxwell) is not None and start is not None:
                memories[i] = memory = maxwell.after(u[i])
                taken[i] -= maxwell.branches.stored(memory) - maxwell.branches.stored(start)
        if motion.moving:
            began = kinetic_of(system, motion.rate(float(stages.time[0])))
            put_in += [kinetic_of(system, motion.rate(t, before=True)) - began for t in times.tolist()]
        return LatticeSamples(times, u, v, a, memories, taken, put_in)

    def _within(self, theta: np.ndarray) -> np.ndarray:
        """Return displacements, velocities and accelerations (3, k, n, 3) at shares θ (k,) of a step, by
        polynomials, and for prescribed components by their course."""
        stages, motion = self.stages, self.system.prescribed
        if not motion.moving:
            return polynomials(stages.u, stages.v, stages.a, self.h, theta)
        began, until = float(stages.time[0]), float(stages.time[-1])
        times = (began + self.h * theta).tolist()
        u = stages.u[[0, -1]] - [motion.place(began), motion.place(until)]
        v = stages.v[[0, -1]] - [motion.rate(began), motion.rate(until, before=True)]
        motions = polynomials(u, v, stages.a, self.h, theta)
        motions[0] += np.array([motion.place(time) for time in times])
        motions[1] += np.array([motion.rate(time, before=True) for time in times])
        return motions
