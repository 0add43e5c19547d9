"""A model of one's own: a sheet clamped at x0 as a strip that bends like a beam, in closed form."""

import numpy as np

from scenes import FieldMesh, Solution, Status


class Strip:
    name = "strip"
    settings = {"plane_strain": False}  # noqa: RUF012

    def solve(self, scene, settings):
        sheet, material = scene.sheet, scene.material
        rigidity = material.young * sheet.thickness**3 / 12
        if settings["plane_strain"]:
            rigidity /= 1 - material.poisson**2
        weight, length = material.density * sheet.thickness * scene.gravity.acceleration[2], sheet.length_x

        def displacement(points):
            x = points[:, 0]
            w = weight * x**2 * (6 * length**2 - 4 * length * x + x**2) / (24 * rigidity)
            return np.column_stack([0 * x, 0 * x, w])

        mesh = FieldMesh(np.zeros((1, 3)), [("vertex", np.array([[0]]))], {"displacement": np.zeros((1, 3))})
        return Solution(
            self.name, "strip", dict(settings), Status.CONVERGED, 0, 0, 0.0, 0.0, displacement, {}, {}, mesh
        )


MODEL = Strip()
