"""A model of one's own: a sheet clamped at x0 as a strip that bends like a beam, in closed form."""

import numpy as np

from sheetbench.answers.solution import FieldMesh, Solution, Status
from sheetbench.scenes import BadInput, Clamped


class Strip:
    name = "strip"
    settings = {"plane_strain": False}  # noqa: RUF012

    def solve(self, scene, settings):
        sheet, material, gravity = scene.sheet, scene.material, scene.gravity
        foreign = scene.loads or scene.actuators or scene.supports != (Clamped(edge="x0"),)
        if foreign or gravity is None or any(gravity.acceleration[:2]):
            raise BadInput("strip: knows a sheet clamped at x0 under its own weight along z, no more")
        rigidity = material.young * sheet.thickness**3 / 12
        if settings["plane_strain"]:
            rigidity /= 1 - material.poisson**2
        load = material.density * sheet.thickness * gravity.last_acceleration[2]
        length = sheet.length_x

        def displacement(points):
            x = points[:, 0]
            w = load * x**2 * (6 * length**2 - 4 * length * x + x**2) / (24 * rigidity)
            return np.column_stack([0 * x, 0 * x, w])

        mesh = FieldMesh(np.zeros((1, 3)), [("vertex", np.array([[0]]))], {"displacement": np.zeros((1, 3))})
        return Solution(
            self.name, "strip", dict(settings), Status.CONVERGED, 0, 0, 0.0, 0.0, displacement, {}, {}, mesh
        )


MODEL = Strip()
