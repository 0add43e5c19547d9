"""How far another law of strain would move a shell, from its equilibrium under St Venant–Kirchhoff's.

The laws are alike at small strain, so that their stresses differ by δs of second order in it, and with K the
tangent at the equilibrium

    K δu = −Bᵀ δs

moves it to the other law's, to first order. It weighs the strains by what they do to the displacement at
the probes: a peak of stretch in a corner next to nothing, a stretch that carries the sheet all of it, and
near a fold, where K is soft, more than any strain would let expect.
"""

from __future__ import annotations

import numpy as np

from fem_reference.discrete.static import Static, StaticState
from fem_reference.shell.discrete import UP
from fem_reference.shell.hyperelastic import HyperelasticElement
from fem_reference.shell.laws import LAWS
from fem_reference.shell.statics import discretise
from fem_reference.surface.mesh import mesh_of
from sheetbench.answers.solution import Solution
from sheetbench.choices import STRAIN_LAW
from sheetbench.numerics.direct import SingularMatrixError
from sheetbench.numerics.threads import one_blas_thread
from sheetbench.scenes import Scene

OTHERS = ("biot", "neo-hookean")
SAME = 1e-6  # residual, relative to the forces, up to which the answer's state is that of the mesh rebuilt


def shift(scene: Scene, answer: Solution) -> float | None:
    """Return how far the shells of `OTHERS` are from a shell's answer, whichever is farther, as a share of
    the largest displacement at the scene's probes; None where it is unknown: of sheets that are not the
    same all over, actuators, sections and meshes of the caller's own, and sheets solved by halves."""
    settings = answer.settings
    whole = {"elements", "graded", "law"} == set(settings) and settings["law"] == STRAIN_LAW
    if not whole or not scene.uniform or scene.actuators or len(scene.probe_points()) == 0:
        return None
    with one_blas_thread():
        sheet = discretise(mesh_of(scene, tuple(settings["elements"]), settings["graded"]), scene)
        fields, element = answer.mesh.point_data, sheet.element
        if fields["displacement"].shape != (sheet.nodes, 3):
            return None
        state = StaticState(sheet.of_vectors(fields["displacement"], fields["director"] - UP))
        static = Static(sheet)
        forces = static.forces(state, 1.0)
        if not static.imbalance(state, forces) <= SAME * forces.size:
            return None
        matrix, _ = static.system(state, forces, 1.0, mixed=False)
        shape, moved = forces.shape, [np.zeros(1)]
        try:
            factor = sheet.solver().factor(matrix)
            for law in OTHERS:
                other = HyperelasticElement.of(
                    sheet.plan.corners, scene.material, scene.sheet.thickness, LAWS[law]
                )
                change = element.forces(shape.operator, other.stress(shape.strain) - shape.elastic)
                step = -factor.solve(sheet.reduce(shape, sheet.scatter(change)))
                after = sheet.displacement(static.advance(state, forces, 1.0, step).q - state.q)
                moved.append(sheet.sample(after, scene.probe_points()))
        except SingularMatrixError:
            return None
    largest = np.abs(answer.displacement(scene.probe_points())).max()
    farthest = max(float(np.abs(each).max()) for each in moved)
    return farthest / float(largest) if largest > 0.0 and np.isfinite(farthest) else None
