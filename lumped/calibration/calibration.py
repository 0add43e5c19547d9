"""The result of a calibration: springs for a grid, and a report of the moduli that they meet."""

from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, Self

import numpy as np

from lumped.calibration import tables
from lumped.sections import CellSection
from lumped.spring_constants import Springs
from sheetbench.answers.answer import Answer
from sheetbench.answers.table import Table
from sheetbench.scenes import SpringSet
from sheetbench.scenes.objects.grading import Graded, as_settings, remark
from sheetbench.scenes.objects.grid import Grid
from sheetbench.scenes.objects.springs import LATTICE, Distribution


@dataclass(frozen=True, repr=False)
class Calibration(Answer):
    """Springs of a lattice, with a report of the moduli that they meet.

    Parameters
    ----------
    method : str
        Name of the calibration method.
    grid : tuple of int
        Masses along x, along y and through the thickness.
    springs : SpringSet
        Spring constants [N/m] and layer distance [m].
    moduli : tuple of dict
        A row per plate modulus, A and S [N/m], D [N·m]: the sheet's target, for S MacNeal's S* of the grid,
        and the value of the lattice's interior, for unequal cells of the cell with the largest miss.
    remarks : tuple of str, optional
        Notes on targets that the method did not meet.
    masses : {"tributary", "gregory"}, default "tributary"
        Distribution of the sheet's mass in vibration and motion (`lumped.masses`).
    grading : float or Grading, default 0
        Grading of the grid's lines (`lumped.grid_lines`).
    cells : CellSection, optional
        Sections of cells that differ or have fibres.
    of_material : bool, default False
        Whether `cells` follow from the material alone, without patches, layers and cutouts of a scene.
    options : tuple of (str, float), optional
        Options k [N/m] and layer_distance [m] that the method was given, for springs of a changed scene.
    """

    file_name = "calibration"
    page_name = "table"
    method: str
    grid: Grid
    springs: SpringSet
    moduli: tuple[dict[str, Any], ...]
    remarks: tuple[str, ...] = ()
    masses: Distribution = "tributary"
    grading: Graded = 0.0
    cells: CellSection | None = None
    of_material: bool = False
    options: tuple[tuple[str, float], ...] = ()

    @property
    def present(self) -> np.ndarray | None:
        """Mask of the cells that the sheet covers, (rows, columns), or None if it covers all."""
        return None if self.per_area is None else self.per_area > 0.0

    @property
    def per_area(self) -> np.ndarray | None:
        """The cells' mass per area [kg/m²], (rows, columns), 0 of absent cells, or None if all are
        present."""
        per_area = None if self.cells is None else self.cells.per_area
        return None if per_area is None or (per_area > 0.0).all() else per_area

    @property
    def layer_distance(self) -> float:
        """Distance of neighbouring layers [m]."""
        return self.springs.layer_distance

    @property
    def title(self) -> str:
        """Grid, method and grading in a few words."""
        grid = "×".join(map(str, self.grid))
        return f"{grid} {self.method}{remark(self.grading)}"

    @property
    def settings(self) -> dict[str, Any]:
        """Settings of the lattice in an answer: grid, method and grading."""
        return {"grid": list(self.grid), "calibration": self.method, **as_settings(self.grading)}

    @cached_property
    def constants(self) -> Springs:
        """The springs as arrays."""
        return Springs.read(self.springs)

    def with_constant(self, name: str, value: float) -> Self:
        """Return the calibration with one spring constant changed, by its name
        (`lumped.spring_constants`)."""
        return replace(self, springs=self.constants.changed(name, value).table())

    def document(self) -> dict[str, Any]:
        """Return the JSON document of `sheetbench calibrate`, with strain springs if there are any."""
        springs = self.springs.model_dump(mode="json", exclude_none=True, exclude=LATTICE)
        distance = springs.pop("layer_distance")
        always = ("axial", "diagonal", "vertical", "cross", "cross_diagonal", "area", "mid_area")
        return {
            "method": self.method,
            "grid": list(self.grid),
            "springs": {name: k for name, k in springs.items() if k or name in always},
            "layer_distance": distance,
            "moduli": [dict(row) for row in self.moduli],
            "masses": self.masses,
            **as_settings(self.grading),
            "notes": list(self.remarks),
        }

    def heading(self) -> tuple[str, str, str]:
        """Return method, grid and grading."""
        nx, ny, layers = self.grid
        return f"{self.method} calibration", f"of {nx} × {ny} × {layers} masses{remark(self.grading)}", ""

    def tables(self) -> tuple[Table, ...]:
        """Return the tables of the springs and of the moduli that they meet."""
        document = self.document()
        return tables.springs(document), tables.moduli(document)

    def notes(self) -> tuple[str, ...]:
        return self.remarks

    def choices(self) -> dict[str, Any]:
        return {"method": self.method, "grid": list(self.grid)}
