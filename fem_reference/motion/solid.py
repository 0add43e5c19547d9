"""The solid in motion."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from fem_reference.motion.moving import MovingSheet
from fem_reference.motion.plate import refuse_edge_motions
from fem_reference.solid.discrete import DiscreteSolid
from fem_reference.solid.statics import columns_of, discretise, plan_mesh, trace_on
from fem_reference.surface.mesh import Elements, divisions
from sheetbench.answers.solution import Status
from sheetbench.choices import STRAIN_LAW
from sheetbench.scenes import Scene


class MovingSolid(DiscreteSolid, MovingSheet):
    """The solid of a scene in motion."""

    def __init__(
        self,
        scene: Scene,
        elements: Elements = 16,
        layers: int = 1,
        law: str = STRAIN_LAW,
        clamp: str = "shell-like",
        grading: str = "edges",
    ):
        refuse_edge_motions(scene, self.model)
        counts = divisions(scene.sheet, elements)
        self.label = f"solid {counts[0]} × {counts[1]} × {layers}"
        self.settings = {"elements": list(counts), "grading": grading, "layers": layers}
        self.settings |= {"law": law, "clamp": clamp}
        columns, material = columns_of(plan_mesh(scene, counts, grading), scene, layers, law)
        super().__init__(columns, scene, law, material, clamp, moving=True)

    def equilibrium(self, scene: Scene) -> tuple[np.ndarray, Status, Sequence[str]]:
        options = (self.settings[name] for name in ("layers", "law", "clamp"))
        return trace_on(discretise(self.plan.mesh, scene, *options))
