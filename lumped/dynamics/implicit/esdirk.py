"""ESDIRK5(4): implicit Runge–Kutta of fifth order, damped at high frequencies, steps by their error.

    uᵢ = u₀ + h Σⱼ aᵢⱼ vⱼ,   vᵢ = v₀ + h Σⱼ aᵢⱼ v̇ⱼ,   M v̇ᵢ + f(uᵢ, vᵢ, tᵢ) = 0,   i = 2 … 7
    at the end of the step u₇, v₇

with the coefficients of `tableau` beside this file. Every stage is one equation for uᵢ with the same factors,
as aᵢᵢ = γ; the first is the last one's of the step before. The error of a step, h Σ (bᵢ − b̂ᵢ) vᵢ, is held
relative to the largest displacement so far, or to a tenth of where the forces at the start lead. Energies
taken by dampers and put in by loads and supports are h Σ bᵢ Pᵢ. What supports prescribe is taken as it is
prescribed, at every stage.

Steps may be longer than the distance of samples. Between the ends of one the motion is the polynomial of
fifth degree with their displacements, velocities and accelerations, û, v̂ and â, and then, as stiff springs
magnify what it misses, the solution of

    M (â + c₂ (u − û)) + f(u, v̂ + c₁ (u − û), t) = 0,   c₁ = 1/(γh),   c₂ = c₁²,

which lies in equilibrium along stiff directions and on the polynomial along soft ones. Energies are
polynomials through the stages' powers (`tableau.CUMULATIVE`). Steps end where something changes its course: a
load's history, a support's motion. No chains: their constraints would lower the order.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from lumped.dynamics.implicit.compiled_stages import Stages, Step
from lumped.dynamics.implicit.energy_gain import EnergyGain
from lumped.dynamics.implicit.newton import Newton, StepEquation
from lumped.dynamics.implicit.polynomial import bubbles, polynomials
from lumped.dynamics.implicit.tableau import ABSCISSAE, CUMULATIVE, ERRORS, GAMMA, GUESSES, STAGES
from lumped.dynamics.integrator import Integrator, LatticeSamples
from lumped.dynamics.system import State, System
from lumped.dynamics.work import kinetic_of, natural_power, obstacle_power
from sheetbench.errors import BadInput
from sheetbench.numerics.reduced import SingularMatrixError
from sheetbench.numerics.time.controller import Controller
from sheetbench.numerics.time.method import Advance, StepFailed
from sheetbench.runs.schedule import SAMPLES_PER_CHECKPOINT, require_error

ERROR = 3e-5  # of a step
FORETOLD = 0.1  # share of the displacement at rest, linear, that counts as reached at the start
LEAST = 1e-6  # of the sheet's side: no error is asked to be smaller beside it
ENERGY = 10.0  # of a step that touches something, times its error relative to the largest: losses add up
FIRST = 0.05  # first step over the time in which the first acceleration goes as far
STEP_TOLERANCE = 1e-11  # last correction of a fixed step relative to the sheet's side
SHARE = 0.3  # last correction of an adaptive step relative to the error it may have, or to the default one
SHARE_WITH_DAMPERS = 0.1  # whose power is that of the square of what corrections leave, along stiff springs
STALE = (
    1.5  # ratio of successive corrections above which a step, which begins with its own, makes factors anew
)
NODES = np.array([0.25, 0.5, 0.75])  # shares of a step
KEEP_FACTORS_UP_TO = 14  # corrections of a step's stages up to which the next one keeps the factors: two each


class Esdirk(Integrator):
    """ESDIRK5(4)7L[2]SA2; adaptive unless the step is `fixed`. error: of a step, relative to the largest
    displacement."""

    name, order, adaptive, options = "esdirk", 5, True, ("error",)

    def __init__(self, system: System, step: float, error: float = ERROR, fixed: bool = True):
        if system.coupling is not None:
            raise BadInput("integrator = 'esdirk': does not take chains; choose another integrator")
        require_error(error)
        super().__init__(system, step, fixed)
        self._control = Controller(5, 4.0, (1.0, 1.2), step)
        self._first, self._error = step, error
        self._newton = Newton(system, STEP_TOLERANCE, STALE)
        self._largest, self._gain = 0.0, EnergyGain(system)
        self._end: tuple[State | None, np.ndarray] = None, np.zeros(2)  # the last state, and its power

    @classmethod
    def default_step(cls, period: object, limit: object) -> float:
        """Infinite: an adaptive run finds its first step where it begins."""
        return np.inf

    @property
    def span(self) -> int:
        """Adaptive steps end at checkpoints."""
        return SAMPLES_PER_CHECKPOINT if self.adapts else 1

    def forget(self) -> None:
        """Drop the factors."""
        self._newton.forget()

    def memory(self) -> dict[str, Any]:
        """Return the step's control."""
        return {
            **self._control.memory(),
            "first": self._first,
            "largest": self._largest,
            "energy": self._gain.largest,
        }

    def recall(self, memory: dict[str, Any]) -> None:
        """Take up what `memory` gave."""
        self._control.recall(memory)
        self._first, self._largest = float(memory["first"]), float(memory["largest"])
        self._gain.largest = float(memory["energy"])

    def notes(self) -> str:
        """Return a clause on steps that counted in spite of their error."""
        return self._control.notes()

    def advance(self, state: State, at_most: float) -> Advance[State]:
        """Return one step; an adaptive one divides `at_most` evenly and is repeated until its error is small.
        Raises StepFailed."""
        if not self.adapts:
            try:
                return self._advance(state, self._stages(state, at_most, None), at_most)
            except SingularMatrixError as failure:
                raise StepFailed(str(failure)) from None
        if self._largest == 0.0:
            self._begin(state)
        state, at_most = self._from_kink(state, at_most)
        largest = self._largest

        def attempt(h: float) -> tuple[Stages, float, float]:
            nonlocal largest
            stages = self._stages(state, h, self._enough)
            error = h * float(np.abs(ERRORS @ stages.v.reshape(len(ERRORS), -1)).max())
            error = max(error, self._largest * self._error_of_branches(h))
            largest = max(self._largest, float(np.abs(stages.u[-1]).max()))
            if self.system.items:  # which are touched within steps
                found = self._advance(state, stages, h)
                gained = self._gain.of(state, found.state, found.dissipated - found.work)
                error = max(error, largest * gained * ENERGY)
            return stages, error, self._error * largest

        shortest = 1e-6 * min(self._control.step, at_most)
        stages, h = self._control.take(attempt, at_most, shortest)
        self._largest = largest
        return self._advance(state, stages, h)

    @property
    def _small(self) -> float:
        """The error that an adaptive step may have, or the default one [m]."""
        return min(self._error, ERROR) * self._largest

    @property
    def _enough(self) -> float:
        """The last correction of an adaptive step's equations [m]."""
        return (SHARE_WITH_DAMPERS if self.system.packing.damped else SHARE) * self._small

    def _begin(self, state: State) -> None:
        """What the error is relative to before anything has moved, and the first step [s]: parts of how far
        the forces lead until all rests, were it linear, and of the time in which they get there."""
        system, still = self.system.within(state), np.zeros_like(state.u)
        problem = system.problem
        force = system.unbalanced(state.u, still, state.time)
        try:
            factor = problem.system.factor(system.matrix(state.u, still, state.time, 0.0, 0.0, 1.0))
            goal = float(np.abs(problem.expand(factor.solve(problem.reduce(force)))).max())
        except SingularMatrixError:  # rigid motions are free
            goal = 0.0
        goal = min(goal, problem.size)
        fastest = float(np.abs(system.accelerate(force)).max())
        if goal > 0.0:
            self._control.step = self._first = min(self._control.step, FIRST * np.sqrt(goal / fastest))
        self._largest = max(FORETOLD * goal, LEAST * problem.size, float(np.abs(state.u).max()))

    def _from_kink(self, state: State, at_most: float) -> tuple[State, float]:
        """The state with its acceleration from now on, and how long nothing changes its course at most."""
        system, now = self.system, state.time
        if not len(system.kinks):
            return state, at_most
        near = 1e-9 * at_most
        if np.any(np.abs(system.kinks - now) < near) and now > near:
            if system.prescribed.jumps(now):  # and so do dampers: the steps begin as at the start
                self._control.step = min(self._control.step, self._first)
            force = system.within(state).unbalanced(state.u, state.v, now)
            state = replace(state, time=now, a=system.accelerate(force))
        ahead = system.kinks[system.kinks > now + near]
        return state, min([at_most, *(ahead[:1] - now)])

    def _stages(self, state: State, h: float, tolerance: float | None) -> Stages:
        """All stages of a step."""
        by, times = 1.0 / (GAMMA * h), state.time + h * ABSCISSAE
        u, v, a = np.empty((3, len(times), *state.u.shape))
        u[0], v[0], a[0] = state.u, state.v, state.a
        stages = Stages(times, u, v, a, np.zeros((len(times), 2)))
        self._memories = [state.memory] * len(times)
        if not (self._newton.near(by * by) and 0 < self._newton.made <= KEEP_FACTORS_UP_TO):
            middle, system = state.u + 0.5 * h * state.v, self._in_stage(0, h)
            equation = StepEquation(system, state.time + 0.5 * h, middle, state.v, by * by, by)
            self._newton.renew(equation, middle)
        loads = self.system.loads(times.tolist())
        step = Step(h, STAGES, GUESSES, by, by * by, *self._shifts(times, h), loads)
        if not self._newton.solve_stages(step, stages, tolerance):
            self._solve_one_by_one(step, stages, tolerance)
        return stages

    def _shifts(self, times: np.ndarray, h: float) -> tuple[np.ndarray, np.ndarray]:
        """How far supports are from where the stages' velocities lead, (7, n, 3) [m], and their velocities
        beside that at the start, (7, n, 3) [m/s]; both empty where none moves."""
        system, motion, began = self.system, self.system.prescribed, float(times[0])
        if not motion.moving:
            nothing = np.empty((0, *system.problem.loads.dead.shape))
            return nothing, nothing
        later = [float(time) for time in times[1:]]
        rates = np.array([motion.rate(began), *(motion.rate(t, before=True) for t in later)])
        places = np.array([motion.place(t) for t in (began, *later)])
        return places - places[0] - h * np.tensordot(STAGES, rates, 1), rates - rates[0]

    def _solve_one_by_one(self, step: Step, stages: Stages, tolerance: float | None) -> None:
        """Fill the tables of stages by the general iteration."""
        h, c1, c2 = step.length, step.damping_coefficient, step.mass_coefficient
        for i in range(1, len(ABSCISSAE)):
            u = stages.u[0] + h * np.tensordot(STAGES[i, :i], stages.v[:i], 1)
            v = stages.v[0] + h * np.tensordot(STAGES[i, :i], stages.a[:i], 1)
            if len(step.shifts):
                u, v = u + step.shifts[i], v + step.turns[i]
            system = self._in_stage(i, h)
            equation = StepEquation(system, float(stages.time[i]), u + v / c1, v, c2, c1)
            guess = equation.base_u + np.tensordot(GUESSES[i, :i], stages.a[:i], 1) / c1**2
            u = self._newton.solve_equation(equation, guess, tolerance)
            stages.u[i] = u
            stages.v[i], stages.a[i] = self._newton.state(equation, u)
            if system.maxwell is not None:
                self._memories[i] = system.maxwell.after(u)
            stages.power[i, 0] = self.system.power(self._stage(stages, i))

    def _stage(self, stages: Stages, i: int) -> State:
        return State(float(stages.time[i]), stages.u[i], stages.v[i], stages.a[i], self._memories[i])

    def _relaxed(self, weights: np.ndarray) -> np.ndarray:
        """A weighted sum of what the branches kept at the first stages."""
        parts = zip(weights, self._memories, strict=False)
        return np.sum([weight * memory[1:] for weight, memory in parts if memory is not None], axis=0)

    def _in_stage(self, i: int, h: float) -> System:
        """The equations of stage i."""
        if self.system.maxwell is None:
            return self.system
        return self._relaxing(h * self._relaxed(STAGES[i, : max(i, 1)]), GAMMA * h)

    def _relaxing(self, relaxed: np.ndarray, own: float) -> System:
        """The equations with the branches as `Maxwell.stage` has them."""
        if self.system.maxwell is None or (start := self._memories[0]) is None:
            return self.system
        return self.system.with_branches(self.system.maxwell.stage(start, relaxed, own))

    def _error_of_branches(self, h: float) -> float:
        """Error of what the branches' springs remember in a step, relative to the largest strain."""
        maxwell, start = self.system.maxwell, self._memories[0]
        if maxwell is None or start is None:
            return 0.0
        strains = [np.abs(memory[0, 1]).max() for memory in self._memories if memory is not None]
        largest = float(max(strains))
        missed = self._relaxed(h * ERRORS)[:, 1] / maxwell.times[:, None]
        return float(np.abs(missed).max()) / largest if largest else 0.0

    def at(self, times: np.ndarray, last: Advance[State]) -> LatticeSamples:
        """Return the states at times (k,) [s] within the last step; energies since it began."""
        end = last.state
        if end.time == times[0]:
            return super().at(times, last)
        stages, h = self._step
        theta = (times - stages.time[0]) / h
        u, v, a = self._within(stages, h, theta)
        weights = h * (np.vander(theta, len(CUMULATIVE), increasing=True) @ CUMULATIVE)
        taken, put_in = (weights @ stages.power).T
        system, motion, start = self.system, self.system.prescribed, self._memories[0]
        memories: list[np.ndarray | None] = [None] * len(times)
        inside = [system] * len(times)
        if system.maxwell is not None:
            inside = [self._relaxing(self._relaxed(weight), 0.0) for weight in weights]
        c1, within = 1.0 / (GAMMA * h), len(times) - (end.time == times[-1])
        equations = [
            StepEquation(*at, c1**2, c1)
            for at in zip(inside, times.tolist(), u - a / c1**2, v - a / c1, strict=True)
        ]
        a -= c1**2 * u
        self._correct(equations[:within], theta[:within], u[:within])
        a += c1**2 * u
        if end.time == times[-1]:
            u[-1], v[-1], a[-1] = end.u, end.v, end.a
        for i, maxwell in enumerate(one.maxwell for one in inside):
            if maxwell is not None and start is not None:
                memories[i] = memory = maxwell.after(u[i])
                taken[i] -= maxwell.branches.stored(memory) - maxwell.branches.stored(start)
        if motion.moving:
            began = kinetic_of(system, motion.rate(float(stages.time[0])))
            put_in += [kinetic_of(system, motion.rate(t, before=True)) - began for t in times.tolist()]
        return LatticeSamples(times, u, v, a, memories, taken, put_in)

    def _correct(self, equations: list[StepEquation], theta: np.ndarray, u: np.ndarray) -> None:
        """Put the solutions of equations at shares θ (k,) of a step, inside it, in place of polynomials u
        (k, n, 3): those nearest to some shares first. What corrects them is of the third order at the step's
        ends; what passes through it corrects the others, to begin with, and for good where it is small."""
        first = np.unique(np.abs(theta - NODES[:, None]).argmin(axis=1))
        others = np.delete(np.arange(len(theta)), first)
        moved = self._solve(equations, first, u)
        if not len(others):
            return
        if moved is not None:
            shares = bubbles(theta[first], theta[others])
            u[others] += (shares @ moved.reshape(len(first), -1)).reshape(len(others), *moved.shape[1:])
            if not self.system.items and np.abs(moved).max() < self._small:
                return
        self._solve(equations, others, u)

    def _solve(self, equations: list[StepEquation], of: np.ndarray, u: np.ndarray) -> np.ndarray | None:
        """Put the solutions of some of the equations in place of guesses; what that changed, or nothing if
        some have none."""
        found = u[of]
        tolerance = SHARE * self._small if self.adapts else None
        failures = self._newton.solve_equations([equations[i] for i in of], found, tolerance)
        moved: np.ndarray = found - u[of]
        u[of] = found
        return None if failures else moved

    def _within(self, stages: Stages, h: float, theta: np.ndarray) -> np.ndarray:
        """Displacements, velocities and accelerations (3, k, n, 3) at shares θ (k,) of a step: polynomials,
        and what is prescribed as it is prescribed."""
        u, v, a = stages.u[[0, -1]], stages.v[[0, -1]], stages.a[[0, -1]]
        motion = self.system.prescribed
        if not motion.moving:
            return polynomials(u, v, a, h, theta)
        began, until = float(stages.time[0]), float(stages.time[-1])
        times = (began + h * theta).tolist()
        u -= np.array([motion.place(began), motion.place(until)])
        v -= np.array([motion.rate(began), motion.rate(until, before=True)])
        found = polynomials(u, v, a, h, theta)
        found[0] += np.array([motion.place(time) for time in times])
        found[1] += np.array([motion.rate(time, before=True) for time in times])
        return found

    def _advance(self, start: State, stages: Stages, h: float) -> Advance[State]:
        system, motion, power = self.system, self.system.prescribed, stages.power
        if self._end[0] is start:
            power[0] = self._end[1]
        else:
            power[0] = self._power(start)
        end = self._stage(stages, -1)
        if motion.moving or system.working or system.pushed:
            for i in range(1, len(power)):
                power[i, 1] = self._put_in(self._stage(stages, i), before=True)
        self._step = stages, h
        taken, put_in = h * (STAGES[-1] @ power)
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
        """Power [W] that dampers take and that is put in from a state on."""
        return np.array([self.system.power(state), self._put_in(state)])

    def _put_in(self, stage: State, before: bool = False) -> float:
        """Power [W] that moving supports, but for what speeds up their own masses, and loads without a
        potential put in from a moment on, or until then."""
        system, motion, put_in = self.system, self.system.prescribed, 0.0
        if motion.moving:
            put_in += float(np.sum(system.exerted(stage) * motion.rate(stage.time, before=before)))
        if system.working:
            force = system.external(stage.u, stage.time) - system.problem.loads.dead
            put_in += float(np.sum(force * stage.v))
            put_in += natural_power(system, stage.u, stage.time, before)
        return put_in + (obstacle_power(system, stage) if system.pushed else 0.0)
