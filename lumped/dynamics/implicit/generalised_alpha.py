"""Generalised-α of a lattice (`sheetbench.numerics.time.rule`), chains and their multipliers included.

What supports prescribe is taken as it is prescribed: accelerations are those beside it.
"""

import numpy as np

from lumped.dynamics.implicit.newton import Newton, StepEquation
from lumped.dynamics.integrator import Integrator
from lumped.dynamics.system import State, System
from lumped.dynamics.work import work
from sheetbench.numerics.time.controller import Controller
from sheetbench.numerics.time.method import Advance, StepFailed
from sheetbench.numerics.time.rule import generalised, shifted, step_of

ERROR = 1e-6  # of a step, relative to the largest displacement so far
STEP_TOLERANCE = 1e-11  # last correction relative to the sheet's side


class GeneralisedAlpha(Integrator):
    """Generalised-α with radius ρ∞; adaptive unless the step is `fixed`."""

    name, order, adaptive, options = "generalised-alpha", 2, True, ("radius",)
    remembered = ("_algorithm", "_before", "_largest")
    control: Controller

    def __init__(self, system: System, step: float, radius: float = 0.9, fixed: bool = True):
        super().__init__(system, step, fixed)
        self.control = Controller(3, 2.0, (1.0, 1.3), step)
        self._rule = generalised(radius)
        self._newton = Newton(system, STEP_TOLERANCE)
        self._algorithm: np.ndarray | None = None
        self._before = self._largest = 0.0
        self._taken: tuple[State | None, float] = None, 0.0  # the power of the dampers at the last state

    def forget(self) -> None:
        """Drop the factors."""
        self._newton.forget()

    def advance(self, state: State, at_most: float) -> Advance[State]:
        """Return one step; an adaptive one divides `at_most` evenly and is repeated until its error is small.
        Raises StepFailed, or SingularMatrixError."""
        if not self.adapts:
            return self._advance(state, *self._step(state, at_most), at_most)
        largest = self._largest

        def attempt(h: float) -> tuple[tuple[State, np.ndarray], float, float]:
            nonlocal largest
            after, algorithm = self._step(state, h)
            jump = float(np.abs((algorithm - self._previous_acceleration(state, h))[: self._masses]).max())
            largest = max(self._largest, float(np.abs(after.u[: self._masses]).max()))
            allowed = ERROR * max(largest, 1e-6 * self.system.problem.size)
            return (after, algorithm), h * h * self._rule.error * jump, allowed

        step, h = self.control.take(attempt, at_most, 1e-6 * self.control.step)
        self._largest = largest
        return self._advance(state, *step, h)

    def _advance(self, state: State, after: State, algorithm: np.ndarray, h: float) -> Advance[State]:
        self._algorithm, self._before = algorithm, h
        after, relaxed = self.system.relaxed(state, after)
        if self._taken[0] is not state:
            self._taken = state, self.system.damping_force(state.u, state.v, state.time)[0]
        before, power = self._taken[1], self.system.damping_force(after.u, after.v, after.time)[0]
        self._taken = after, power
        return Advance(after, 0.5 * h * (before + power) + relaxed, work(self.system, state, after))

    def _previous_acceleration(self, state: State, h: float) -> np.ndarray:
        """Return the algorithm's acceleration at a step's start."""
        if self._algorithm is None:
            return state.a
        return shifted(state.a, self._algorithm, h, self._before)

    @property
    def _masses(self) -> int:
        return len(self.system.lattice_mass)

    def _step(self, state: State, h: float) -> tuple[State, np.ndarray]:
        system, time = self.system, state.time + h
        motion = system.prescribed
        held = motion.place(time) - motion.place(state.time) - h * motion.rate(state.time)
        turn = motion.rate(time) - motion.rate(state.time)
        step = step_of(self._rule, h, state.u, state.v, state.a, self._previous_acceleration(state, h))
        base_u, base_v = step.base_u + held, step.base_v + turn
        equation = StepEquation(system.for_step(state, h), time, base_u, base_v, (step.by_a, step.by_v))
        try:
            u = self._newton.solve_equation(equation, base_u + state.a / step.by_a)
        except StepFailed:  # after a jump the old acceleration leads nowhere
            u = self._newton.solve_equation(equation, state.u + held + h * state.v)
        v, a = equation.state(u)
        return State(time, u, v, a), step.algorithm(a)
