"""A run of a motion from its start, or from its last checkpoint, to its end, of any method and model.

Samples, frames and checkpoints are stored as they come. A checkpoint is the end of a step; methods drop data
that they keep only for speed there, so that a resumed run equals an uninterrupted one to the last bit. Every
sample is checked: numbers that overflow, elements that turn inside out and a growing total energy end the run
with the time, the place and a remedy.
"""

from __future__ import annotations

from bisect import bisect
from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace
from math import isfinite, isnan, nan
from typing import Any, Generic, Protocol, Self

import numpy as np

from sheetbench.answers.solution import Status
from sheetbench.answers.table import number
from sheetbench.numerics.continuation.path import Fault
from sheetbench.numerics.options import njit
from sheetbench.numerics.reduced_system import SingularMatrixError
from sheetbench.numerics.time.method import Advance, AnyState, MotionMethod, StepFailed
from sheetbench.runs.schedule import SAMPLES_PER_CHECKPOINT, Schedule
from sheetbench.runs.store import FolderStore, MemoryStore

Part = tuple[str, str, tuple[int, ...]]  # part of a sample's numbers: kind, name, shape

GROWN, REPORTED = 0.1, 0.01  # shares of the energy, for `SampleChecks`
MOST_STEPS = 100_000  # of adaptive length between two samples


class Observer(Protocol):
    """A model's evaluation of its method's samples. columns: the parts of a row of numbers: time, kinetic,
    elastic, potential and dissipated energy, work and then the rest. least_energy: [J], below which an energy
    is rounding."""

    columns: list[Part]
    least_energy: float

    def rows(self, samples: Any) -> np.ndarray:
        """Return the numbers of samples, (k, width)."""

    def inspect(self, samples: Any, count: int) -> tuple[np.ndarray, Fault | None]:
        """Return the strains, for `beyond`, of the first `count` samples up to a fault, and the fault."""

    def beyond(self, stretch: float) -> str:
        """Return a clause if a strain is beyond the model, else ""."""

    def fastest(self, samples: Any, i: int) -> str:
        """Return the place of the largest speed of the sheet at sample i, as text."""

    def frame(self, samples: Any, i: int) -> np.ndarray:
        """Return the whole displacement (n, 3) [m] of sample i."""


@dataclass
class SampleChecks:
    """Checks of a run's samples for growth of the total energy and for strains beyond the model.

    The sum kinetic + elastic + potential − work never grows in an exact run, with any dampers. A growth from
    the lowest value so far by more than GROWN of the largest energy ends the run. The sum with the dissipated
    energy, as the integrator computes it, is constant in an exact run; a departure by more than REPORTED is
    reported. Losses are the integrator's own dissipation (`History.numerical`) and do not end a run. Nor do
    strains beyond a model's limits: the status reports them, with the time of the first.

    origin: the balance at the start [J]. lowest: the least kinetic + elastic + potential − work so far [J].
    largest: the largest energy of any kind so far [J]. off: the largest departure of the balance [J].
    stretch: the largest stretch so far, or the model's other measure of strains. since: the time of the first
    stretch beyond the model [s].
    """

    origin: float = np.nan
    lowest: float = np.inf
    largest: float = 0.0
    off: float = 0.0
    stretch: float = 0.0
    since: float = np.nan

    def strained(self, times: np.ndarray, stretches: np.ndarray, beyond: Callable[[float], str]) -> None:
        """Update the largest stretch by samples (k,); beyond: returns a clause for one beyond the model."""
        largest = max(stretches.tolist(), default=-1.0)
        if largest >= self.stretch:
            self.stretch = largest
            if isnan(self.since) and beyond(largest):
                self.since = float(times[[bool(beyond(one)) for one in stretches.tolist()].index(True)])

    def take(self, rows: np.ndarray) -> tuple[int, float]:
        """Check samples (k, 6 or more): time, kinetic, elastic, potential and dissipated energy, work. Return
        the number of sound samples before the first faulty one, and the growth of its energy over the largest
        so far: nan if a number is not finite, or if all samples are sound."""
        sound, growth, *state = take(rows, self.origin, self.lowest, self.largest, self.off)
        self.origin, self.lowest, self.largest, self.off = state
        return sound, growth

    def ending(self, outside: str, steps: str = "") -> tuple[Status, str]:
        """Return the status and the message of a run that reached its end. outside: a clause on strains
        beyond the model. steps: a clause on the steps."""
        notes = [f"from {number(self.since, '.4g')} s on {outside}"] if outside else []
        if self.largest > 0.0 and self.off > REPORTED * self.largest:
            share = number(100.0 * self.off / self.largest, ".2g")
            notes.append(
                f"the energy balance is off by {share} % of the largest energy at some sample: energies are "
                "no more accurate; smaller steps (--error, --step) keep it better"
            )
        notes += [steps] if steps else []
        return Status.STRAIN_OUTSIDE_MODEL if outside else Status.CONVERGED, "; ".join(notes)

    def memory(self) -> np.ndarray:
        """Return the numbers that a resumed run needs."""
        return np.array(list(vars(self).values()))

    @classmethod
    def restore(cls, memory: np.ndarray) -> Self:
        """Restore the checks from the numbers of `memory`."""
        return cls(*memory.tolist())


@njit
def take(
    rows: np.ndarray, origin: float, lowest: float, largest: float, off: float
) -> tuple[int, float, float, float, float, float]:
    """Return the results of `SampleChecks.take`, and the new state of the checks."""
    for k in range(len(rows)):
        row, most, finite = rows[k], largest, True
        for value in row:
            finite = finite and isfinite(value)
        for energy in row[1:6]:
            most = max(most, abs(energy))
        mechanical = row[1] + row[2] + row[3] - row[5]
        least = min(lowest, mechanical)
        grown = (mechanical - least) / most if finite and most > 0.0 else 0.0
        if not finite or grown > GROWN:
            return k, grown if finite else nan, origin, lowest, largest, off
        if isnan(origin):
            origin = mechanical + row[4]
        lowest, largest, off = least, most, max(off, abs(mechanical + row[4] - origin))
    return len(rows), nan, origin, lowest, largest, off


class Run(Generic[AnyState]):
    """A run in progress. shown: numbers of the samples with a frame. progress: called with the time reached
    [s]. samples: number of samples so far, with the start's. spent: dissipated energy and work so far [J]."""

    def __init__(
        self,
        method: MotionMethod[AnyState],
        observer: Observer,
        schedule: Schedule,
        store: FolderStore | MemoryStore,
        shown: Iterable[int],
        progress: Callable[[float], None] | None,
    ):
        self._method, self._observer, self._schedule = method, observer, schedule
        self._store, self._shown, self._progress = store, set(shown), progress or (lambda time: None)
        self.samples = self.steps = 0
        self.resumed_from, self.spent = 0.0, np.zeros(2)
        self.watch = SampleChecks(largest=observer.least_energy)

    def finish(self, start: Callable[[], Advance[AnyState]]) -> tuple[Status, str]:
        """Run from the last checkpoint or the start to the end or a fault; return status and message. start:
        makes the initial state, with the work of parts that move at once."""
        self._method.forget()
        state, since = self._resume() or self._record_step(start())[0].state, 0
        while self.samples <= self._schedule.samples:
            try:
                last = self._method.go(state, self._next_end(state.time) - state.time)
            except (StepFailed, SingularMatrixError) as failure:
                return Status.DIVERGED, f"at {state.time:.6g} s: {failure}"
            self.steps += last.steps
            since += last.steps
            if self._method.adapts and since >= MOST_STEPS:
                text = f"at {last.state.time:.6g} s: {since} steps without reaching the next sample"
                return Status.STEP_LIMIT, f"{text}: add damping or fix the step"
            before, (last, fault) = self.samples, self._record_step(last)
            if fault is not None:
                return fault.status, fault.message
            state = last.state
            if self.samples > before:
                since = 0
                if (self.samples - 1) // SAMPLES_PER_CHECKPOINT > (before - 1) // SAMPLES_PER_CHECKPOINT:
                    self._checkpoint(state)
            self._progress(state.time)
        return self.watch.ending(self._observer.beyond(self.watch.stretch), self._method.notes())

    def _next_end(self, time: float) -> float:
        """Return the latest end of the next step [s]."""
        every, goal, span = self._schedule.every, self._schedule.samples, self._method.span
        if span is not None:
            goal = min(((self.samples - 1) // span + 1) * span, goal)
        kinks = self._method.kinks
        after = bisect(kinks, time + 1e-9 * every)
        return float(min([goal * every, *kinks[after : after + 1]]))

    def _record_step(self, last: Advance[AnyState]) -> tuple[Advance[AnyState], Fault | None]:
        """Take the samples within a step; return the step, with its end rounded to a sample, and a fault."""
        every, fault = self._schedule.every, None
        number = int(last.state.time / every + 1e-9)
        if number >= self.samples:
            if self._method.span is not None and abs(last.state.time - number * every) < 1e-9 * every:
                last = replace(last, state=replace(last.state, time=number * every))  # type: ignore[type-var]
            samples = self._method.at(every * np.arange(self.samples, number + 1), last)
            fault = self._record_samples(samples)
        self.spent = self.spent + np.array([last.dissipated, last.work])
        return last, fault

    def _record_samples(self, samples: Any) -> Fault | None:
        """Store samples up to the first faulty one and return its fault; energies are the step's own."""
        observer, rows = self._observer, self._observer.rows(samples)
        rows[:, 4] += self.spent[0]
        rows[:, 5] += self.spent[1]
        count, growth = self.watch.take(rows)
        stretches, fault = observer.inspect(samples, count + isfinite(growth))
        count = count if fault is None else len(stretches)
        self.watch.strained(rows[:count, 0], stretches[:count], observer.beyond)
        if count < len(rows):
            if fault is None:
                where = f"{observer.fastest(samples, count)}: use smaller steps"
                share = f"by {100.0 * growth:.3g} % of the largest, fastest at {where}"
                grew = Fault(Status.DIVERGED, f"the energy has grown without a source, {share}")
                overflowed = Fault(Status.NON_FINITE, f"a number overflowed, first at {where}")
                fault = grew if isfinite(growth) else overflowed
            fault = Fault(fault.status, f"at {rows[count, 0]:.6g} s {fault.message}")
        shown = fault is not None and fault.status is not Status.NON_FINITE
        self._store.append("samples", rows[: count + shown])
        for due in sorted(self._shown.intersection(range(self.samples, self.samples + count))):
            self._store.append("frames", observer.frame(samples, due - self.samples)[None])
        self.samples += count
        return fault

    def _checkpoint(self, state: AnyState) -> None:
        self._method.forget()
        content = {f"state_{name}": value for name, value in vars(state).items()}
        content |= {f"method_{name}": value for name, value in self._method.memory().items()}
        content |= {"taken": self.samples, "steps": self.steps, "spent": self.spent}
        content = {name: value for name, value in content.items() if value is not None}
        self._store.checkpoint(content | {"watch": self.watch.memory()})

    def _resume(self) -> AnyState | None:
        """Return the state of the last checkpoint and restore the run's counts, or None without one."""
        checkpoint = self._store.resume()
        if checkpoint is None:
            return None

        def named(kind: str) -> dict[str, Any]:
            return {k.removeprefix(kind): v for k, v in checkpoint.items() if k.startswith(kind)}

        self.samples, self.steps = int(checkpoint["taken"]), int(checkpoint["steps"])
        self.spent, self.watch = checkpoint["spent"], SampleChecks.restore(checkpoint["watch"])
        self._method.restore(named("method_"))
        fields = named("state_")
        self.resumed_from = float(fields.pop("time"))
        self._progress(self.resumed_from)
        return self._method.state(self.resumed_from, **fields)  # type: ignore[call-arg]
