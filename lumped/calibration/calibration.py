"""What a calibration returns: springs for a grid, and the report of which moduli they meet."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from lumped import moduli
from lumped.lattice import Grid
from lumped.springs import constants
from sheetbench.scenes import Material, PerDirection, Sheet, SpringSet, summary
from sheetbench.scenes.errors import BadInput
from sheetbench.scenes.springs import Distribution, Either


@dataclass(frozen=True, repr=False)
class Calibration(summary.Summarised):
    """Springs of a lattice: method, grid (nx, ny, layers), spring constants [N/m] and layer distance [m].

    moduli: one row per plate modulus with what the sheet asks and what the lattice's interior gives
    (A, S [N/m], D [N·m]; S is asked as MacNeal's S* of the grid); notes: what the method could not meet;
    masses: how the sheet's mass is shared out (`lumped.masses`) when it vibrates or moves.
    """

    method: str
    grid: Grid
    springs: SpringSet
    moduli: tuple[dict[str, Any], ...]
    notes: tuple[str, ...] = ()
    masses: Distribution = "tributary"

    @property
    def layer_distance(self) -> float:
        """Distance of neighbouring layers [m]."""
        return self.springs.layer_distance

    def halved(self, axis: int) -> Calibration:
        """These springs on the half of the grid up to a plane of symmetry across the axis, 0 or 1.

        A free edge opposite that plane stands for two opposite ones.
        """
        grid = [*self.grid]
        grid[axis] = grid[axis] // 2 + 1
        edge, strip = (_both(value) for value in (self.springs.edge_shear, self.springs.strip_shear))
        edge[axis] = strip[axis]
        springs = self.springs.model_copy(update={"edge_shear": either(*edge)})
        return replace(self, grid=(grid[0], grid[1], grid[2]), springs=springs)

    def with_constant(self, name: str, value: float) -> Calibration:
        """The same with one spring constant changed, by its name (`lumped.springs.constants`)."""
        return replace(self, springs=constants.changed(self.springs, name, value))

    def as_dict(self) -> dict[str, Any]:
        """The JSON document of `sheetbench calibrate`; strain springs only where there are any."""
        springs = self.springs.model_dump(exclude_none=True)
        for name in ("shear", "mid_shear", "mid_stretch", "edge_shear", "strip_shear"):
            if not springs[name]:
                del springs[name]
        distance = springs.pop("layer_distance")
        return {
            "method": self.method,
            "grid": list(self.grid),
            "springs": springs,
            "layer_distance": distance,
            "moduli": [dict(row) for row in self.moduli],
            "masses": self.masses,
            "notes": list(self.notes),
        }

    def _summary(self) -> tuple[str, summary.Facts]:
        springs = self.as_dict()["springs"]
        numbers = [f"{name} {k:.4g}" for name, k in springs.items() if isinstance(k, float) and k]
        along = [
            f"{name} {' × '.join(f'{k:.4g}' for k in each.values())}"
            for name, each in springs.items()
            if isinstance(each, dict)
        ]
        missed = [row for row in self.moduli if abs(row["miss"]) > 0.01]
        return f"Calibration {self.method} of {' × '.join(map(str, self.grid))} masses", [
            ("springs [N/m]", ", ".join(numbers)),
            ("x × y [N/m]", ", ".join(along)),
            ("layers", f"{1e3 * self.layer_distance:.5g} mm apart"),
            ("moduli", ", ".join(f"{row['name']} off by {row['miss']:+.2%}" for row in missed) or "all met"),
            ("notes", "; ".join(self.notes)),
        ]


def plan_spacing(sheet: Sheet, grid: Grid) -> tuple[float, float]:
    """In-plane spacings (lx, ly) [m] of a grid."""
    return sheet.length_x / (grid[0] - 1), sheet.length_y / (grid[1] - 1)


def by_direction(x: float, y: float, alike: float = 1e-12) -> float | PerDirection:
    """Stiffness along x and y, one number where they are alike; what rounding put below zero is zero."""
    x, y = max(x, 0.0), max(y, 0.0)
    return x if abs(x - y) <= alike * max(x, y) else PerDirection(x=x, y=y)


def either(x: float, y: float) -> float | Either:
    """Values along x and y of either sign, one number where they are alike."""
    return x if abs(x - y) <= 1e-12 * max(abs(x), abs(y)) else Either(x=x, y=y)


def _both(value: float | Either) -> list[float]:
    return [value.x, value.y] if isinstance(value, Either) else [value, value]


def homogenised(sheet: Sheet, grid: Grid, springs: SpringSet) -> moduli.Moduli:
    """Moduli of the interior of a sheet's lattice with these springs."""
    return moduli.of_springs(springs, (*plan_spacing(sheet, grid), springs.layer_distance), grid[2])


def report(method: str, sheet: Sheet, material: Material, grid: Grid, springs: SpringSet) -> Calibration:
    """The calibration with its moduli report, and notes on what it misses and why.

    Raises BadInput where area springs leave a cell without positive energy.
    """
    spacing = plan_spacing(sheet, grid)
    square = abs(spacing[0] - spacing[1]) < 1e-9 * spacing[0]
    whole = homogenised(sheet, grid, springs)
    asked = moduli.of_sheet(sheet, material, spacing).named(square)
    got = whole.named(square)
    scale = {name: abs(asked[name.replace("12", "11")]) for name in asked}
    rows: list[dict[str, Any]] = []
    for name, value in asked.items():
        row = {"name": name, "asked": float(value), "got": float(got[name])}
        row["miss"] = float((got[name] - value) / (value or scale[name]))
        if name.startswith("S"):
            row["kappa_G_h"] = moduli.shear_without_grid(sheet, material)
        rows.append(row)
    notes = [
        f"{row['name']} is missed by {row['miss']:+.1%}"
        for row in rows
        if abs(row["got"] - row["asked"]) > 0.01 * scale[row["name"]]
    ]
    if notes and not springs.area and not springs.shear:
        notes.append("central links alone obey Cauchy's relation C12 = C66: no k meets D12 and D66 both")
    return Calibration(method, grid, springs, tuple(rows), (*notes, *_admissible(springs, whole)))


def _admissible(springs: SpringSet, whole: moduli.Moduli) -> tuple[str, ...]:
    """A note where area springs are negative (ν < 1/3): admissible while the cell's energy stays positive."""
    if springs.area >= 0.0 and springs.mid_area >= 0.0:
        return ()
    areas = f"area = {springs.area:.4g}, mid_area = {springs.mid_area:.4g} N/m"
    if min(np.linalg.eigvalsh(form)[0] for form in (whole.membrane, whole.bending)) <= 0.0:
        raise BadInput(f"{areas}: the cell's energy is not positive")
    return (f"{areas}: negative area springs are admissible here, the cell's energy is positive",)
