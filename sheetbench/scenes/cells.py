"""What the plan cells of a sheet are made of: a table of constants, each one number or one for every cell."""

from __future__ import annotations

from dataclasses import dataclass, fields, replace
from typing import Any, Self

import numpy as np

from sheetbench.errors import BadInput
from sheetbench.scenes.grid import Grid
from sheetbench.scenes.material import Material
from sheetbench.scenes.sheet import Sheet

PerCell = float | np.ndarray


@dataclass(frozen=True, eq=False)
class Cells:
    """thickness [m], young [Pa], poisson [-], density [kg/m³]: numbers, or (rows, columns) of cells from y0
    to y1, each row from x0 to x1.

    >>> import numpy as np
    >>> from sheetbench.scenes import Cells, load
    >>> scene = load("two-edges-clamped")
    >>> cells = Cells.of(scene.sheet, scene.material).replace(thickness=np.array([[0.003, 0.001]]))
    >>> cells.cell(0, 1, (0.094, 0.188), scene.material)[0]
    Sheet(length_x=0.094, length_y=0.188, thickness=0.001)
    """

    thickness: PerCell
    young: PerCell
    poisson: PerCell
    density: PerCell

    @classmethod
    def of(cls, sheet: Sheet, material: Material) -> Self:
        """Return the table of a sheet that is the same all over."""
        return cls(sheet.thickness, material.young, material.poisson, material.density)

    def replace(self, **values: PerCell) -> Self:
        """Return a copy with other values for some constants."""
        return replace(self, **values)

    @property
    def per_area(self) -> PerCell:
        """Mass per area [kg/m²]."""
        return self.density * self.thickness

    def require_grid(self, grid: Grid) -> None:
        """Raise BadInput for a table that is not one of the grid's cells."""
        rows, columns = grid[1] - 1, grid[0] - 1
        for one in fields(self):
            shape = np.shape(getattr(self, one.name))
            if shape not in ((), (rows, columns)):
                raise BadInput(
                    f"cells.{one.name}: {' × '.join(map(str, shape))} values; {grid[0]}x{grid[1]} masses "
                    f"have {rows} rows of {columns} cells"
                )

    def cell(
        self, row: int, column: int, sides: tuple[float, float], material: Material
    ) -> tuple[Sheet, Material]:
        """Return a cell of these sides [m] as a sheet, and what else of a material it has in that material.
        Raises SceneError for constants that make no sense."""
        of_cell: dict[str, Any] = {}
        for one in fields(self):
            value = getattr(self, one.name)
            of_cell[one.name] = float(value[row, column] if isinstance(value, np.ndarray) else value)
        thickness = of_cell.pop("thickness")
        sheet = Sheet.model_construct(length_x=sides[0], length_y=sides[1], thickness=thickness)
        return sheet, material.replace(**of_cell)
