"""What a sheet is made of: constants, each one number or an array, at points or of the cells of a grid."""

from __future__ import annotations

from dataclasses import dataclass, fields, replace
from typing import Any, Self

import numpy as np

from sheetbench.errors import BadInput
from sheetbench.scenes.grid import Grid
from sheetbench.scenes.material import Material
from sheetbench.scenes.sheet import Sheet


@dataclass(frozen=True, eq=False)
class Constants:
    """thickness [m], young [Pa], poisson [-], density [kg/m³]: numbers, or arrays of one shape."""

    thickness: Any
    young: Any
    poisson: Any
    density: Any

    @classmethod
    def of(cls, sheet: Sheet, material: Material) -> Self:
        """Return the table of a sheet that is the same all over."""
        return cls(sheet.thickness, material.young, material.poisson, material.density)

    def replace(self, **values: Any) -> Self:
        """Return a copy with other values for some constants."""
        return replace(self, **values)

    @property
    def per_area(self) -> Any:
        """Mass per area [kg/m²]."""
        return self.density * self.thickness


class Cells(Constants):
    """Of the plan cells of a grid: arrays are (rows, columns) from y0 to y1, each row from x0 to x1.

    >>> import numpy as np
    >>> from sheetbench.scenes import Cells, load
    >>> scene = load("two-edges-clamped")
    >>> Cells.of(scene.sheet, scene.material).replace(thickness=np.array([[0.003, 0.001]])).per_area
    array([[5.034, 1.678]])
    """

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
