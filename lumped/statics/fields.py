"""The lattice and its answer as a mesh with fields: masses as points, links as lines, layer cells as quads.

Point data: displacement [m], reaction [N] (force of the supports on each mass), mass share [-]. Cell data,
one value per link and per quad: tension [N] of the links (0 on quads), strain [-] of the links, family
number of the links (−1 on quads), elastic_energy [J] of the link or of the quad's area and strain springs.
"""

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from lumped.assembly import Assembly
from lumped.springs import cells
from lumped.springs.families import SpringCells
from lumped.springs.law_table import FACE
from sheetbench.answers.solution import FieldMesh

NO_FIELDS: Mapping[str, np.ndarray] = {}
SMALL = 1e-12  # share of a displacement at which springs are evaluated as linear


class LatticeMesh(FieldMesh):
    """A mesh with fields that are computed at their first use: most answers need a few points and forces
    only."""

    def __init__(self, make: Callable[[], FieldMesh]):
        self.__dict__["_make"] = make

    def __getattr__(self, name: str) -> Any:
        if name not in FieldMesh.__dataclass_fields__:
            raise AttributeError(name)
        self.__dict__.update(vars(self.__dict__["_make"]()))  # `_make` stays, for concurrent threads
        return self.__dict__[name]

    def __reduce__(self) -> tuple[type[FieldMesh], tuple[Any, ...]]:
        return FieldMesh, tuple(getattr(self, name) for name in FieldMesh.__dataclass_fields__)


def field_mesh(
    assembly: Assembly,
    u: np.ndarray,
    reactions: np.ndarray,
    share: float = 1.0,
    linear: bool = False,
    more: Mapping[str, np.ndarray] = NO_FIELDS,
) -> FieldMesh:
    """Return mesh and fields at displacement u (n, 3) [m] with the supports' forces on the masses (n, 3) [N],
    without actuators' rows. share: of a natural state; linear: of a solution for small displacements, at
    which springs are evaluated for the share SMALL; more: fields of masses (n,)."""
    part = SMALL if linear else 1.0
    assembly = assembly.at(part * share)
    small, links, lattice = part * u, assembly.links, assembly.lattice
    layer_cells = lattice.layer_cells.nodes[:, :, 0]
    quads, masses = len(layer_cells), lattice.mass_count
    cell_energy = np.zeros(quads)
    for family in assembly.springs:
        if isinstance(family, SpringCells) and len(family):
            energy = cells.energies(small, family.arrays) / part**2
            if family.law is FACE:
                faces, count = lattice.faces, lattice.cell_areas.size
                stored = faces.shares * (energy / faces.shares.sum(axis=0))
                energy = np.bincount(faces.cells.ravel(), stored.ravel(), count)[lattice.present_cells]
            layers = quads // len(energy)
            cell_energy += np.tile(energy / layers, layers)
    elongation = links.stretched(small)[2] / part
    return FieldMesh(
        points=lattice.positions,
        cells=[("line", links.nodes), ("quad", layer_cells)],
        point_data={
            "displacement": u[:masses],
            "reaction": reactions[:masses],
            "mass_share": lattice.share,
            **more,
        },
        cell_data={
            "tension": [links.stiffness * elongation, np.zeros(quads)],
            "strain": [elongation / links.rest_length, np.zeros(quads)],
            "family": [links.kind.astype(float), np.full(quads, -1.0)],
            "elastic_energy": [0.5 * links.stiffness * elongation**2, cell_energy],
        },
    )
