"""A simulated scene: its history and frames of the whole sheet: `sheetbench simulate`."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial

from comparisons.comparison.frames import write_frames
from comparisons.models.grading import choice_notes
from sheetbench.answers.history import History
from sheetbench.answers.report import FILM, Picture, Write
from sheetbench.answers.table import quantity
from sheetbench.scenes import Scene


@dataclass(frozen=True, repr=False, eq=False, kw_only=True)
class Simulation(History):
    """A run of a scene; animate: draw it moving."""

    file_name = "history"
    scene: Scene
    animate: bool = False

    def heading(self) -> tuple[str, str, str]:
        return self.scene.name, self.scene.title, f"{self.label}, {self.integrator}, {self.steps} steps"

    def figures(self) -> tuple[Picture, ...]:
        of = (self, self.scene.title or self.scene.name)
        pictures = [Picture("history", "sheetbench.answers.history_figure:compose", of)]
        if self.animate:
            film = "comparisons.comparison.animation:animate"
            pictures.append(Picture("animation", film, (self.scene, [self]), formats=FILM))
        return tuple(pictures)

    def files(self) -> dict[str, Write]:
        """All samples, and the sheet at some moments."""
        return {**super().files(), "frames.pvd": partial(write_frames, history=self)}

    def result(self) -> str:
        """Return the largest displacement of a probe on the way, or why the run ended early."""
        largest = {name: float(abs(u).max()) for name, u in self.probes.items() if len(u)}
        if not largest or not self.succeeded:
            return super().result()
        probe = max(largest, key=lambda name: largest[name])
        return f"{probe} moves by up to {quantity(largest[probe], 'm', '.4g')} in {self.time[-1]:g} s"

    def notes(self) -> list[str]:
        return [*choice_notes(self.settings), *super().notes()]
