"""The linear plate in motion."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from fem_reference.motion.moving import MovingSheet
from fem_reference.plate.discrete import DiscretePlate
from fem_reference.plate.statics import equilibrium
from fem_reference.surface.mesh import Elements, divisions, mesh_of
from sheetbench.answers.solution import Status
from sheetbench.errors import BadInput
from sheetbench.scenes import EdgeMotion, Scene


class MovingPlate(DiscretePlate, MovingSheet):
    """The plate of a scene in motion."""

    def __init__(self, scene: Scene, elements: Elements = 16, graded: bool | None = None):
        refuse_edge_motions(scene, self.model)
        counts = divisions(scene.sheet, elements)
        graded = bool(scene.twisting_edges()) if graded is None else graded
        graded = graded and scene.sheet.mesh is None
        self.label = f"plate {counts[0]} × {counts[1]}"
        self.settings = {"elements": list(counts), "graded": graded}
        super().__init__(mesh_of(scene, counts, graded), scene, moving=True)

    def equilibrium(self, scene: Scene) -> tuple[np.ndarray, Status, Sequence[str]]:
        return equilibrium(DiscretePlate(self.plan.mesh, scene))


def refuse_edge_motions(scene: Scene, model: str) -> None:
    """Raise BadInput for an edge that an actuator moves: the shell alone moves it."""
    for name, actuator in scene.named_actuators().items():
        if isinstance(actuator, EdgeMotion):
            raise BadInput(f"actuator {name}: the {model} in motion has no edge motions; the shell has")
