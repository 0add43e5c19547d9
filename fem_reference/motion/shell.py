"""The shell in motion."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from fem_reference.motion.moving import MovingSheet
from fem_reference.shell.discrete import DiscreteShell
from fem_reference.shell.statics import discretise, elements_of, trace_on
from fem_reference.surface.mesh import Elements, divisions, mesh_of, plan_of
from sheetbench.answers.solution import Status
from sheetbench.choices import STRAIN_LAW
from sheetbench.scenes import Scene


class MovingShell(DiscreteShell, MovingSheet):
    """The shell of a scene in motion."""

    def __init__(self, scene: Scene, elements: Elements = 16, graded: bool = True, law: str = STRAIN_LAW):
        counts = divisions(scene.sheet, elements)
        graded = graded and scene.sheet.mesh is None
        self.label = f"shell {counts[0]} × {counts[1]}"
        self.settings = {"elements": list(counts), "graded": graded, "law": law}
        plan = plan_of(mesh_of(scene, counts, graded))
        super().__init__(plan, scene, elements_of(plan, scene, None, law), law == STRAIN_LAW, moving=True)

    def equilibrium(self, scene: Scene) -> tuple[np.ndarray, Status, Sequence[str]]:
        return trace_on(discretise(self.plan.mesh, scene, law=self.settings["law"]))
