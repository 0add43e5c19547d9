"""A run from its start, or from its last checkpoint, to its end: steps to the next sample, over and over.

Samples, frames and checkpoints go to a store as they come. What a checkpoint holds takes the run up again as
if it had never stopped; hence integrators forget there what they keep only for speed.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from lumped.dynamics.integrator import DenseIntegrator, Integrator, StepFailed
from lumped.dynamics.runs import watchdog
from lumped.dynamics.runs.plan import Plan
from lumped.dynamics.runs.sampling import Sampling
from lumped.dynamics.system import State, System
from lumped.statics.faults import Fault
from sheetbench.numerics.reduced import SingularMatrixError
from sheetbench.runs.schedule import SAMPLES_PER_CHECKPOINT
from sheetbench.runs.store import FolderStore, MemoryStore
from sheetbench.scenes import Status


@dataclass
class Reached:
    """How far a run has come: samples after the start, steps, energies [J] dissipated and put in since, the
    largest of any kind at a sample, and the total at the start."""

    state: State
    samples: int = 0
    steps: int = 0
    dissipated: float = 0.0
    work: float = 0.0
    largest: float = 0.0
    origin: float = 0.0


class Run:
    """A run under way. shown: samples at which to keep a frame; drawn: the rows of the displacement that make
    one; progress: called with the time reached [s]."""

    def __init__(
        self,
        system: System,
        method: Integrator,
        plan: Plan,
        sampling: Sampling,
        kept: FolderStore | MemoryStore,
        shown: set[int],
        drawn: np.ndarray,
        progress: Callable[[float], None] | None,
    ):
        self._system, self._method, self._plan, self._sampling = system, method, plan, sampling
        self._kept, self._shown, self._drawn = kept, shown, drawn
        self._last = 0.0, 0.0  # energies dissipated and put in when the last step began
        self._progress = progress if progress is not None else lambda time: None

    def begin(self, start: State) -> None:
        """Take up the last checkpoint, or sample the start."""
        self._method.forget()
        checkpoint = self._kept.resume()
        if checkpoint is None:
            self.reached = Reached(start)
            row = self._sampling.row(start, 0.0, 0.0)
            self.reached.origin = float(row[1:4].sum())
            self._kept.sample(row)
            self._keep_frame(start)
            return
        u, v, a = (checkpoint[name] for name in ("u", "v", "a"))
        state = State(float(checkpoint["time"]), u, v, a, checkpoint.get("memory"))
        energies = (float(energy) for energy in checkpoint["energies"])
        self.reached = Reached(state, int(checkpoint["done"]), int(checkpoint["steps"]), *energies)
        own = {k.removeprefix("method_"): v for k, v in checkpoint.items() if k.startswith("method_")}
        self._method.recall(own)
        self._progress(state.time)

    def finish(self) -> tuple[Status, str]:
        """Go on to the end, or to a fault: how it ended."""
        while self.reached.samples < self._plan.samples:
            fault = self._step_to_sample() or self._sample()
            if fault is not None:
                return fault.status, fault.message
            self._progress(self.reached.state.time)
        return Status.CONVERGED, ""

    def _step_to_sample(self) -> Fault | None:
        plan, reached, taken = self._plan, self.reached, 0
        goal = (reached.samples + 1) * plan.every
        while (goal - reached.state.time > 1e-9 * plan.every) if plan.adapts else (taken < plan.steps):
            try:
                if plan.adapts:
                    advance, steps = self._method.advance(reached.state, self._at_most(goal)), 1
                else:
                    step, left = plan.every / plan.steps, plan.steps - taken
                    advance, steps = self._method.march(reached.state, step, left)
            except (StepFailed, SingularMatrixError) as failure:
                return Fault(Status.DIVERGED, f"at {reached.state.time:.6g} s: {failure}")
            reached.state, taken = advance.state, taken + steps
            reached.steps += steps
            self._last = reached.dissipated, reached.work
            reached.dissipated += advance.dissipated
            reached.work += advance.work
            stuck = watchdog.stagnates(reached.state, taken) if plan.adapts else None
            if stuck is not None:
                return stuck
        if reached.state.time - goal < 1e-9 * plan.every:
            reached.state = replace(reached.state, time=goal)
        return None

    def _at_most(self, goal: float) -> float:
        """How long the next adaptive step may be [s]: to the next sample, or the next checkpoint or the end
        where states within steps are known."""
        plan, reached = self._plan, self.reached
        if isinstance(self._method, DenseIntegrator):
            whole = reached.samples // SAMPLES_PER_CHECKPOINT + 1
            goal = min(whole * SAMPLES_PER_CHECKPOINT, plan.samples) * plan.every
        return goal - reached.state.time

    def _now(self) -> tuple[State, float, float]:
        """The state at the sample reached, and the energies dissipated and put in until then."""
        plan, reached = self._plan, self.reached
        time = (reached.samples + 1) * plan.every
        if reached.state.time == time or not isinstance(self._method, DenseIntegrator):
            return reached.state, reached.dissipated, reached.work
        passed = self._method.at(time)
        return passed.state, self._last[0] + passed.dissipated, self._last[1] + passed.work

    def _sample(self) -> Fault | None:
        reached = self.reached
        state, dissipated, work = self._now()
        row = self._sampling.row(state, dissipated, work)
        reached.largest = max(reached.largest, float(np.abs(row[1:6]).max()))
        fault = watchdog.check_sample(self._system, state, row, reached.origin, reached.largest)
        if fault is None or fault.status is not Status.NON_FINITE:
            self._kept.sample(row)
        if fault is None:
            reached.samples += 1
            self._keep_frame(state)
            if reached.samples % SAMPLES_PER_CHECKPOINT == 0:
                self._checkpoint()
        return fault

    def _keep_frame(self, state: State) -> None:
        if self.reached.samples in self._shown:
            self._kept.frame(state.u[self._drawn])

    def _checkpoint(self) -> None:
        reached, state = self.reached, self.reached.state
        self._method.forget()
        content: dict[str, Any] = {"time": state.time, "u": state.u, "v": state.v, "a": state.a}
        content |= {"memory": state.memory} if state.memory is not None else {}
        content |= {"done": reached.samples, "steps": reached.steps}
        content |= {f"method_{k}": v for k, v in self._method.memory().items() if v is not None}
        energies = [reached.dissipated, reached.work, reached.largest, reached.origin]
        self._kept.checkpoint({**content, "energies": energies})
