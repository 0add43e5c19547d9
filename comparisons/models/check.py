"""A scene in words: its parts, its rigid motions, and the default lattice and shell for it.

Nothing is solved. Implausible values (`scenes.meaning.plausibility`) are listed as complaints.
"""

import shlex
from dataclasses import dataclass
from functools import cached_property
from typing import Any
from warnings import catch_warnings, simplefilter

from comparisons.models.catalogue import scene_file
from comparisons.models.grids import scene_grid
from comparisons.models.method import RUBBER
from sheetbench.answers.answer import Answer
from sheetbench.answers.report import Picture, Write
from sheetbench.answers.table import Column, Table
from sheetbench.choices import CALIBRATION, ELEMENTS
from sheetbench.errors import Implausible
from sheetbench.scenes import AnyScene, Scene, scene_of
from sheetbench.scenes.meaning.motion import kinks
from sheetbench.scenes.meaning.plausibility import slips
from sheetbench.scenes.meaning.rigid_motions import unstopped_motions
from sheetbench.scenes.meaning.words import in_words
from sheetbench.scenes.objects.grid import elements_of


@dataclass(frozen=True, repr=False)
class Check(Answer):
    """A scene in words; called: its catalogue name or path, for the commands shown."""

    scene: Scene
    called: str

    file_name = "check"

    @cached_property
    def parts(self) -> list[tuple[str, str]]:
        """The scene's parts, the default lattice and the default shell, each with its description."""
        return [*in_words(self.scene), ("lattice", _lattice(self.scene)), ("shell", _shell(self.scene))]

    @cached_property
    def warnings(self) -> list[str]:
        """Probable mistakes in the scene."""
        return [f"{self.called}: {slip}" for slip in slips(self.scene)]

    @cached_property
    def free(self) -> list[str]:
        """Rigid motions that supports and obstacles leave free."""
        return unstopped_motions(self.scene)

    @property
    def has_friction(self) -> bool:
        """Whether an obstacle has friction, which statics refuse."""
        return any(obstacle.friction for obstacle in self.scene.obstacles)

    def document(self) -> dict[str, Any]:
        return {
            "scene": self.scene.document(),
            "parts": [{"part": part, "what": what} for part, what in self.parts],
            "free_rigid_motions": self.free,
            "warnings": self.warnings,
        }

    def tables(self) -> tuple[Table, ...]:
        return (Table.listed("What will be solved", ("part", Column("what", prose=True)), self.parts),)

    def figures(self) -> tuple[Picture, ...]:
        return (Picture("plan", "comparisons.models.check_figure:compose", (self.scene,)),)

    def files(self) -> dict[str, Write]:
        return scene_file(self.called)

    def notes(self) -> list[str]:
        called, moves_alone = shlex.quote(self.called), self.has_friction or bool(self.free)
        until = max(kinks(self.scene), default=0.0) or (1.0 if moves_alone else 0.0)
        statics = [] if moves_alone else [f"Solve it with:\nsheetbench compare {called}"]
        motion = [f"Its motion:\nsheetbench compare {called} --duration {until:g}"] if until > 0.0 else []
        return [*statics, *motion]

    def complaints(self) -> list[str]:
        floats = "the sheet can move as a rigid body: it has modes and motion, and no answer at rest"
        return [*self.warnings, *([floats] if self.free else [])]


def check(scene: AnyScene, called: str | None = None) -> Check:
    """Return a scene in words; called: its catalogue name or path, for the commands shown."""
    called = called or (scene.name if isinstance(scene, Scene) else str(scene))
    with catch_warnings():
        simplefilter("ignore", Implausible)  # the answer lists these warnings
        return Check(scene_of(scene), called)


def _lattice(scene: Scene) -> str:
    nx, ny, layers = scene_grid(scene, None)
    x, y = (1e3 * length / (n - 1) for length, n in zip(scene.sheet.lengths, (nx, ny), strict=True))
    calibration = CALIBRATION if scene.material.law is None else RUBBER
    springs = f"{calibration} springs" if scene.springs is None else "the scene's own springs"
    return (
        f"{nx} × {ny} × {layers} masses in cells of {x:.3g} × {y:.3g} mm, {springs} (--lumped, --calibration)"
    )


def _shell(scene: Scene) -> str:
    nx, ny = elements_of(scene.sheet, ELEMENTS)
    if (given := scene.sheet.mesh) is not None:
        mesh = (
            f"the mesh's {len(given.quads)} elements (--elements {ELEMENTS}; {2 * ELEMENTS} cuts each in four"
        )
    else:
        mesh = f"{nx} × {ny} elements (--elements"
    return f"{mesh}; --reference plate or solid)"
