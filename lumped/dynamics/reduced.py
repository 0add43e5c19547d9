"""A reduced model as an integrator: the sheet in its lowest modes, all else following statically.

The model (`lumped.reduction.condensed`) is made once, of the flat lattice under its own loads; then a step
takes microseconds (`lumped.reduction.motion`). At least every LOOK steps the full equations are asked what
they leave,

    Δu = Kₜ⁻¹ (f_ext − f(u, v) − M v̇),

what a correction with the tangent there would be; where that is more than ADRIFT of the largest
displacement so far, the motion has left what the model knows, and the run stops. For flat sheets under dead
loads on supports at rest.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from lumped.dynamics.integrator import Advance, Integrator, StepFailed
from lumped.dynamics.system import State, System
from lumped.linear.solver import SingularMatrixError
from lumped.reduction.condensed import condense
from lumped.reduction.monomials import gradients, values
from lumped.reduction.motion import Coefficients, Coordinates, march
from sheetbench.scenes.errors import BadInput

MODES = 4
LOOK = 20  # steps
ADRIFT = 0.25
METHOD = Coefficients(0.8 / 1.9, 0.9 / 1.9, 0.25 * (1.0 + 0.1 / 1.9) ** 2, 0.5 + 0.1 / 1.9)  # ρ∞ = 0.9


class Reduced(Integrator):
    """The condensed model in `modes` modes, with steps by generalised-α."""

    name, order, options = "reduced", 2, ("modes",)

    def __init__(self, system: System, step: float, modes: float = MODES):
        super().__init__(system, step)
        if system.coupling is not None or system.moving or not system.problem.conservative:
            raise BadInput(
                "integrator = 'reduced': takes neither chains nor moving supports nor loads that follow the "
                "sheet; choose another integrator"
            )
        if system.place(0.0).any() or not system.external(system.place(0.0), 0.0).any():
            raise BadInput("integrator = 'reduced': begins with a flat sheet and its loads; choose another")
        if not 1 <= round(modes) <= system.reduced_mass.shape[0] // 3:
            raise BadInput(f"modes = {modes:g}: at least 1, and at most a third of the unknowns")
        self._model = condense(system, round(modes))
        self._dual = self._model.modes.T @ system.reduced_mass
        self._algorithm: np.ndarray | None = None
        self._largest, self._unseen, self.adrift = 0.0, 0, 0.0

    def memory(self) -> dict[str, Any]:
        """The algorithm's acceleration, the largest displacement, and the steps since it was looked at."""
        return {"algorithm": self._algorithm, "largest": self._largest, "unseen": self._unseen}

    def recall(self, memory: dict[str, Any]) -> None:
        """Take up what `memory` gave."""
        self._algorithm, self._largest = memory["algorithm"], float(memory["largest"])
        self._unseen = int(memory["unseen"])

    def advance(self, state: State, at_most: float) -> Advance:
        """One step. Raises StepFailed."""
        return self.march(state, at_most, 1)[0]

    def march(self, state: State, step: float, most: int) -> tuple[Advance, int]:
        """Steps of the same length in one compiled call, up to the next look at the full equations. Raises
        StepFailed, also where the motion has left what the model knows."""
        system, most = self.system, min(most, LOOK - self._unseen)
        q, v, a = (self._dual @ system.contract(x) for x in (state.u, state.v, state.a))
        at = Coordinates(q, v, a, a.copy() if self._algorithm is None else self._algorithm.copy())
        times = state.time + step * np.arange(1, most + 1)
        moments = times if system.working else times[:1]
        pull = np.array([self._model.modes.T @ system.reduce(system.external(state.u, t)) for t in moments])
        forces = np.ascontiguousarray(np.broadcast_to(pull, (most, len(q))))
        done, taken = march(at, forces, step, self._model, METHOD)
        if done < most:
            raise StepFailed("the reduced model's equations did not converge: use smaller steps")
        self._algorithm = at.algorithm
        after = self._expanded(float(times[-1]), at)
        self._unseen += most
        if self._unseen >= LOOK:
            self._look(after)
        return Advance(after, taken, system.work(state, after)), most

    def _expanded(self, time: float, at: Coordinates) -> State:
        """The whole sheet's state: u = Φ q + Ψ(q), and its derivatives but for the small q̇ ∂²Ψ/∂q² q̇."""
        model, system = self._model, self.system
        u = model.modes @ at.q + values(model.expansion, at.q) @ model.shapes
        slopes = gradients(model.expansion, at.q).T @ model.shapes
        v, a = (model.modes @ rate + rate @ slopes for rate in (at.v, at.a))
        return State(time, *(system.expand(x) for x in (u, v, a)))

    def _look(self, state: State) -> None:
        """Raise StepFailed where the full equations are far from met."""
        system = self.system
        self._unseen, self._largest = 0, max(self._largest, float(np.abs(state.u).max()))
        left = system.problem.reduce(system.exerted(state))
        try:
            factor = system.problem.factor(system.matrix(state.u, state.v, state.time, 0.0, 0.0, 1.0))
            self.adrift = float(np.abs(system.expand(factor.solve(left))).max()) / self._largest
        except SingularMatrixError:
            self.adrift = np.inf
        if not self.adrift < ADRIFT:
            raise StepFailed(
                f"the motion has left what the reduced model knows, by {100.0 * self.adrift:.2g} % of the "
                "largest displacement: use more modes, or another integrator"
            )
