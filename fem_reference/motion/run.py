"""A run of a reference from its start, or from its last checkpoint, to its end: step after step.

Samples, frames and checkpoints go to a store as they come. A checkpoint is a step's end; factors are
forgotten there, so that a run that is taken up goes on to the last bit as one that never stopped.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, fields
from typing import Any, NamedTuple

import numpy as np

from fem_reference.motion.generalised_alpha import GeneralisedAlpha, StepFailed
from fem_reference.motion.moving import Motion, Moving
from sheetbench.numerics.direct import SingularMatrixError
from sheetbench.runs.columns import Part, width
from sheetbench.runs.schedule import SAMPLES_PER_CHECKPOINT, Schedule
from sheetbench.runs.store import FolderStore, MemoryStore
from sheetbench.runs.watch import GROWN, Watch
from sheetbench.scenes import Scene, Status
from sheetbench.scenes.history import ENERGIES
from sheetbench.scenes.motion import kinks

MOST_STEPS = 10**6


class Fault(NamedTuple):
    """What ends a run at a time [s]: the status and a sentence."""

    status: Status
    time: float
    message: str


class Sampling:
    """Rows of samples of a reference; `columns`: what their parts are, time first."""

    def __init__(self, model: Moving, scene: Scene):
        self._model, self._points = model, scene.probe_points()
        self._reactions = list(model.reactions(np.zeros(model.mass.shape[0])))
        self.columns: list[Part] = [
            ("time", "", ()),
            *(("energy", name, ()) for name in ENERGIES),
            *(("probe", name, (3,)) for name in scene.probes),
            *(("reaction", name, (3,)) for name in self._reactions),
        ]
        self.width = width(self.columns)

    def row(self, time: float, motion: Motion, spent: np.ndarray) -> np.ndarray:
        """The sample (width,) of a motion; spent: energies [J] dissipated and put in since the start."""
        model = self._model
        energies, reactions = model.energies(motion.q, motion.v, motion.time), model.reactions(motion.exerted)
        probes = model.sample(model.displacement(motion.q), self._points)
        forces = (reactions[name] for name in self._reactions)
        return np.concatenate([[time, *energies, *spent], probes.ravel(), *forces])


@dataclass
class Run:
    """A run under way. shown: samples at which to keep a frame; progress: called with the time reached [s];
    spent: energies [J] dissipated and put in."""

    model: Moving
    scene: Scene
    schedule: Schedule
    method: GeneralisedAlpha
    sampling: Sampling
    kept: FolderStore | MemoryStore
    shown: set[int]
    progress: Callable[[float], None]
    resumed_from: float = 0.0
    samples: int = 0  # taken
    steps: int = 0
    spent: np.ndarray = field(default_factory=lambda: np.zeros(2))
    watch: Watch = field(default_factory=Watch)

    def finish(self) -> tuple[Status, str]:
        """Go on to the end, or to the last step that could be made: how it ended."""
        last = self.schedule.samples * self.schedule.every
        motion = self._start()
        began = max(motion.time * (1.0 - 1e-9), np.finfo(float).tiny)
        bends = [time for time in kinks(self.scene) if began <= time < last]
        for end in (*bends, last):
            while end - motion.time > 1e-9 * end:
                try:
                    after = self.method.advance(motion, self._goal(end) - motion.time)
                except (StepFailed, SingularMatrixError) as failure:
                    return Status.DIVERGED, f"at {motion.time:.6g} s: {failure}"
                self.steps += 1
                if self.steps >= MOST_STEPS:
                    return Status.STEP_LIMIT, f"at {motion.time:.6g} s: {MOST_STEPS} steps were not enough"
                if fault := self._sample(motion, after):
                    return fault.status, f"at {fault.time:.6g} s {fault.message}"
                motion = after
                self.progress(motion.time)
            if end < last and self.model.jumps(end):
                motion = self._begin(end, self.model.placed(motion.q, end), motion.v)
        return self.watch.ending(self.model.beyond(self.watch.stretch))

    def _goal(self, end: float) -> float:
        """Where the next step ends at most [s]: at the next sample with chains, whose firm stiffnesses make
        much energy of the small strains that a cubic between the ends of a step leaves."""
        return min(end, self.samples * self.schedule.every) if self.model.rods else end

    def _start(self) -> Motion:
        """The last checkpoint, or the start, sampled."""
        checkpoint = self.kept.resume()
        if checkpoint is None:
            q = self.model.start()
            motion = self._begin(0.0, q, np.zeros_like(q))
            self._sample(motion, motion)
            return motion
        self.samples, self.steps = int(checkpoint["done"]), int(checkpoint["steps"])
        self.watch = Watch.recall(checkpoint["watch"])
        self.spent, self.resumed_from = checkpoint["spent"], float(checkpoint["time"])
        self.method.recall({name: checkpoint[f"method_{name}"].item() for name in self.method.memory()})
        motion = Motion(self.resumed_from, **{f.name: checkpoint[f.name] for f in fields(Motion)[1:]})
        self.model.memory.since(motion.time, motion.memory)
        self.progress(motion.time)
        return motion

    def _begin(self, time: float, q: np.ndarray, v: np.ndarray) -> Motion:
        """The motion from a time on; what a sudden rate of a support adds is work."""
        motion, mass = self.method.begin(time, q, v), self.model.mass
        self.spent[1] += 0.5 * float(motion.v @ (mass @ motion.v) - v @ (mass @ v))
        return motion

    def _sample(self, start: Motion, end: Motion) -> Fault | None:
        """Take the samples of a step, and a checkpoint after every so many; what is wrong with one."""
        h, every, first = end.time - start.time, self.schedule.every, self.samples
        spent = self.model.spent(start, end, self.method.late) if h else np.zeros(2)
        while self.samples <= self.schedule.samples:
            time = self.samples * every
            if time > end.time + 1e-9 * self.schedule.samples * every:
                break
            motion = between(start, end, time) if h else end
            so_far = self.spent + spent * ((motion.time - start.time) / h if h else 0.0)
            row = self.sampling.row(time, motion, so_far)
            if fault := self._fault(motion, row):
                return fault
            self.kept.sample(row)
            if self.samples in self.shown:
                self.kept.frame(self.model.displacement(motion.q))
            self.samples += 1
        self.spent = self.spent + spent
        if self.samples // SAMPLES_PER_CHECKPOINT > first // SAMPLES_PER_CHECKPOINT:
            self.method.forget()
            content: dict[str, Any] = {f"method_{k}": v for k, v in self.method.memory().items()}
            content |= vars(end) | {"done": self.samples, "steps": self.steps, "spent": self.spent}
            self.kept.checkpoint(content | {"watch": self.watch.memory()})
        return None

    def _fault(self, motion: Motion, row: np.ndarray) -> Fault | None:
        """What makes a sample worthless; sound ones the watch takes."""
        grown = float(self.watch.grown(row[None])[0])
        if not np.isfinite(grown):
            return Fault(Status.NON_FINITE, motion.time, "a number overflowed: use smaller steps")
        if inverted := self.model.inside_out(motion.q):
            return Fault(Status.INVERTED, motion.time, inverted)
        if grown > GROWN:
            text = f"the energy has grown from nothing, by {100.0 * grown:.3g} % of the largest"
            return Fault(Status.DIVERGED, motion.time, f"{text}: use smaller steps")
        self.watch.take(row[None])
        stretch = self.model.stretch(motion.q)
        self.watch.strained(motion.time, stretch, bool(self.model.beyond(stretch)))
        return None


def between(start: Motion, end: Motion, time: float) -> Motion:
    """The motion within a step: coordinates cubic in time, all else linear."""
    h = end.time - start.time
    s = min((time - start.time) / h, 1.0)
    if s == 1.0:
        return end
    cubic = (1.0 + 2.0 * s) * (1.0 - s) ** 2 * start.q + s * s * (3.0 - 2.0 * s) * end.q
    cubic = cubic + h * s * (1.0 - s) * ((1.0 - s) * start.v - s * end.v)
    v, a, algorithm, exerted = (
        (1.0 - s) * getattr(start, name) + s * getattr(end, name)
        for name in ("v", "a", "algorithm", "exerted")
    )
    return Motion(time, cubic, v, a, algorithm, exerted)
