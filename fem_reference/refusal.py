"""The answer of a model that does not support what a scene asks: an unmoved sheet, status `refused`."""

from __future__ import annotations

import numpy as np

from scenes import FieldMesh, Scene, Solution, Status


def refused(scene: Scene, model: str, message: str) -> Solution:
    """A solution that says why there is none; its mesh is the sheet's outline."""
    lx, ly = scene.sheet.lengths
    corners = np.array([[0.0, 0.0, 0.0], [lx, 0.0, 0.0], [lx, ly, 0.0], [0.0, ly, 0.0]])
    return Solution(
        model=model,
        label=model,
        settings={},
        status=Status.REFUSED,
        unknowns=0,
        iterations=0,
        setup_seconds=0.0,
        solve_seconds=0.0,
        sample=lambda points: np.zeros((len(points), 3)),
        reactions={},
        energies={},
        mesh=FieldMesh(corners, [("quad", np.array([[0, 1, 2, 3]]))], {"displacement": np.zeros((4, 3))}),
        load_factor=0.0,
        message=message,
    )


def of_actuators(scene: Scene, model: str) -> Solution:
    """The refusal of a scene's actuators by a model that has no rods."""
    edges = ", ".join(str(actuator.edge) for actuator in scene.actuators)
    return refused(scene, model, f"the {model} takes no actuators (edge {edges}): use the shell")
