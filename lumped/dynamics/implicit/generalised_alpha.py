"""Generalised-α: implicit, second order, with the spectral radius ρ∞ at high frequencies as a parameter.

    M u̇̇₁ + f(u₁, v₁, t₁) = 0                              equilibrium at the step's end, constraints included
    (1 − αm) a₁ + αm a₀ = (1 − αf) u̇̇₁ + αf u̇̇₀             a: the algorithm's acceleration
    u₁ = u₀ + h v₀ + h² ((½ − β) a₀ + β a₁),   v₁ = v₀ + h ((1 − γ) a₀ + γ a₁)

    αm = (2ρ∞ − 1)/(ρ∞ + 1),  αf = ρ∞/(ρ∞ + 1),  γ = ½ + αf − αm,  β = ¼ (γ + ½)²

Source: Chung and Hulbert (1993) in the form of Arnold and Brüls (2007), which keeps its order with
constraints. The step adapts to an estimate of the local error, h² |β − 1/6| |a₁ − a₀| (Zienkiewicz and Xie
1991), relative to the largest displacement so far.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from lumped.dynamics.implicit.newton import Newton, StepEquation
from lumped.dynamics.integrator import Advance, Integrator, StepFailed
from lumped.dynamics.system import State, System
from sheetbench.errors import BadInput
from sheetbench.numerics.reduced import SingularMatrixError

ERROR = 1e-6  # of a step, relative to the largest displacement so far
STEP_TOLERANCE = 1e-11  # last correction relative to the sheet's side


class GeneralisedAlpha(Integrator):
    """Generalised-α with radius ρ∞; adaptive unless the step is `fixed`."""

    name, order, adaptive, options = "generalised-alpha", 2, True, ("radius",)

    def __init__(self, system: System, step: float, radius: float = 0.9, fixed: bool = True):
        super().__init__(system, step)
        if not 0.0 <= radius <= 1.0:
            raise BadInput(f"radius = {radius:g}: the spectral radius at high frequencies lies in [0, 1]")
        self._am, self._af = (2.0 * radius - 1.0) / (radius + 1.0), radius / (radius + 1.0)
        self._gamma = 0.5 + self._af - self._am
        self._beta = 0.25 * (self._gamma + 0.5) ** 2
        self._fixed = fixed
        self._newton = Newton(system, STEP_TOLERANCE)
        self._algorithm: np.ndarray | None = None
        self._largest = 0.0
        self._taken: tuple[State | None, float] = None, 0.0  # the power of the dampers at the last state

    def forget(self) -> None:
        """Drop the factors."""
        self._newton.forget()

    def memory(self) -> dict[str, Any]:
        """The algorithm's acceleration and the step's control."""
        return {"a": self._algorithm, "step": self.step, "largest": self._largest}

    def recall(self, memory: dict[str, Any]) -> None:
        """Take up what `memory` gave."""
        self._algorithm, self.step = memory["a"], float(memory["step"])
        self._largest = float(memory["largest"])

    def advance(self, state: State, at_most: float) -> Advance:
        """One step; an adaptive one divides `at_most` evenly and is repeated until its error is small."""
        shortest = 1e-6 * self.step
        while True:
            h = at_most if self._fixed else at_most / np.ceil(at_most / self.step - 1e-9)
            try:
                after, algorithm = self._step(state, h)
            except (StepFailed, SingularMatrixError) as failure:
                if self._fixed or h < shortest:
                    raise StepFailed(str(failure)) from None
                self.step = 0.25 * h
                continue
            if self._fixed:
                break
            start = self._algorithm if self._algorithm is not None else state.a
            error = (
                h
                * h
                * (abs(self._beta - 1.0 / 6.0))
                * float(np.abs((algorithm - start)[: self._masses]).max())
            )
            largest = max(self._largest, float(np.abs(after.u[: self._masses]).max()))
            allowed = ERROR * max(largest, 1e-6 * self.system.problem.size)
            ratio = 0.9 * (allowed / max(error, 1e-30)) ** (1.0 / 3.0)
            if error > allowed and h > shortest:
                self.step = h * max(ratio, 0.2)
                continue
            if ratio > 1.3 or ratio < 1.0:
                self.step = h * min(max(ratio, 0.5), 2.0)
            self._largest = largest
            break
        self._algorithm = algorithm
        after, relaxed = self.system.relaxed(state, after)
        if self._taken[0] is not state:
            self._taken = state, self.system.damping_force(state.u, state.v, state.time)[0]
        before, power = self._taken[1], self.system.damping_force(after.u, after.v, after.time)[0]
        self._taken = after, power
        return Advance(after, 0.5 * h * (before + power) + relaxed, self.system.work(state, after))

    @property
    def _masses(self) -> int:
        return len(self.system.lattice_mass)

    def _step(self, state: State, h: float) -> tuple[State, np.ndarray]:
        system, time = self.system, state.time + h
        am, af, beta, gamma = self._am, self._af, self._beta, self._gamma
        old = self._algorithm if self._algorithm is not None else state.a
        held = system.place(time) - system.place(state.time) - h * system.place_rate(state.time)
        turn = system.place_rate(time) - system.place_rate(state.time)
        share = (1.0 - af) / (1.0 - am)
        start = (af * state.a - am * old) / (1.0 - am)  # a₁ with no acceleration at the end
        base_u = state.u + h * state.v + h * h * ((0.5 - beta) * old + beta * start) + held
        base_v = state.v + h * ((1.0 - gamma) * old + gamma * start) + turn
        mass_coefficient, damping_coefficient = 1.0 / (h * h * beta * share), gamma / (h * beta)

        system.since(state, h)
        equation = StepEquation(time, base_u, base_v, mass_coefficient, damping_coefficient)
        try:
            u = self._newton.solve_equation(equation, base_u + state.a / mass_coefficient)
        except StepFailed:  # after a jump the old acceleration leads nowhere
            u = self._newton.solve_equation(equation, state.u + held + h * state.v)
        v, a = self._newton.state(equation, u)
        return State(time, u, v, a), start + share * a
