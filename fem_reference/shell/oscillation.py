"""The shell about its static equilibrium: tangent stiffness and consistent mass on its own unknowns.

K = ∂R/∂(u, β) at full load, geometric stiffness and dead loads' part included,
M = ∫ ρh N_i N_j on displacements, ∫ ρh³/12 N_i N_j T_iᵀ T_j on the directors' rotations β, δd = T β.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from scipy.sparse import csr_matrix

from fem_reference.shell.inertia import Basis, mass, products
from fem_reference.shell.statics import discretise, trace_on
from fem_reference.surface.location import interpolate
from fem_reference.surface.materials import Section
from fem_reference.surface.mesh import mesh_of
from sheetbench.errors import BadInput, NoEquilibrium
from sheetbench.scenes import Scene, Status

Sample = Callable[[np.ndarray, np.ndarray], np.ndarray]


def about_equilibrium(
    scene: Scene, elements: tuple[int, int], section: Section | None, graded: bool, reach: float
) -> tuple[csr_matrix, csr_matrix, Sample]:
    """Stiffness and mass (unknowns, unknowns), and what samples a shape (unknowns,) at plan points (n, 2).

    Raises BadInput for loads that follow the sheet, NoEquilibrium where there
    is no stable equilibrium under the full load.
    """
    mesh = mesh_of(scene, elements, graded, reach)
    structure, _ = discretise(mesh, scene, section)
    if structure.followers:
        raise BadInput("--about = deformed: pressure and edge moments follow the sheet: it has no modes then")
    state, status, notes = trace_on(scene, structure)
    if status is not Status.CONVERGED:
        raise NoEquilibrium(f"shell: {status}: {'; '.join([*notes, status.advice])}")
    stiffness, _ = structure.system(state, structure.forces(state, 1.0), 1.0, mixed=False)
    basis = Basis(structure).at(structure.frames(state))
    whole = mass(structure, products(structure, scene))

    def sample(shape: np.ndarray, points: np.ndarray) -> np.ndarray:
        number = structure.number[:, :3]
        moved = np.where(number >= 0, shape.ravel()[number], 0.0)
        return interpolate(mesh, structure.element_nodes, moved, points)

    return stiffness, (basis.T @ whole @ basis).tocsr(), sample
