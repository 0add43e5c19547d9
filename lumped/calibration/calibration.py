"""What a calibration returns: springs for a grid, and the report of which moduli they meet."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from lumped import moduli
from lumped.lattice import Grid
from scenes import Material, Sheet, SpringSet


@dataclass(frozen=True)
class Calibration:
    """Springs of a lattice: method, grid (nx, ny, layers), spring constants [N/m] and layer distance [m].

    moduli: one row per plate modulus with what the sheet asks and what the lattice's interior gives
    (A, S [N/m], D [N·m]; S is asked as MacNeal's S* of the grid); notes: what the method could not meet.
    """

    method: str
    grid: Grid
    springs: SpringSet
    moduli: tuple[dict[str, Any], ...]
    notes: tuple[str, ...] = ()

    @property
    def layer_distance(self) -> float:
        """Distance of neighbouring layers [m]."""
        return self.springs.layer_distance

    def as_dict(self) -> dict[str, Any]:
        """The JSON document of `sheetbench calibrate`."""
        springs = self.springs.model_dump(exclude_none=True)
        distance = springs.pop("layer_distance")
        return {
            "method": self.method,
            "grid": list(self.grid),
            "springs": springs,
            "layer_distance": distance,
            "moduli": [dict(row) for row in self.moduli],
            "notes": list(self.notes),
        }


Method = Callable[..., Calibration]


def plan_spacing(sheet: Sheet, grid: Grid) -> tuple[float, float]:
    """In-plane spacings (lx, ly) [m] of a grid."""
    return sheet.length_x / (grid[0] - 1), sheet.length_y / (grid[1] - 1)


def report(
    method: str, sheet: Sheet, material: Material, grid: Grid, springs: SpringSet, notes: tuple[str, ...] = ()
) -> Calibration:
    """The calibration with its moduli report."""
    lx, ly = plan_spacing(sheet, grid)
    square = abs(lx - ly) < 1e-9 * lx
    asked = moduli.of_sheet(sheet, material, (lx, ly)).named(square)
    got = moduli.of_springs(springs, (lx, ly, springs.layer_distance), grid[2]).named(square)
    rows: list[dict[str, Any]] = []
    for name, value in asked.items():
        row = {"name": name, "asked": float(value), "got": float(got[name])}
        row["miss"] = float((got[name] - value) / value) if value else None
        if name.startswith("S"):
            row["kappa_G_h"] = moduli.shear_without_grid(sheet, material)
        rows.append(row)
    return Calibration(method, grid, springs, tuple(rows), notes)
