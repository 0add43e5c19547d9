"""Displacement of a shell by another law of strain, from its equilibrium under St Venant–Kirchhoff's law.

The laws agree at small strain, so that their stresses differ by δs of second order in it, and with K the
tangent at the equilibrium

    K δu = −Bᵀ δs

moves it to the other law's equilibrium, to first order; a second step with the old K, to second order. The
first step alone is too large in bending: δs of bending is even through the thickness and strains the
mid-surface, which then changes the moment. A hanging sheet with a hole moves by a half and by an eighth of
the first step in Biot's and neo-Hooke's laws, and by 0.96 of both steps in the law that moves it farther. A
strain counts by its effect on the displacement at the probes: a peak of stretch in a corner hardly counts, a
stretch that carries the sheet counts fully, and near a fold, where K is soft, a small strain counts much.
"""

import numpy as np

from fem_reference.discrete.static import Static, StaticState
from fem_reference.sheets import shell
from fem_reference.shell.discrete import UP
from fem_reference.shell.hyperelastic import HyperelasticElement
from fem_reference.shell.laws import LAWS
from sheetbench.answers.solution import Solution
from sheetbench.choices import STRAIN_LAW
from sheetbench.numerics.direct import SingularMatrixError
from sheetbench.numerics.threads import one_blas_thread
from sheetbench.scenes import Scene

OTHERS = ("biot", "neo-hookean")
STEPS = 2
SAME = 1e-6  # residual, relative to the forces, up to which the rebuilt mesh reproduces the answer


def shift(scene: Scene, answer: Solution) -> float | None:
    """Return the larger distance of the shells of `OTHERS` from a shell's answer, over its largest
    displacement at probes. It is None, unknown, for sheets that are not uniform, actuators, sections and
    meshes of the caller's own, and for answers that a mesh of their settings does not reproduce."""
    settings = answer.settings
    supported = {"elements", "graded", "law"} == set(settings) and settings["law"] == STRAIN_LAW
    if not supported or not scene.uniform or scene.actuators or len(scene.probe_points()) == 0:
        return None
    with one_blas_thread():
        sheet = shell(scene, tuple(settings["elements"]), graded=settings["graded"])
        fields, element = answer.mesh.point_data, sheet.element
        if fields["displacement"].shape != (sheet.nodes, 3):
            return None
        start = StaticState(sheet.of_vectors(fields["displacement"], fields["director"] - UP))
        static = Static(sheet)
        rest = static.forces(start, 1.0)
        if not static.imbalance(start, rest) <= SAME * rest.size:
            return None
        matrix, _ = static.linearised(start, rest, 1.0, mixed=False)
        moved = [np.zeros(1)]
        try:
            factor = sheet.solver().factor(matrix)
            plain = sheet.plan.corners, scene.material, scene.sheet.thickness
            for law in OTHERS:
                other = HyperelasticElement.of(*plain, LAWS[law])
                # the answer's own residual is not counted
                state, forces, residual = start, rest, np.zeros(1)
                for _ in range(STEPS):
                    shape = forces.shape
                    change = element.forces(shape.operator, other.stress(shape.strain) - shape.elastic)
                    step = -factor.solve(sheet.reduce(shape, residual + sheet.scatter(change)))
                    state = StaticState(static.advance(state, forces, 1.0, step).q)
                    forces = static.forces(state, 1.0)
                    residual = forces.residual
                change_of_nodes = sheet.displacement(state.q - start.q)
                moved.append(sheet.sample(change_of_nodes, scene.probe_points()))
        except SingularMatrixError:
            return None
    largest = np.abs(answer.displacement(scene.probe_points())).max()
    farthest = max(float(np.abs(displacement).max()) for displacement in moved)
    return farthest / float(largest) if largest > 0.0 and np.isfinite(farthest) else None
