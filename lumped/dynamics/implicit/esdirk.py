"""ESDIRK5(4): implicit Runge–Kutta of fifth order, damped at high frequencies, steps by their error.

    uᵢ = u₀ + h Σⱼ aᵢⱼ vⱼ,   vᵢ = v₀ + h Σⱼ aᵢⱼ v̇ⱼ,   M v̇ᵢ + f(uᵢ, vᵢ, tᵢ) = 0,   i = 2 … 7
    at the end of the step u₇, v₇

with the coefficients of `tableau`. Every stage is one equation for uᵢ with common factors, because aᵢᵢ = γ;
the first stage is the last one of the previous step. The error of a step, h Σ (bᵢ − b̂ᵢ) vᵢ, is controlled
relative to the largest displacement so far, or to a tenth of the displacement to which the forces at the
start lead. Energies dissipated by dampers and supplied by loads and supports are h Σ bᵢ Pᵢ. Prescribed
motions of supports are exact at every stage.

Steps may be longer than the distance of samples, which lie within them (`esdirk_step`). They end where
something changes its course: a load's history, a support's motion. No chains: their constraints would lower
the order.
"""

from dataclasses import replace

import numpy as np

from lumped.dynamics.implicit.compiled_stages import Step, largest
from lumped.dynamics.implicit.esdirk_step import EsdirkStep
from lumped.dynamics.implicit.newton import Newton, StepEquation
from lumped.dynamics.implicit.tableau import ABSCISSAE, ERRORS, GAMMA, GUESSES, STAGES
from lumped.dynamics.integrator import Integrator, LatticeSamples
from lumped.dynamics.system import State, System
from lumped.dynamics.work import kinetic_of, natural_power, obstacle_power
from sheetbench.errors import BadInput
from sheetbench.numerics.direct import SOLVED
from sheetbench.numerics.reduced_system import SingularMatrixError
from sheetbench.numerics.time.controller import Controller
from sheetbench.numerics.time.method import Advance
from sheetbench.runs.schedule import SAMPLES_PER_CHECKPOINT, require_error

ERROR = 3e-5  # of a step
LINEAR_SHARE = 0.1  # share of the displacement at rest, linear, that counts as reached at the start
LEAST = 1e-6  # of the sheet's side: no error is asked to be smaller beside it
ENERGY = 10.0  # of a step that touches something, times its error relative to the largest: losses add up
FIRST = 0.05  # first step over the time in which the first acceleration goes as far
STEP_TOLERANCE = 1e-11  # last correction of a fixed step relative to the sheet's side
SHARE = 0.3  # last correction of an adaptive step relative to the error it may have, or to the default one
SHARE_WITH_DAMPERS = 0.1  # whose power is that of the square of what corrections leave, along stiff springs
STALE = 1.5  # ratio of corrections above which a step, which begins with its own factors, makes new ones
KEEP_FACTORS_UP_TO = 14  # corrections of a step's stages up to which the next one keeps the factors: two each
END = np.eye(len(STAGES))[-1]  # weights of the stages at a step's end
LENGTHEN_UP_TO = 22  # and up to which it may be longer: four each, beyond which shorter steps cost less


class Esdirk(Integrator):
    """ESDIRK5(4)7L[2]SA2; adaptive unless the step is `fixed`. error: of a step, relative to the largest
    displacement."""

    name, order, adaptive, options = "esdirk", 5, True, ("error",)
    remembered = ("_first", "_largest", "_energy")
    control: Controller

    def __init__(self, system: System, step: float, error: float = ERROR, fixed: bool = True):
        if system.coupling is not None:
            raise BadInput("integrator = 'esdirk': does not take chains; choose another integrator")
        require_error(error)
        super().__init__(system, step, fixed)
        self.span = 1 if fixed else SAMPLES_PER_CHECKPOINT  # adaptive steps end at checkpoints
        self.control = Controller(5, 4.0, (1.0, 1.2), step)
        self._first, self._error = step, error
        self._newton = Newton(system, STEP_TOLERANCE, STALE)
        self._largest, self._energy = 0.0, 0.0  # displacement, and part of the energy
        self._end: tuple[State | None, np.ndarray] = None, np.zeros(2)  # the last state, and its power

    @classmethod
    def default_step(cls, period: object, limit: object) -> float:
        """Return ∞: an adaptive run computes its first step at its start."""
        return np.inf

    def forget(self) -> None:
        """Drop the factors, and the power of the last state."""
        self._newton.forget()
        self._end = None, np.zeros(2)

    def advance(self, state: State, at_most: float) -> Advance[State]:
        """Return one step; an adaptive one divides `at_most` evenly and is repeated until its error is small.
        Raises StepFailed, or SingularMatrixError."""
        if not self.adapts:
            return self._advance(state, self._solve_step(state, at_most, None))
        if self._largest == 0.0:
            self._set_first_step(state)
        state, at_most = self._from_kink(state, at_most)
        reached, began = self._largest, self._energies(state) if self.system.contacts else []
        # the last correction [m] of the step's equations
        enough = (SHARE_WITH_DAMPERS if self.system.packing.damped else SHARE) * self._allowed_error

        def attempt(h: float) -> tuple[EsdirkStep, float, float]:
            nonlocal reached
            step = self._solve_step(state, h, enough)
            error = h * largest(ERRORS, step.stages.v)
            error = max(error, self._largest * step.error_of_branches())
            reached = max(self._largest, largest(END, step.stages.u))
            if self.system.contacts:  # which are touched within steps
                advance = self._advance(state, step)
                now = self._energies(advance.state)
                self._energy = max(self._energy, *map(abs, now))
                gained = abs(sum(now) - sum(began) + advance.dissipated - advance.work)
                error = max(error, reached * ENERGY * gained / (self._energy or 1.0))
            return step, error, self._error * reached

        shortest = 1e-6 * min(self.control.step, at_most)
        step, h = self.control.take(attempt, at_most, shortest)
        if self._newton.made > LENGTHEN_UP_TO:
            self.control.step = min(self.control.step, h)
        self._largest = reached
        return self._advance(state, step)

    def _energies(self, state: State) -> list[float]:
        return list(self.system.balance(state)[0].values())

    @property
    def _allowed_error(self) -> float:
        """Return the error that an adaptive step may have, or the default one [m]."""
        return min(self._error, ERROR) * self._largest

    def _set_first_step(self, state: State) -> None:
        """Set the first step [s], and the scale of the errors before any motion: fractions of the time and
        distance in which a linear lattice would reach equilibrium."""
        system, still = self.system.for_step(state), np.zeros_like(state.u)
        problem = system.problem
        force = system.unbalanced(state.u, still, state.time)
        try:
            factor = problem.system.factor(system.matrix(state.u, still, state.time, 0.0, 0.0, 1.0))
            goal = float(np.abs(problem.expand(factor.solve(problem.reduce(force), SOLVED))).max())
        except SingularMatrixError:  # rigid motions are free
            goal = 0.0
        goal = min(goal, problem.size)
        fastest = float(np.abs(system.accelerate(force)).max())
        if goal > 0.0:
            self.control.step = self._first = min(self.control.step, FIRST * np.sqrt(goal / fastest))
        self._largest = max(LINEAR_SHARE * goal, LEAST * problem.size, float(np.abs(state.u).max()))

    def _from_kink(self, state: State, at_most: float) -> tuple[State, float]:
        """Return the state with its acceleration just after its time, and the largest step [s] before the
        next kink of a load or motion."""
        system, now = self.system, state.time
        if not len(system.kinks):
            return state, at_most
        near = 1e-9 * at_most
        if np.any(np.abs(system.kinks - now) < near) and now > near:
            if system.prescribed.jumps(now):  # and so do dampers: the steps begin as at the start
                self.control.step = min(self.control.step, self._first)
            force = system.for_step(state).unbalanced(state.u, state.v, now)
            state = replace(state, time=now, a=system.accelerate(force))
        ahead = system.kinks[system.kinks > now + near]
        return state, min([at_most, *(ahead[:1] - now)])

    def _solve_step(self, state: State, h: float, tolerance: float | None) -> EsdirkStep:
        """Return a step with all its stages."""
        by, step = 1.0 / (GAMMA * h), EsdirkStep(self.system, state, h)
        if not (self._newton.can_reuse_factors(by * by) and 0 < self._newton.made <= KEEP_FACTORS_UP_TO):
            middle = state.u + 0.5 * h * (state.v + 0.25 * h * state.a)
            equation = StepEquation(step.in_stage(0), state.time + 0.5 * h, middle, state.v, (by * by, by))
            self._newton.renew(equation, middle)
        times = step.stages.time
        shifts, turns = self._support_offsets(times, h)
        given = Step(h, STAGES, GUESSES, by, by * by, shifts, turns, self.system.loads(times.tolist()))
        if not self._newton.solve_stages(given, step.stages, tolerance):
            self._solve_one_by_one(given, step, tolerance)
        return step

    def _support_offsets(self, times: np.ndarray, h: float) -> tuple[np.ndarray, np.ndarray]:
        """Return the offsets of the supports from the positions by the stages' velocities, (7, n, 3) [m], and
        of their velocities from those at the start, (7, n, 3) [m/s]; both empty without moving supports."""
        system, motion, began = self.system, self.system.prescribed, float(times[0])
        if not motion.moving:
            nothing = np.empty((0, *system.problem.loads.dead.shape))
            return nothing, nothing
        later = [float(time) for time in times[1:]]
        rates = np.array([motion.rate(began), *(motion.rate(t, before=True) for t in later)])
        places = np.array([motion.place(t) for t in (began, *later)])
        return places - places[0] - h * np.tensordot(STAGES, rates, 1), rates - rates[0]

    def _solve_one_by_one(self, given: Step, step: EsdirkStep, tolerance: float | None) -> None:
        """Fill the tables of stages by the general iteration."""
        stages, h, c1, c2 = step.stages, step.h, given.damping_coefficient, given.mass_coefficient
        for i in range(1, len(ABSCISSAE)):
            u = stages.u[0] + h * np.tensordot(STAGES[i, :i], stages.v[:i], 1)
            v = stages.v[0] + h * np.tensordot(STAGES[i, :i], stages.a[:i], 1)
            if len(given.shifts):
                u, v = u + given.shifts[i], v + given.turns[i]
            system = step.in_stage(i)
            equation = StepEquation(system, float(stages.time[i]), u + v / c1, v, (c2, c1))
            guess = equation.base_u + np.tensordot(GUESSES[i, :i], stages.a[:i], 1) / c1**2
            stages.u[i] = u = self._newton.solve_equation(equation, guess, tolerance)
            stages.v[i], stages.a[i] = equation.state(u)
            if system.maxwell is not None:
                step.memories[i] = system.maxwell.after(u)
            stages.power[i, 0] = self.system.power(step.state(i))

    def at(self, times: np.ndarray, last: Advance[State]) -> LatticeSamples:
        """Return the states at times (k,) [s] within the last step; energies since it began."""
        if last.state.time == times[0]:
            return super().at(times, last)
        tolerance = SHARE * self._allowed_error if self.adapts else None
        self._energy = max(self._energy, kinetic_of(self.system, last.state.v))
        enough = ENERGY * min(self._error, ERROR) * self._energy if self.adapts else 0.0
        return self._step.at(times, last.state, self._newton, tolerance, enough)

    def _advance(self, start: State, step: EsdirkStep) -> Advance[State]:
        system, motion, power = self.system, self.system.prescribed, step.stages.power
        last = self._end[0]
        same = last is start or (self.adapts and last is not None and last.a is start.a)  # but for its time
        power[0] = self._end[1] if same else self._power(start)
        self._step, end = step, step.state(-1)
        if motion.moving or system.nonconservative or system.pushed:
            for i in range(1, len(power)):
                power[i, 1] = self._power_input(step.state(i), before=True)
        taken, put_in = step.h * (STAGES[-1] @ power)
        if system.maxwell is not None and start.memory is not None and end.memory is not None:
            branches = system.maxwell.branches
            taken -= branches.stored(end.memory) - branches.stored(start.memory)
        if motion.moving:
            rate = motion.rate(end.time)
            end = replace(end, v=end.v + rate - motion.rate(end.time, before=True))
            put_in += kinetic_of(system, rate) - kinetic_of(system, motion.rate(start.time))
        self._end = end, self._power(end) if motion.jumps(end.time) else power[-1]
        return Advance(end, float(taken), float(put_in))

    def _power(self, state: State) -> np.ndarray:
        """Return the power [W] that dampers dissipate and the power supplied, just after a state's time."""
        return np.array([self.system.power(state), self._power_input(state)])

    def _power_input(self, stage: State, before: bool = False) -> float:
        """Return the power [W] supplied by moving supports, without the acceleration of their own masses, and
        by loads without a potential; before: just before the stage's time, else just after it."""
        system, motion, put_in = self.system, self.system.prescribed, 0.0
        if motion.moving:
            put_in += float(np.sum(system.exerted(stage) * motion.rate(stage.time, before=before)))
        if system.nonconservative:
            force = system.external(stage.u, stage.time) - system.problem.loads.dead
            put_in += float(np.sum(force * stage.v))
            put_in += natural_power(system, stage.u, stage.time, before)
        return put_in + (obstacle_power(system, stage) if system.pushed else 0.0)
