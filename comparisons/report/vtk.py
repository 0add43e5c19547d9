"""VTU files of meshes with their fields, and the plan grid that solutions are put side by side on.

Every file has point data `displacement` (n, 3) [m]; points are those of the undeformed sheet.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

from sheetbench.files import whole
from sheetbench.scenes import FieldMesh, Sheet, Solution
from sheetbench.scenes.grid import near_square

PLAN_CELLS = 64


def write_mesh(path: Path, mesh: FieldMesh) -> None:
    """Write a mesh with its fields as VTU."""
    import meshio  # half as slow to import as all else that a comparison needs

    file = meshio.Mesh(mesh.points, mesh.cells, mesh.point_data, mesh.cell_data)
    with whole(path) as partial:
        meshio.write(partial, file, file_format="vtu")


def write_solution(path: Path, solution: Solution) -> None:
    """Write a solution on its own mesh."""
    write_mesh(path, solution.mesh)


def plan_mesh(sheet: Sheet, cells: int = PLAN_CELLS) -> FieldMesh:
    """Quadrilaterals over the flat sheet, `cells` along the shorter side; x runs fastest. No fields yet."""
    nx, ny = near_square(sheet, cells)
    y, x = np.meshgrid(
        np.linspace(0, sheet.length_y, ny + 1), np.linspace(0, sheet.length_x, nx + 1), indexing="ij"
    )
    points = np.column_stack([x.ravel(), y.ravel(), np.zeros(x.size)])
    corner = (np.arange(ny)[:, None] * (nx + 1) + np.arange(nx)).ravel()
    quads = np.column_stack([corner, corner + 1, corner + nx + 2, corner + nx + 1])
    return FieldMesh(points, [("quad", quads)], {})
