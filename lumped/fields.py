"""The lattice and its answer as a mesh with fields: masses as points, links as lines, layer cells as quads.

Point data: displacement [m], reaction [N] (force of the supports on each mass), mass share [-]. Cell data,
one value per link and per quad: tension [N] of the links (0 on quads), strain [-] of the links, family
number of the links (−1 on quads), elastic energy [J] of the link or of the layer cell's area spring.
"""

from __future__ import annotations

import numpy as np

from lumped.problem import Problem
from scenes import FieldMesh


def field_mesh(problem: Problem, u: np.ndarray, reactions: np.ndarray) -> FieldMesh:
    """Mesh and fields at displacement u (n, 3) [m] with the supports' forces on the masses (n, 3) [N];
    rows of actuators after those of the masses are left out."""
    assembly = problem.assembly
    links, lattice = assembly.links, assembly.lattice
    stresses = assembly.stresses(u)
    (layer_cells,) = (c.nodes[:, :, 0] for c in lattice.cells if c.name == "area")
    quads, masses = len(layer_cells), lattice.mass_count
    cell_energy = np.zeros(quads)
    for cell, stress in assembly.cell_stresses(stresses):
        energy = cell.energies(stress)
        layers = quads // len(energy)
        cell_energy += np.tile(energy / layers, layers)
    return FieldMesh(
        points=lattice.positions,
        cells=[("line", links.nodes), ("quad", layer_cells)],
        point_data={
            "displacement": u[:masses],
            "reaction": reactions[:masses],
            "mass_share": lattice.share,
        },
        cell_data={
            "tension": [stresses.links, np.zeros(quads)],
            "strain": [stresses.links / links.stiffness / links.rest_length, np.zeros(quads)],
            "family": [links.family.astype(float), np.full(quads, -1.0)],
            "elastic_energy": [0.5 * stresses.links**2 / links.stiffness, cell_energy],
        },
    )
