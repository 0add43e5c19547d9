"""VTU files of meshes with their fields.

Every file has point data `displacement` (n, 3) [m]; points are those of the undeformed sheet.
"""

from __future__ import annotations

from pathlib import Path

from sheetbench.answers.solution import FieldMesh
from sheetbench.files import whole


def write_mesh(path: Path, mesh: FieldMesh) -> None:
    """Write a mesh with its fields as VTU."""
    import meshio  # half as slow to import as all else that a comparison needs

    file = meshio.Mesh(mesh.points, mesh.cells, mesh.point_data, mesh.cell_data)
    with whole(path) as partial:
        meshio.write(partial, file, file_format="vtu")
