"""A run from its start, or from its last checkpoint, to its end: steps to the next samples, over and over.

Samples, frames and checkpoints go to a store as they come. What a checkpoint holds takes the run up again as
if it had never stopped; hence integrators forget there what they keep only for speed.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from lumped.dynamics.integrator import DenseIntegrator, Integrator, Samples, StepFailed
from lumped.dynamics.runs import watchdog
from lumped.dynamics.runs.plan import Plan
from lumped.dynamics.runs.sampling import Sampling
from lumped.dynamics.system import State, System
from lumped.statics.faults import Fault
from sheetbench.numerics.reduced import SingularMatrixError
from sheetbench.runs.schedule import SAMPLES_PER_CHECKPOINT
from sheetbench.runs.store import FolderStore, MemoryStore
from sheetbench.runs.watch import Watch
from sheetbench.scenes import Status


@dataclass
class Reached:
    """How far a run has come: samples after the start, steps, energies [J] dissipated and put in since."""

    state: State
    samples: int = 0
    steps: int = 0
    dissipated: float = 0.0
    work: float = 0.0
    watch: Watch = field(default_factory=Watch)


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
        self._kinks = system.kinks if plan.adapts else _apart(system.kinks, plan.every / plan.steps)
        self._dense = method if plan.adapts and isinstance(method, DenseIntegrator) else None
        self._progress = progress if progress is not None else lambda time: None

    def begin(self, start: State) -> None:
        """Take up the last checkpoint, or sample the start."""
        self._method.forget()
        checkpoint = self._kept.resume()
        if checkpoint is None:
            self.reached = Reached(start, watch=Watch(largest=self._system.least_energy))
            samples = Samples.of(start)
            rows = self._sampling.rows(samples)
            watchdog.check_samples(self._system, samples, rows, self.reached.watch)
            self._keep(rows, samples.u, 0)
            return
        u, v, a = (checkpoint[name] for name in ("u", "v", "a"))
        state = State(float(checkpoint["time"]), u, v, a, checkpoint.get("memory"))
        dissipated, work = checkpoint["energies"].tolist()
        watch = Watch.recall(checkpoint["watch"])
        self.reached = Reached(
            state, int(checkpoint["done"]), int(checkpoint["steps"]), dissipated, work, watch
        )
        own = {k.removeprefix("method_"): v for k, v in checkpoint.items() if k.startswith("method_")}
        self._method.recall(own)
        self._progress(state.time)

    def finish(self) -> tuple[Status, str]:
        """Go on to the end, or to a fault: how it ended."""
        while self.reached.samples < self._plan.samples:
            found = self._step_to_sample()
            fault = found if isinstance(found, Fault) else self._sample(found)
            if fault is not None:
                return fault.status, fault.message
            self._progress(self.reached.state.time)
        return watchdog.ending(self._system, self.reached.watch)

    def _step_to_sample(self) -> Samples | Fault:
        """Steps to the next sample; the samples that the last of them reached or passed."""
        plan, reached, taken = self._plan, self.reached, 0
        goal = (reached.samples + 1) * plan.every
        while goal - reached.state.time > 1e-9 * plan.every:
            try:
                at_most = self._at_most(goal)
                if plan.adapts:
                    advance, steps = self._method.advance(reached.state, at_most), 1
                else:
                    left = max(int(np.ceil(at_most * plan.steps / plan.every - 1e-6)), 1)
                    step = plan.every / plan.steps if self._whole(at_most, left) else at_most / left
                    advance, steps = self._method.march(reached.state, step, left)
            except (StepFailed, SingularMatrixError) as failure:
                return Fault(Status.DIVERGED, f"at {reached.state.time:.6g} s: {failure}")
            reached.state, taken = advance.state, taken + steps
            reached.steps += steps
            before = reached.dissipated, reached.work
            reached.dissipated += advance.dissipated
            reached.work += advance.work
            stuck = watchdog.stagnates(reached.state, taken) if plan.adapts else None
            if stuck is not None:
                return stuck
        last = reached.samples + 1
        if self._dense is not None:
            last = max(last, int(reached.state.time / plan.every + 1e-9))
        if reached.state.time - last * plan.every < 1e-9 * plan.every:
            reached.state = replace(reached.state, time=last * plan.every)
        end, times = reached.state, plan.every * np.arange(reached.samples + 1, last + 1)
        if self._dense is None or end.time == times[0]:
            return Samples.of(end, reached.dissipated, reached.work)
        samples = self._dense.at(times)
        if end.time == times[-1]:
            samples.u[-1], samples.v[-1], samples.a[-1] = end.u, end.v, end.a
        dissipated, work = before
        return samples._replace(dissipated=dissipated + samples.dissipated, work=work + samples.work)

    def _at_most(self, goal: float) -> float:
        """How long the next step may be [s]: to the next sample, or the next checkpoint or the end where
        states within steps are known; no farther than to where something changes its course."""
        plan, reached = self._plan, self.reached
        if self._dense is not None:
            whole = reached.samples // SAMPLES_PER_CHECKPOINT + 1
            goal = min(whole * SAMPLES_PER_CHECKPOINT, plan.samples) * plan.every
        now = reached.state.time
        ahead = self._kinks[self._kinks > now + 1e-9 * plan.every][:1]
        return float(min([goal, *ahead])) - now

    def _whole(self, at_most: float, steps: int) -> bool:
        """Whether so long a time [s] is that of so many fixed steps."""
        return abs(at_most * self._plan.steps / self._plan.every - steps) < 1e-6

    def _sample(self, samples: Samples) -> Fault | None:
        reached, rows = self.reached, self._sampling.rows(samples)
        sound, fault = watchdog.check_samples(self._system, samples, rows, reached.watch)
        kept = sound + (fault is not None and fault.status is not Status.NON_FINITE)
        self._keep(rows[:kept], samples.u[:sound], reached.samples + 1)
        reached.samples += sound
        if fault is None and reached.samples % SAMPLES_PER_CHECKPOINT == 0:
            self._checkpoint()
        return fault

    def _keep(self, rows: np.ndarray, displacements: np.ndarray, first: int) -> None:
        self._kept.sample(rows)
        for number, u in enumerate(displacements, first):
            if number in self._shown:
                self._kept.frame(u[self._drawn])

    def _checkpoint(self) -> None:
        reached, state = self.reached, self.reached.state
        self._method.forget()
        content: dict[str, Any] = {"time": state.time, "u": state.u, "v": state.v, "a": state.a}
        content |= {"memory": state.memory} if state.memory is not None else {}
        content |= {"done": reached.samples, "steps": reached.steps}
        content |= {f"method_{k}": v for k, v in self._method.memory().items() if v is not None}
        content |= {"energies": [reached.dissipated, reached.work], "watch": reached.watch.memory()}
        self._kept.checkpoint(content)


def _apart(kinks: np.ndarray, step: float) -> np.ndarray:
    """The kinks farther from each other than a fixed step [s]: a table with more samples than there are steps
    has no corner to step onto."""
    gaps = np.diff(kinks, prepend=-np.inf, append=np.inf)
    return kinks[np.minimum(gaps[:-1], gaps[1:])[: len(kinks)] > step]
