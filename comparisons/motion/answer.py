"""A simulated scene: its history beside measured ones, frames of the whole sheet: `sheetbench simulate`."""

from __future__ import annotations

import shutil
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import partial
from typing import Any

from comparisons.models.grading import choice_notes
from comparisons.motion.frames import write_frames
from comparisons.motion.history import left_out
from sheetbench.answers.answer import Answer
from sheetbench.answers.report import Film, Picture, Write
from sheetbench.answers.table import Table, quantity
from sheetbench.scenes import History, Scene
from sheetbench.scenes.measured_history import Measured


@dataclass(frozen=True, repr=False)
class Simulation(Answer):
    """A run of a scene; measured: histories by probe; animate: draw it moving."""

    file_name = "history"
    history: History
    scene: Scene
    measured: Mapping[str, Measured] = field(default_factory=dict)
    animate: bool = False

    def heading(self) -> tuple[str, str, str]:
        """The scene, and how it was run."""
        run = self.history
        return self.scene.name, self.scene.title, f"{run.label}, {run.integrator}, {run.steps} steps"

    def document(self) -> dict[str, Any]:
        """The history's, with its errors where it was measured."""
        run = self.history
        errors = {name: m.error(run.time, run.probes[name]) for name, m in self.measured.items()}
        return {**run.document(), **({"measured_errors": errors} if errors else {})}

    def tables(self) -> tuple[Table, ...]:
        """The history's."""
        return self.history.tables(self.measured)

    def figures(self) -> list[Picture]:
        """Probes over time, and the sheet moving."""
        of = (self.history, self.scene.title or self.scene.name, self.measured)
        pictures = [Picture("history", "sheetbench.scenes.history_figure:compose", of)]
        if self.animate:
            formats = ("gif", "mp4") if shutil.which("ffmpeg") else ("gif",)
            film = "comparisons.motion.animation:animate"
            pictures.append(Film("animation", film, (self.scene, [self.history]), formats=formats))
        return pictures

    def files(self) -> dict[str, Write]:
        """All samples, and the sheet at some moments."""
        return {**self.history.files(), "frames.pvd": partial(write_frames, history=self.history)}

    def result(self) -> str:
        """Return the largest displacement of a probe on the way, or why the run ended early."""
        largest = {name: float(abs(u).max()) for name, u in self.history.probes.items() if len(u)}
        if not largest or not self.succeeded:
            return super().result()
        probe = max(largest, key=lambda name: largest[name])
        return f"{probe} moves by up to {quantity(largest[probe], 'm', '.4g')} in {self.history.time[-1]:g} s"

    def notes(self) -> list[str]:
        """What was chosen, and what the history says."""
        return [*choice_notes(self.history.settings), *self.history.notes()]

    def complaints(self) -> list[str]:
        """Why the run did not reach its end, and what was measured outside it."""
        return [*self.history.complaints(), *left_out(self.history, self.measured)]

    def choices(self) -> Mapping[str, Any]:
        """Integrator and settings."""
        return self.history.choices()

    @property
    def succeeded(self) -> bool:
        """Whether the run reached its end."""
        return self.history.succeeded
