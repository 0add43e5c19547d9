"""VTU files: one per solution on its own mesh, and one with all solutions on a common plan grid.

Every file has point data `displacement` (n, 3) [m]; points are those of the undeformed sheet.
"""

from __future__ import annotations

from pathlib import Path

import meshio
import numpy as np

from comparisons.comparison.comparison import Comparison
from sheetbench.files import whole
from sheetbench.scenes import FieldMesh, Sheet, Solution
from sheetbench.scenes.grid import near_square

PLAN_CELLS = 64


def write_mesh(path: Path, mesh: FieldMesh) -> None:
    """Write a mesh with its fields as VTU."""
    file = meshio.Mesh(mesh.points, mesh.cells, mesh.point_data, mesh.cell_data)
    with whole(path) as partial:
        meshio.write(partial, file, file_format="vtu")


def write_solution(path: Path, solution: Solution) -> None:
    """Write a solution on its own mesh."""
    write_mesh(path, solution.mesh)


def write_comparison(path: Path, comparison: Comparison) -> None:
    """Write all solutions on one plan grid, `displacement_MODEL` each, and what they differ by.

    `displacement` is the reference's; `difference` is the chosen lattice's from it, `difference_MODEL` any
    other model's.
    """
    plan = plan_mesh(comparison.scene.sheet)
    fields = {s.model: s.displacement(plan.points[:, :2]) for s in comparison.solutions}
    truth = fields[comparison.reference.model]
    plan.point_data["displacement"] = truth
    plan.point_data["difference"] = fields[comparison.solutions[0].model] - truth
    for solution in comparison.solutions:
        plan.point_data[f"displacement_{solution.model}"] = fields[solution.model]
    for solution in comparison.solutions[2:]:
        plan.point_data[f"difference_{solution.model}"] = fields[solution.model] - truth
    write_mesh(path, plan)


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
