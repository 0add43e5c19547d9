"""Derivatives of a motion by numbers of its scene, stage by stage along a run of `esdirk`.

The equations of motion R(u, v, a, t, θ) = 0 give for the derivative s = du/dθ in every stage

    R_u s + R_v s′ + R_a s″ + R_θ = 0,   s′ = ŝ′ + c₁ (s − ŝ),   s″ = c₂ (s − ŝ),

linear, with the matrix of the stage's own equation, whose factors stand. They may be of a state near by, so
that each solution is corrected until it no longer changes. The left side is half the difference of R at
θ ± δ and u ± δ s, of two systems a parameter, over δ; so the memory of branches is followed too, on either
side. s is the derivative of the run's own answer, at frozen steps.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from lumped.calibration import Calibration
from lumped.dynamics.implicit.compiled_stages import polynomials
from lumped.dynamics.implicit.esdirk import Esdirk
from lumped.dynamics.implicit.esdirk_step import EsdirkStep
from lumped.dynamics.implicit.newton import CORRECTIONS, StepEquation
from lumped.dynamics.implicit.tableau import GAMMA, GUESSES, STAGES
from lumped.dynamics.integrator import LatticeSamples
from lumped.dynamics.runs.initial import in_motion
from lumped.dynamics.system import State, System
from lumped.lattice import Weights
from lumped.parameter_sides import both_sides
from sheetbench.errors import BadInput
from sheetbench.numerics.time.method import Advance, StepFailed
from sheetbench.scenes import Scene

MOST, SIGNS = 20, (1.0, -1.0)  # parameters; of the sides above and below one
STEP = 2e-5  # of a parameter: rounded forces of stiff springs ask for more, their turning for less
SMALL = 1e-10  # last correction, of the largest change so far
ROUNDED = 1e-8  # and below which what no longer shrinks is rounding
SLOW = 0.3  # ratio of corrections from which on factors are made anew
Change = np.ndarray  # δ s, δ s′ and δ s″, (3, n, 3)


def require_differentiable(names: Sequence[str], integrator: str, keeping: Mapping[str, Any]) -> None:
    """Raise BadInput for derivatives that a run cannot have."""
    if names and integrator != Esdirk.name:
        raise BadInput(f"sensitivities: need integrator = 'esdirk', not '{integrator}'")
    if len(names) > MOST:
        raise BadInput(f"sensitivities: {len(names)} parameters; {MOST} at most")
    if names and keeping.get("store"):
        raise BadInput("sensitivities: not for a stored run; leave the store out")


class ParameterSystems:
    """Systems at both sides of a parameter's step, half the difference of their states, and the memories of
    their branches."""

    def __init__(self, scene: Scene, calibration: Calibration, weights: Weights, name: str):
        ((ends, over),) = both_sides(scene, calibration, [name], share=STEP)
        made = [in_motion(*end, weights) for end in reversed(ends)]
        self.systems, states = zip(*made, strict=True)
        places = [system.problem.prescribed(1.0) for system in self.systems]
        if self.systems[0].contacts or not np.array_equal(*places):
            raise BadInput(f"sensitivities: {name}: not by positions of supports, nor with obstacles")
        self.half, self.largest, self.memories = 0.5 * over, 0.0, [state.memory for state in states]
        high_state, low_state = (np.array([state.u, state.v, state.a]) for state in states)
        self.change: Change = 0.5 * (high_state - low_state)


class SensitiveEsdirk(Esdirk):
    """`esdirk` with the derivatives by up to MOST parameters; found: times (k,) and derivatives (parameters,
    k, n, 3) of the samples so far."""

    def __init__(self, sides: Sequence[ParameterSystems], *given: Any, **options: Any):
        super().__init__(*given, **options)
        self._sides = sides
        self._acceleration: np.ndarray | None = None
        self.found: list[tuple[np.ndarray, np.ndarray]] = []

    def advance(self, state: State, at_most: float) -> Advance[State]:
        """Return one step, as `Esdirk` does, of the derivatives too."""
        taken, step = super().advance(state, at_most), self._step
        bent = self._acceleration is None or not np.array_equal(step.stages.a[0], self._acceleration)
        self._tables = [self._advance_derivatives(one, step, bent) for one in self._sides]
        self._acceleration = step.stages.a[-1].copy()
        return taken

    def at(self, times: np.ndarray, last: Advance[State]) -> LatticeSamples:
        """Return the states, as `Esdirk` does, and keep their derivatives."""
        changes = np.array([one.change[:1] for one in self._sides])
        if self._acceleration is not None:
            stages, h = self._step.stages, self._step.h
            theta = (times - stages.time[0]) / h
            changes = np.array([polynomials(u, v, a, h, theta)[0] for u, v, a in self._tables])
        half = np.reshape([one.half for one in self._sides], (-1, 1, 1, 1))
        self.found.append((times, changes / half))
        return super().at(times, last)

    def _advance_derivatives(self, one: ParameterSystems, step: EsdirkStep, bent: bool) -> np.ndarray:
        """Advance the derivatives by one parameter over a step; return their stages, (3, 7, n, 3)."""
        own, h = np.array(step.stages[1:4]), step.h
        tables, c1, start = np.zeros_like(own), 1.0 / (GAMMA * h), float(step.stages.time[0])
        ends = zip(one.systems, (own[:, 0] + one.change, own[:, 0] - one.change), one.memories, strict=True)
        sides = [EsdirkStep(of, State(start, u, v, a, memory), h) for of, (u, v, a), memory in ends]
        if bent:  # what begins here accelerates either side
            begun = ((side.system, side.state(0)) for side in sides)
            forces = ((of, of.for_step(at).unbalanced(at.u, at.v, start)) for of, at in begun)
            high, low = (of.accelerate(force) for of, force in forces)
            one.change[2] = 0.5 * (high - low)
        tables[:, 0] = one.change
        for i in range(1, len(STAGES)):
            u, v = (tables[k, 0] + h * np.tensordot(STAGES[i, :i], tables[k + 1, :i], 1) for k in (0, 1))
            inside, base = [side.in_stage(i) for side in sides], np.array([u + v / c1, v])
            tables[0, i] = base[0] + np.tensordot(GUESSES[i, :i], tables[2, :i], 1) / c1**2
            tables[:, i] = self._stage_derivatives(one, step, i, inside, base, tables[0, i])
            for side, system, sign in zip(sides, inside, SIGNS, strict=True):
                if system.maxwell is not None:
                    side.memories[i] = system.maxwell.after(own[0, i] + sign * tables[0, i])
        one.change, one.memories = tables[:, -1].copy(), [side.memories[-1] for side in sides]
        return tables

    def _stage_derivatives(
        self,
        one: ParameterSystems,
        step: EsdirkStep,
        i: int,
        inside: Sequence[System],
        base: Change,
        change: Change,
    ) -> Change:
        """Return a stage's derivatives of displacement, velocity and acceleration from a guess of the first;
        base: û and v̂ of its equation. Raises StepFailed."""
        time, c1 = float(step.stages.time[i]), 1.0 / (GAMMA * step.h)
        at, last, fresh = np.array([part[i] for part in step.stages[1:4]]), np.inf, False
        for _ in range(CORRECTIONS):
            moved = change - base[0]
            whole = np.array([change, base[1] + c1 * moved, c1**2 * moved])
            sides = zip(inside, (at + whole, at - whole), strict=True)
            high, low = (of.momentum(a) - of.unbalanced(u, v, time) for of, (u, v, a) in sides)
            residual = self.system.problem.reduce(0.5 * (high - low))
            if (correction := self._newton.correction(residual)) is None:
                equation = StepEquation(step.in_stage(i), time, at[0], at[1], (c1**2, c1))
                self._newton.renew(equation, at[0])
                continue
            change, size = change - correction, float(np.abs(correction).max())
            one.largest = max(one.largest, float(np.abs(change).max()))
            if size <= SMALL * one.largest or (fresh and 0.5 * last < size <= ROUNDED * one.largest):
                return whole
            if size > SLOW * last and not fresh:
                self._newton.forget()
                fresh = True
            last = size
        raise StepFailed("the equations of the derivatives did not converge: use smaller steps")
