"""Which moduli of the sheet a lattice meets, cell by cell, and notes on those that it misses."""

from __future__ import annotations

from typing import Any

import numpy as np

from lumped import moduli
from lumped import spring_constants as constants
from lumped.calibration.calibration import Calibration, shown
from lumped.calibration.cell_by_cell import Kinds, Sides
from lumped.grid_lines import grid_lines
from lumped.sections import Section
from sheetbench.answers.table import number
from sheetbench.errors import BadInput
from sheetbench.scenes import Sheet, SpringSet
from sheetbench.scenes.grid import Grid

Cell = tuple[Sides, Section, SpringSet]
ALIKE = 1e-9


def report(method: str, kinds: Kinds, springs: SpringSet) -> Calibration:
    """The calibration with its moduli report, and notes on what it misses and why. Of unequal cells each
    modulus is reported of the cell that misses it most.

    Raises BadInput where area springs leave a cell without positive energy.
    """
    square = all(abs(x - y) < ALIKE * x and _alike(section.bending) for (x, y), section in kinds.of)
    worst: dict[str, dict[str, Any]] = {}
    for sides, section, own in _cells(kinds, springs):
        whole = moduli.of_springs(own, (*sides, own.layer_distance), kinds.grid[2])
        for row in _rows(moduli.of_section(section, sides).named(square), whole.named(square)):
            if row["name"].startswith("S"):
                row["kappa_G_h"] = float(section.shear[int(row["name"] == "Sy")])
            if row["name"] not in worst or abs(row["miss"]) > abs(worst[row["name"]]["miss"]):
                worst[row["name"]] = row
        couplings = [constants.of_strains(own, cells)[1][:, 3:] for cells in ("area", "mid_area")]
        negative = any(constants.value_of(own, name) < 0.0 for name in ("area", "mid_area"))
        if negative or np.any(couplings):
            _require_positive(own, whole)
    off = [
        f"{row['name']} by {number(100.0 * row['miss'], '+.1f')} %"
        for row in worst.values()
        if abs(row["got"] - row["asked"]) > 0.01 * abs(worst[_like(row["name"])]["asked"])
    ]
    missed = [f"these springs miss {', '.join(off)}"] if off else []
    if off and not np.any(springs.area) and not np.any(springs.shear):
        missed.append("central links alone obey Cauchy's relation C12 = C66: no k meets D12 and D66 both")
    rows = tuple(worst.values())
    notes = (*missed, *_admissible(springs))
    return Calibration(method, kinds.grid, springs, rows, notes, grading=kinds.grading, cells=kinds.cells)


def homogenised(sheet: Sheet, grid: Grid, springs: SpringSet) -> moduli.Moduli:
    """Moduli of the interior of a sheet's lattice with these springs, alike in all its cells."""
    x, y = grid_lines(sheet, grid)
    return moduli.of_springs(springs, (x.mean, y.mean, springs.layer_distance), grid[2])


def _alike(form: np.ndarray) -> bool:
    """Whether x and y are alike."""
    return bool(abs(form[0, 0] - form[1, 1]) < ALIKE * form[0, 0])


def _cells(kinds: Kinds, springs: SpringSet) -> list[Cell]:
    """Each cell that differs from the others by more than a factor, of which the stiffest."""
    if not constants.varies(springs):
        return [(*kind, springs) for kind in kinds.of]
    found: dict[Any, Cell] = {}
    for row, column in np.argwhere(kinds.factor > 1.0 - ALIKE).tolist():
        own, number = constants.of_cell(springs, row, column), kinds.which[row, column]
        found.setdefault((number, own), (*kinds.of[number], own))
    return list(found.values())


def _rows(target: dict[str, float], got: dict[str, float]) -> list[dict[str, Any]]:
    """Each modulus with its miss, relative to the target or, where that is zero, to its like along x."""
    rows = []
    for name, value in target.items():
        scale = value or abs(target[_like(name)])
        miss = float((got[name] - value) / scale)
        rows.append({"name": name, "asked": float(value), "got": float(got[name]), "miss": miss})
    return rows


def _like(name: str) -> str:
    """The modulus by whose size another is measured: D11 for D12, D16 and D26."""
    return f"{name[0]}11" if name[1:] in ("12", "16", "26") else name


def _areas(springs: SpringSet) -> str:
    return f"area = {shown(springs.area)}, mid_area = {shown(springs.mid_area)} N/m"


def _require_positive(springs: SpringSet, whole: moduli.Moduli) -> None:
    if min(np.linalg.eigvalsh(form)[0] for form in (whole.membrane, whole.bending)) <= 0.0:
        raise BadInput(f"{_areas(springs)}: the cell's energy is not positive")


def _admissible(springs: SpringSet) -> tuple[str, ...]:
    """A note where area springs are negative (ν < 1/3): admissible while the cells' energy stays positive."""
    if np.min(springs.area) >= 0.0 and np.min(springs.mid_area) >= 0.0:
        return ()
    return (f"{_areas(springs)}: negative area springs are admissible here, the cell's energy is positive",)
