"""ESDIRK5(4): implicit Runge–Kutta of fifth order, damped at high frequencies, steps by their error.

    uᵢ = u₀ + h Σⱼ aᵢⱼ vⱼ,   vᵢ = v₀ + h Σⱼ aᵢⱼ v̇ⱼ,   M v̇ᵢ + f(uᵢ, vᵢ, tᵢ) = 0,   i = 2 … 7
    at the end of the step u₇, v₇

with the coefficients of `lumped.dynamics.tableau`. Every stage is one equation for uᵢ with the same factors,
as aᵢᵢ = γ; the first is the last one's of the step before. The error of a step, h Σ (bᵢ − b̂ᵢ) vᵢ, is held
relative to the largest displacement so far. Energies taken by dampers and put in by loads and supports are
h Σ bᵢ Pᵢ. Between the ends of a step the motion is the polynomial of fifth degree with their displacements,
velocities and accelerations, and the energies that of the stages' powers (`tableau.CUMULATIVE`): steps may be
longer than the distance of samples; reactions, which stiff springs magnify, are then good to some percent.
They end where something changes its course: a load's history, a
support's motion. No chains: their constraints would lower the order.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from lumped.dynamics.integrator import Advance, DenseIntegrator, Passed, StepFailed
from lumped.dynamics.newton import Motion, Newton
from lumped.dynamics.system import State, System
from lumped.dynamics.tableau import ABSCISSAE, CUMULATIVE, ERRORS, GAMMA, GUESSES, STAGES
from lumped.linear.solver import SingularMatrixError
from sheetbench.scenes.errors import BadInput

ERROR = 3e-5  # of a step, relative to the largest displacement so far
CLOSE = 1e-11  # last correction of a fixed step relative to the sheet's side
SHARE = 0.3  # last correction of an adaptive step relative to the error it may have
STALE = (
    1.5  # ratio of successive corrections above which a step, which begins with its own, makes factors anew
)


class Esdirk(DenseIntegrator):
    """ESDIRK5(4)7L[2]SA2; adaptive unless the step is `fixed`."""

    name, order, adaptive = "esdirk", 5, True

    def __init__(self, system: System, step: float, fixed: bool = True):
        if system.coupling is not None:
            raise BadInput("integrator = 'esdirk': does not take chains; choose another integrator")
        super().__init__(system, step)
        self._fixed, self._first = fixed, step
        self._newton = Newton(system, CLOSE, STALE)
        self._largest = 0.0
        self._powers: tuple[State | None, np.ndarray] = None, np.zeros(2)  # at the last state
        self._curve: np.ndarray | None = None  # of the last step, once it is asked for

    @classmethod
    def default_step(cls, period: float, limit: object) -> float:
        """An adaptive run's first step [s]."""
        return 1e-3 * period

    def forget(self) -> None:
        """Drop the factors."""
        self._newton.forget()

    def memory(self) -> dict[str, Any]:
        """The step's control."""
        return {"step": self.step, "largest": self._largest}

    def recall(self, memory: dict[str, Any]) -> None:
        """Take up what `memory` gave."""
        self.step, self._largest = float(memory["step"]), float(memory["largest"])

    def advance(self, state: State, at_most: float) -> Advance:
        """One step; an adaptive one divides `at_most` evenly and is repeated until its error is small."""
        if not self._fixed:
            state, at_most = self._from_kink(state, at_most)
        shortest = 1e-6 * min(self.step, at_most)
        size = self.system.problem.size
        while True:
            h = at_most if self._fixed else at_most / np.ceil(at_most / self.step - 1e-9)
            allowed = ERROR * max(self._largest, 1e-6 * size)
            try:
                stages = self._stages(state, h, None if self._fixed else SHARE * allowed)
            except (StepFailed, SingularMatrixError) as failure:
                if self._fixed or h < shortest:
                    raise StepFailed(str(failure)) from None
                self.step = 0.25 * h
                continue
            if self._fixed:
                break
            error = h * float(np.abs(np.tensordot(ERRORS, [s.v for s in stages], 1)).max())
            largest = max(self._largest, float(np.abs(stages[-1].u).max()))
            ratio = 0.9 * (ERROR * max(largest, 1e-6 * size) / max(error, 1e-30)) ** (1.0 / 5.0)
            if ratio < 0.9 and h > shortest:
                self.step = h * max(ratio, 0.2)
                continue
            if ratio > 1.2 or ratio < 1.0:
                self.step = h * min(max(ratio, 0.5), 4.0)
            self._largest = largest
            break
        return self._advance(stages, h)

    def _from_kink(self, state: State, at_most: float) -> tuple[State, float]:
        """The state with its acceleration from now on, and how long nothing changes its course at most."""
        system, now = self.system, state.time
        near = 1e-9 * at_most
        if np.any(np.abs(system.kinks - now) < near) and now > near:
            if system.moving:  # a velocity jumps, and dampers with it: the steps begin as at the start
                self.step = min(self.step, self._first)
            force = system.unbalanced(state.u, state.v, now)
            state = State(now, state.u, state.v, system.accelerate(force))
        ahead = system.kinks[system.kinks > now + near]
        return state, min([at_most, *(ahead[:1] - now)])

    def _stages(self, state: State, h: float, tolerance: float | None) -> list[State]:
        """The states of all stages of a step, the first included."""
        system, found, by = self.system, [state], 1.0 / (GAMMA * h)
        middle = state.u + 0.5 * h * state.v
        self._newton.renew(Motion(state.time + 0.5 * h, middle, state.v, by * by, by), middle)
        for i in range(1, len(ABSCISSAE)):
            time = state.time + ABSCISSAE[i] * h
            u, v = state.u.copy(), state.v.copy()
            for weight, stage in zip(STAGES[i], found, strict=False):
                if weight:
                    u += (weight * h) * stage.v
                    v += (weight * h) * stage.a
            if system.moving:  # off their straight course where a step goes past a kink
                held = system.place(time) - system.place(state.time)
                u += held - (time - state.time) * system.place_rate(state.time)
            motion = Motion(time, u + v / by, v, by * by, by)
            a = sum(weight * stage.a for weight, stage in zip(GUESSES[i], found, strict=False) if weight)
            u = self._newton.solve_motion(motion, motion.base_u + a / by**2, tolerance)
            found.append(State(time, u, *self._newton.state(motion, u)))
        return found

    def at(self, time: float) -> Passed:
        """The state at a time within the last step, and what was taken and put in since its start."""
        first, last, h, powers = self._step
        if self._curve is None:
            self._curve = _curve(first, last, h)
        theta = (time - first.time) / h
        taken, put_in = h * (theta ** np.arange(len(CUMULATIVE)) @ CUMULATIVE @ powers)
        order = np.arange(6)
        rates = np.array(
            [
                theta**order,
                order * theta ** np.maximum(order - 1, 0) / h,
                order * (order - 1) * theta ** np.maximum(order - 2, 0) / h**2,
            ]
        )
        u, v, a = (rates @ self._curve).reshape(3, *first.u.shape)
        return Passed(State(time, u, v, a), float(taken), float(put_in))

    def _advance(self, stages: list[State], h: float) -> Advance:
        system, first, last = self.system, stages[0], stages[-1]
        known = self._powers[1] if self._powers[0] is first else self._power(first, first.time)
        powers = np.array([known, *(self._power(stage, first.time) for stage in stages[1:])])
        self._step, self._curve = (first, last, h, powers), None
        taken, put_in = h * (CUMULATIVE.sum(axis=0) @ powers)
        end = last
        if system.moving:
            turn = system.place_rate(last.time) - system.place_rate(first.time)
            end = State(last.time, last.u, last.v + turn, last.a)
            put_in += system.kinetic_of_placed(end) - system.kinetic_of_placed(last)
        self._powers = end, powers[-1]
        return Advance(end, float(taken), float(put_in))

    def _power(self, stage: State, began: float) -> np.ndarray:
        """Power [W] that dampers take, and that moving supports and loads without a potential put in, (2,),
        in a step that began then."""
        system, put_in = self.system, 0.0
        taken, _ = system.damping_force(stage.u, stage.v)
        if system.moving:
            put_in += float(np.sum(system.exerted(stage) * system.place_rate(began)))
        if system.working:
            force = system.external(stage.u, stage.time) - system.problem.loads.dead
            put_in += float(np.sum(force * stage.v))
        return np.array([taken, put_in])


def _curve(first: State, last: State, h: float) -> np.ndarray:
    """Coefficients (6, 3 n) of θ⁰ to θ⁵: the polynomial with the displacements, velocities and accelerations
    of both ends of a step."""
    change = last.u - first.u - h * first.v - 0.5 * h * h * first.a
    speed = h * (last.v - first.v - h * first.a)
    bend = h * h * (last.a - first.a)
    return np.array(
        [
            first.u,
            h * first.v,
            0.5 * h * h * first.a,
            10.0 * change - 4.0 * speed + 0.5 * bend,
            -15.0 * change + 7.0 * speed - bend,
            6.0 * change - 3.0 * speed + 0.5 * bend,
        ]
    ).reshape(6, -1)
