"""A run of a motion from its start, or from its last checkpoint, to its end, of any method and model.

Samples, frames and checkpoints go to a store as they come. A checkpoint is the end of a step; what methods
keep only for speed is forgotten there, so that a run that is taken up goes on to the last bit as one that
never stopped. Every sample is looked at: numbers that overflow, elements that turn inside out and energy
from nowhere end the run with the time, the place and what to change.
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

Part = tuple[str, str, tuple[int, ...]]  # of the numbers of a sample: kind, name, shape

GROWN, TOLD = 0.1, 0.01  # shares of the energy: as of `Watch`
MOST_STEPS = 100_000  # of a method that adapts them, between two samples


class Observer(Protocol):
    """What a model says of samples, as its method gives them. columns: what a row of numbers holds: the time,
    kinetic, elastic, potential and dissipated energy, work, then the rest; least_energy: [J] below
    which all is rounding."""

    columns: list[Part]
    least_energy: float

    def rows(self, samples: Any) -> np.ndarray:
        """Return the numbers of samples, (k, width)."""

    def inspect(self, samples: Any, count: int) -> tuple[np.ndarray, Fault | None]:
        """Return how far the sheet is strained, as `beyond` takes it, at those of the first `count` samples
        before one that means nothing, and why that one does not."""

    def beyond(self, stretch: float) -> str:
        """Return a clause where the model does not hold that far, or farther, else ""."""

    def fastest(self, samples: Any, i: int) -> str:
        """Return where the sheet is fastest at sample i, in words."""

    def frame(self, samples: Any, i: int) -> np.ndarray:
        """Return the whole displacement (n, 3) [m] of sample i."""


@dataclass
class Watch:
    """What the samples of any run are watched for: energy from nowhere, strains beyond the model.

    Whatever dampers take, kinetic + elastic + potential − work never grows in an exact run. A growth from its
    lowest value so far, by more than GROWN of the energy that goes round, ends the run. With what dampers
    take, as the rule of integration sums it, the balance is constant; a departure either way by more than
    TOLD is reported. Losses are what the rule takes (`History.numerical`) and end no run. Strains beyond a
    model's limits end none either: the run that came to them says so, and from when on.

    origin: the balance at the start [J]; lowest: kinetic + elastic + potential − work at a sample so far
    [J]; largest: energy of any kind there [J]; off: the largest departure of the balance [J]; stretch: the
    largest so far, or what else a model measures strains by; since: when that first was beyond the model [s].
    """

    origin: float = np.nan
    lowest: float = np.inf
    largest: float = 0.0
    off: float = 0.0
    stretch: float = 0.0
    since: float = np.nan

    def strained(self, times: np.ndarray, stretches: np.ndarray, beyond: Callable[[float], str]) -> None:
        """Note how far the sheet is strained at samples (k,); beyond: a clause where that is too far."""
        largest = max(stretches.tolist(), default=-1.0)
        if largest >= self.stretch:
            self.stretch = largest
            if isnan(self.since) and beyond(largest):
                self.since = float(times[[bool(beyond(one)) for one in stretches.tolist()].index(True)])

    def take(self, rows: np.ndarray) -> tuple[int, float]:
        """Go on past samples (k, 6 or more), time, kinetic, elastic, potential and dissipated energy, work;
        return how many there are before the first that is unsound, and the energy from nowhere then, over the
        largest until then: nan where some number is none, and where all are sound."""
        sound, grown, *kept = take(rows, self.origin, self.lowest, self.largest, self.off)
        self.origin, self.lowest, self.largest, self.off = kept
        return sound, grown

    def ending(self, outside: str, steps: str = "") -> tuple[Status, str]:
        """Return the status of a run that came to its end, and what there is to say; outside: a clause on the
        strains that went farthest beyond the model; steps: one on the steps."""
        notes = [f"from {number(self.since, '.4g')} s on {outside}"] if outside else []
        if self.largest > 0.0 and self.off > TOLD * self.largest:
            share = number(100.0 * self.off / self.largest, ".2g")
            notes.append(
                f"the energy balance is off by {share} % of the largest energy at some sample: energies are "
                "good to no more; smaller steps (--error, --step) keep it better"
            )
        notes += [steps] if steps else []
        return Status.STRAIN_OUTSIDE_MODEL if outside else Status.CONVERGED, "; ".join(notes)

    def memory(self) -> np.ndarray:
        """What a resumed run needs."""
        return np.array(list(vars(self).values()))

    @classmethod
    def recall(cls, memory: np.ndarray) -> Self:
        """Take up what `memory` gave."""
        return cls(*memory.tolist())


@njit
def take(
    rows: np.ndarray, origin: float, lowest: float, largest: float, off: float
) -> tuple[int, float, float, float, float, float]:
    """Return what `Watch.take` does, and what is kept then."""
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
    """A run under way. shown: samples at which to keep a frame; progress: called with the time reached [s].
    samples: taken, the start's too; spent: energies [J] dissipated and put in."""

    def __init__(
        self,
        method: MotionMethod[AnyState],
        observer: Observer,
        schedule: Schedule,
        kept: FolderStore | MemoryStore,
        shown: Iterable[int],
        progress: Callable[[float], None] | None,
    ):
        self._method, self._observer, self._schedule = method, observer, schedule
        self._kept, self._shown, self._progress = kept, set(shown), progress or (lambda time: None)
        self.samples = self.steps = 0
        self.resumed_from, self.spent, self.watch = 0.0, np.zeros(2), Watch(largest=observer.least_energy)

    def finish(self, start: Callable[[], Advance[AnyState]]) -> tuple[Status, str]:
        """Go on to the end, or to a fault, from the last checkpoint or the start: how it ended. start: the
        state to begin in, with the work of what moves at once."""
        self._method.forget()
        state, since = self._resumed() or self._passed(start())[0].state, 0
        while self.samples <= self._schedule.samples:
            try:
                last = self._method.go(state, self._goal(state.time) - state.time)
            except (StepFailed, SingularMatrixError) as failure:
                return Status.DIVERGED, f"at {state.time:.6g} s: {failure}"
            self.steps += last.steps
            since += last.steps
            if self._method.adapts and since >= MOST_STEPS:
                text = f"at {last.state.time:.6g} s: {since} steps without reaching the next sample"
                return Status.STEP_LIMIT, f"{text}: add damping or fix the step"
            before, (last, fault) = self.samples, self._passed(last)
            if fault is not None:
                return fault.status, fault.message
            state = last.state
            if self.samples > before:
                since = 0
                if (self.samples - 1) // SAMPLES_PER_CHECKPOINT > (before - 1) // SAMPLES_PER_CHECKPOINT:
                    self._checkpoint(state)
            self._progress(state.time)
        return self.watch.ending(self._observer.beyond(self.watch.stretch), self._method.notes())

    def _goal(self, time: float) -> float:
        """Where the next step ends at most [s]."""
        every, goal, span = self._schedule.every, self._schedule.samples, self._method.span
        if span is not None:
            goal = min(((self.samples - 1) // span + 1) * span, goal)
        kinks = self._method.kinks
        after = bisect(kinks, time + 1e-9 * every)
        return float(min([goal * every, *kinks[after : after + 1]]))

    def _passed(self, last: Advance[AnyState]) -> tuple[Advance[AnyState], Fault | None]:
        """Take the samples that a step passed; the step, its end at a sample's very time, and a fault."""
        every, fault = self._schedule.every, None
        number = int(last.state.time / every + 1e-9)
        if number >= self.samples:
            if self._method.span is not None and abs(last.state.time - number * every) < 1e-9 * every:
                last = replace(last, state=replace(last.state, time=number * every))  # type: ignore[type-var]
            samples = self._method.at(every * np.arange(self.samples, number + 1), last)
            fault = self._take(samples)
        self.spent = self.spent + np.array([last.dissipated, last.work])
        return last, fault

    def _take(self, samples: Any) -> Fault | None:
        """Keep samples up to the first that means nothing, and why it does not; energies: since the step
        began."""
        observer, rows = self._observer, self._observer.rows(samples)
        rows[:, 4] += self.spent[0]
        rows[:, 5] += self.spent[1]
        count, grown = self.watch.take(rows)
        stretches, fault = observer.inspect(samples, count + isfinite(grown))
        count = count if fault is None else len(stretches)
        self.watch.strained(rows[:count, 0], stretches[:count], observer.beyond)
        if count < len(rows):
            if fault is None:
                where = f"{observer.fastest(samples, count)}: use smaller steps"
                share = f"by {100.0 * grown:.3g} % of the largest, fastest at {where}"
                grew = Fault(Status.DIVERGED, f"the energy has grown from nothing, {share}")
                overflowed = Fault(Status.NON_FINITE, f"a number overflowed, first at {where}")
                fault = grew if isfinite(grown) else overflowed
            fault = Fault(fault.status, f"at {rows[count, 0]:.6g} s {fault.message}")
        shown = fault is not None and fault.status is not Status.NON_FINITE
        self._kept.append("samples", rows[: count + shown])
        for due in sorted(self._shown.intersection(range(self.samples, self.samples + count))):
            self._kept.append("frames", observer.frame(samples, due - self.samples)[None])
        self.samples += count
        return fault

    def _checkpoint(self, state: AnyState) -> None:
        self._method.forget()
        content = {f"state_{name}": value for name, value in vars(state).items()}
        content |= {f"method_{name}": value for name, value in self._method.memory().items()}
        content |= {"taken": self.samples, "steps": self.steps, "spent": self.spent}
        content = {name: value for name, value in content.items() if value is not None}
        self._kept.checkpoint(content | {"watch": self.watch.memory()})

    def _resumed(self) -> AnyState | None:
        """The state of the last checkpoint, if there is one, and with it what the run had come to."""
        checkpoint = self._kept.resume()
        if checkpoint is None:
            return None

        def named(kind: str) -> dict[str, Any]:
            return {k.removeprefix(kind): v for k, v in checkpoint.items() if k.startswith(kind)}

        self.samples, self.steps = int(checkpoint["taken"]), int(checkpoint["steps"])
        self.spent, self.watch = checkpoint["spent"], Watch.recall(checkpoint["watch"])
        self._method.recall(named("method_"))
        fields = named("state_")
        self.resumed_from = float(fields.pop("time"))
        self._progress(self.resumed_from)
        return self._method.state(self.resumed_from, **fields)  # type: ignore[call-arg]
