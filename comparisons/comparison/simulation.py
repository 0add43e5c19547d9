"""A simulated scene with its history and displacement fields: the answer of `sheetbench simulate`."""

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
    """A run of a scene; animate: make an animation."""

    file_name = "history"
    scene: Scene
    animate: bool = False

    def heading(self) -> tuple[str, str, str]:
        return self.scene.name, self.scene.title, f"{self.label}, {self.integrator}, {self.steps} steps"

    def figures(self) -> tuple[Picture, ...]:
        arguments = (self, self.scene.title or self.scene.name)
        pictures = [Picture("history", "sheetbench.answers.history_figure:compose", arguments)]
        if self.animate:
            film = "comparisons.comparison.animation:animate"
            pictures.append(Picture("animation", film, (self.scene, [self]), formats=FILM))
        return tuple(pictures)

    def files(self) -> dict[str, Write]:
        """Return the samples and the displacement fields."""
        return {**super().files(), "frames.pvd": partial(write_frames, history=self)}

    def result(self) -> str:
        """Return the largest displacement of a probe, or the reason for an early end."""
        largest = {name: float(abs(u).max()) for name, u in self.probes.items() if len(u)}
        if not largest or not self.succeeded:
            return super().result()
        probe = max(largest, key=lambda name: largest[name])
        return f"{probe} moves by up to {quantity(largest[probe], 'm', '.4g')} in {self.time[-1]:g} s"

    def notes(self) -> list[str]:
        return [*choice_notes(self.settings), *super().notes()]
